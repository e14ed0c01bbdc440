#pragma once

#include "core/cell_map.h"
#include "core/vec3.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sandflow {

/// The grains below the interface: in no list, stored only. Each lies in a cubic cell as wide as a
/// column of the height field, its place kept as three 16-bit fractions of the cell (0.5 micrometre
/// at 30 mm: a tenth of the overlap under a grain's own weight), so it comes back where it lay.
class BuriedGrains {
public:
    explicit BuriedGrains(double cellSize) : cellSize_(cellSize) {}

    void add(const Vec3& position, double radius, std::uint32_t id);

    /// Offers every grain of column (i, j) in cells that reach above z to take(position, radius, id)
    /// and removes those for which it says true; cell by cell from below, in the order in which
    /// they were added.
    template <class Take>
    void takeAbove(std::int32_t i, std::int32_t j, double z, Take take)
    {
        const std::uint32_t* top = columnTop_.find(packCellKey(i, j, 0));
        if (!top) {
            return;
        }
        const std::int32_t highest = static_cast<std::int32_t>(*top) - kCellIndexLimit;
        for (std::int32_t k = std::max(lowestLayer(z), lowest_); k <= highest; ++k) {
            const std::uint32_t* at = cellOf_.find(packCellKey(i, j, k));
            if (!at) {
                continue;
            }
            Cell& cell = cells_[*at];
            std::size_t kept = 0;
            for (const Grain& g : cell.grains) {
                const Vec3 position = positionOf(cell.index, g);
                if (!take(position, static_cast<double>(g.radius), g.id)) {
                    cell.grains[kept++] = g;
                }
            }
            count_ -= cell.grains.size() - kept;
            cell.grains.resize(kept);
        }
    }

    /// visit(position, radius, id) of every grain, in a fixed order.
    template <class Visit>
    void forEach(Visit visit) const
    {
        for (const Cell& cell : cells_) {
            for (const Grain& g : cell.grains) {
                visit(positionOf(cell.index, g), static_cast<double>(g.radius), g.id);
            }
        }
    }

    /// visit(position, radius) of every grain whose centre is less than `range` from `centre`.
    template <class Visit>
    void visitNear(const Vec3& centre, double range, Visit visit) const
    {
        const auto layer = [&](double coordinate) { return lowestLayer(coordinate); };
        for (std::int32_t k = layer(centre.z() - range); k <= layer(centre.z() + range); ++k) {
            for (std::int32_t j = layer(centre.y() - range); j <= layer(centre.y() + range); ++j) {
                for (std::int32_t i = layer(centre.x() - range); i <= layer(centre.x() + range);
                     ++i) {
                    const std::uint32_t* at = cellOf_.find(packCellKey(i, j, k));
                    if (!at) {
                        continue;
                    }
                    for (const Grain& g : cells_[*at].grains) {
                        const Vec3 position = positionOf(cells_[*at].index, g);
                        if ((position - centre).squaredNorm() < range * range) {
                            visit(position, static_cast<double>(g.radius));
                        }
                    }
                }
            }
        }
    }

    void clear();
    std::size_t size() const { return count_; }
    std::size_t bytes() const;

private:
    struct Grain {
        std::uint16_t x, y, z;   ///< fraction of the cell, in 1/65536, of the centre
        float radius;            ///< m
        std::uint32_t id;
    };
    struct Cell {
        CellIndex index;
        std::vector<Grain> grains;
    };

    std::int32_t lowestLayer(double z) const;
    Vec3 positionOf(const CellIndex& cell, const Grain& g) const
    {
        constexpr double unit = 1.0 / 65536.0;
        return cellSize_ * Vec3(cell.i + (g.x + 0.5) * unit, cell.j + (g.y + 0.5) * unit,
                                cell.k + (g.z + 0.5) * unit);
    }

    double cellSize_;
    CellMap cellOf_;      ///< packed cell -> cells_
    CellMap columnTop_;   ///< packed (i, j, 0) -> highest cell ever used + kCellIndexLimit
    std::vector<Cell> cells_;
    std::int32_t lowest_ = kCellIndexLimit;  ///< lowest layer ever used
    std::size_t count_ = 0;
};

}  // namespace sandflow
