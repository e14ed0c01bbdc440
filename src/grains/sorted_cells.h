#pragma once

#include "core/cell_key.h"
#include "core/cell_map.h"
#include "core/vec3.h"
#include "grains/key_sorter.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace sandflow {

/// Points sorted into cubic cells, cells in Morton order, found by hash: the domain is unbounded and
/// empty space is free. Order within a cell is that of the input, so the result depends on the
/// points alone.
///
/// What is hashed are rows of cells along x, each with its cells in ascending order: a search of
/// 3 x 3 x 3 cells takes nine look-ups, one of 5 x 5 x 5 twenty-five.
class SortedCells {
public:
    struct Cell {
        CellIndex index;
        std::uint32_t begin;  ///< first entry of order() in this cell
        std::uint32_t end;
    };

    explicit SortedCells(double cellSize = 1.0) : cellSize_(cellSize), inverse_(1.0 / cellSize) {}

    /// Sorts anew. Throws InternalError for a point that is not finite.
    void build(std::span<const Vec3> points)
    {
        build(points.size(), [&](std::size_t k) { return points[k]; });
    }

    /// The same for the points pointOf(k), k < count.
    template <class PointOf>
    void build(std::size_t count, PointOf pointOf)
    {
        const auto n = static_cast<std::int64_t>(count);
        const bool many = count > KeySorter<std::uint32_t>::kFew;
        const auto keyOf = [&](std::int64_t k) {
            return curveKey(cellOf(pointOf(static_cast<std::size_t>(k))));
        };
        // An exception must not leave the parallel loop.
        std::int64_t lost = n;
#pragma omp parallel for schedule(static) reduction(min : lost) if (many)
        for (std::int64_t k = 0; k < n; ++k) {
            if (!holds(pointOf(static_cast<std::size_t>(k)))) {
                lost = std::min(lost, k);
            }
        }
        if (lost < n) {
            const Vec3 p = pointOf(static_cast<std::size_t>(lost));
            SAND_CHECK(lost == n, "point ({}, {}, {}) m cannot be placed in the grid", p.x(), p.y(),
                       p.z());
        }
        // Bits above the highest in which two keys differ need no sorting, and mostly no room: a heap
        // of a hundred cells across takes 21.
        const std::uint64_t first = count == 0 ? 0 : keyOf(0);
        std::uint64_t differ = 0;
#pragma omp parallel for schedule(static) reduction(| : differ) if (many)
        for (std::int64_t k = 0; k < n; ++k) {
            differ |= keyOf(k) ^ first;
        }
        const int bits = 64 - std::countl_zero(differ);
        const auto sortWith = [&]<class Key>(KeySorter<Key>& sorter) {
            sorter.entries().resize(count);
#pragma omp parallel for schedule(static) if (many)
            for (std::int64_t k = 0; k < n; ++k) {
                sorter.entries()[k] = {static_cast<Key>(keyOf(k)), static_cast<std::uint32_t>(k)};
            }
            sorter.sort(bits);
            takeOrder(sorter.entries(), bits < 64 ? first >> bits << bits : 0);
        };
        if (bits <= 32) {
            sortWith(narrow_);
        } else {
            sortWith(wide_);
        }
    }

    double cellSize() const { return cellSize_; }
    std::span<const std::uint32_t> order() const { return order_; }  ///< input index of each entry
    std::span<const Cell> cells() const { return cells_; }

    std::size_t bytes() const
    {
        return narrow_.bytes() + wide_.bytes() + order_.capacity() * sizeof(std::uint32_t) + cells_.capacity() * sizeof(Cell) +
               (rows_.capacity() + rowCells_.capacity()) * sizeof(Row);
    }

    /// False for what is not finite, or kilometres away.
    bool holds(const Vec3& point) const
    {
        return point.allFinite() && point.cwiseAbs().maxCoeff() * inverse_ < kCellIndexLimit - 1;
    }

