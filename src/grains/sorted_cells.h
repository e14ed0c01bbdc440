#pragma once

#include "core/cell_key.h"
#include "core/cell_map.h"
#include "core/vec3.h"

#include <algorithm>
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
    void build(std::span<const Vec3> points);

    double cellSize() const { return cellSize_; }
    std::span<const std::uint32_t> order() const { return order_; }  ///< input index of each entry
    std::span<const Cell> cells() const { return cells_; }

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
    struct Entry {
        std::uint64_t key;
        std::uint32_t point;
    };
    struct Row {
        std::uint32_t begin, end;  ///< in rowCells_
    };
    void sortByKey();
    void buildRows();

    template <class Visit>
    void visitRow(std::int32_t j, std::int32_t k, std::int32_t first, std::int32_t last,
                  Visit&& visit) const
    {
        const std::uint32_t* slot = rowOf_.find(packCellKey(0, j, k));
        if (!slot) {
            return;
        }
        const auto begin = rowCells_.begin() + rows_[*slot].begin;
        const auto end = rowCells_.begin() + rows_[*slot].end;
        auto at = std::lower_bound(begin, end, first, [&](std::uint32_t cell, std::int32_t i) {
            return cells_[cell].index.i < i;
        });
        for (; at != end && cells_[*at].index.i <= last; ++at) {
            visit(cells_[*at]);
        }
    }

    double cellSize_, inverse_;
    std::vector<Entry> entries_, scratch_;
    std::vector<CellIndex> indexOf_;
    std::vector<std::uint32_t> order_;
    std::vector<Cell> cells_;
    CellMap rowOf_;                        ///< packed (0, j, k) -> rows_
    std::vector<Row> rows_;
    std::vector<std::uint32_t> rowCells_;  ///< cells of each row, ascending in i
    std::vector<std::uint32_t> rowOfCell_;
    CellIndex low_, high_;                 ///< of the cells there are
};

}  // namespace sandflow