    CellIndex cellOf(const Vec3& point) const
    {
        return {cellCoordinate(point.x(), inverse_), cellCoordinate(point.y(), inverse_),
                cellCoordinate(point.z(), inverse_)};
    }

    /// Null if the cell is empty.
    const Cell* find(std::int32_t i, std::int32_t j, std::int32_t k) const
    {
        const Cell* found = nullptr;
        visitRow(j, k, i, i, [&](const Cell& cell) { found = &cell; });
        return found;
    }

    /// visit(cell) of every cell with points that is at most `radius` cells from `at` on each axis,
    /// in ascending (k, j, i).
    template <class Visit>
    void visitNear(const CellIndex& at, std::int32_t radius, Visit visit) const
    {
        for (std::int32_t k = std::max(at.k - radius, low_.k);
             k <= std::min(at.k + radius, high_.k); ++k) {
            for (std::int32_t j = std::max(at.j - radius, low_.j);
                 j <= std::min(at.j + radius, high_.j); ++j) {
                visitRow(j, k, at.i - radius, at.i + radius, visit);
            }
        }
    }

private:
    struct Row {
        std::uint32_t begin, end;  ///< in rowCells_
    };
    struct RowCell {
        std::int32_t i;
        std::uint32_t cell;
    };
    static std::uint64_t curveKey(const CellIndex& cell);
    /// Order and cells from sorted entries whose keys are parts of the curve's, without what all
    /// share.
    template <class Entry>
    void takeOrder(const std::vector<Entry>& entries, std::uint64_t shared);
    void buildRows();
    void tabulateRows();

    static constexpr std::uint32_t kNoRowHere = 0xFFFFFFFFu;

    std::uint32_t findRow(std::int32_t j, std::int32_t k) const
    {
        if (!rowTable_.empty()) {
            const bool inside = j >= low_.j && j <= high_.j && k >= low_.k && k <= high_.k;
            return inside ? rowTable_[tableIndex(j, k)] : kNoRowHere;
        }
        const std::uint32_t* row = rowOf_.find(packCellKey(0, j, k));
        return row ? *row : kNoRowHere;
    }
    std::size_t tableIndex(std::int32_t j, std::int32_t k) const
    {
        return static_cast<std::size_t>(k - low_.k) * tableWidth_ +
               static_cast<std::size_t>(j - low_.j);
    }

    template <class Visit>
    void visitRow(std::int32_t j, std::int32_t k, std::int32_t first, std::int32_t last,
                  Visit&& visit) const
    {
        const std::uint32_t row = findRow(j, k);
        if (row == kNoRowHere) {
            return;
        }
        const RowCell* const begin = rowCells_.data() + rows_[row].begin;
        const RowCell* const end = rowCells_.data() + rows_[row].end;
        // Most rows have no gaps: then the place follows from the index.
        const RowCell* at = begin + std::clamp<std::ptrdiff_t>(first - begin->i, 0, end - begin);
        if (at > begin && at[-1].i >= first) {
            at = std::lower_bound(begin, at, first,
                                  [](const RowCell& cell, std::int32_t i) { return cell.i < i; });
        }
        for (; at != end && at->i <= last; ++at) {
            visit(cells_[at->cell]);
        }
    }

    double cellSize_, inverse_;
    KeySorter<std::uint32_t> narrow_;
    KeySorter<std::uint64_t> wide_;  ///< for sand scattered far and wide
    std::vector<std::uint32_t> order_;
    std::vector<Cell> cells_;
    CellMap rowOf_;                        ///< packed (0, j, k) -> rows_
    std::vector<std::uint32_t> rowTable_;  ///< the same by (k, j) where sand lies close together
    std::size_t tableWidth_ = 0;
    std::vector<Row> rows_;
    std::vector<RowCell> rowCells_;        ///< of each row, ascending in i
    std::vector<std::uint32_t> rowOfCell_;
    CellIndex low_, high_;                 ///< of the cells there are
};

}  // namespace sandflow
