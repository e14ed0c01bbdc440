#include "measure/grain_grid.h"

#include <algorithm>

namespace sandflow {

GrainGrid::GrainGrid(const Snapshot& snapshot, double reach)
{
    SAND_CHECK(reach > 0.0, "reach {} m", reach);
    // A little wider, so that rounding cannot put grains at exactly `reach` two cells apart.
    sortGrains(snapshot, 1.0 / (reach * (1.0 + 1e-9)));
    linkCells();
}

// Counting sort: stable, so grains stay ascending within their cell.
void GrainGrid::sortGrains(const Snapshot& snapshot, double inverseCellSize)
{
    cellOf_.resize(snapshot.size());
    std::vector<std::uint32_t> count;
    for (std::size_t n = 0; n < snapshot.size(); ++n) {
        const Vec3& p = snapshot.position[n];
        const CellIndex cell{cellCoordinate(p.x(), inverseCellSize),
                             cellCoordinate(p.y(), inverseCellSize),
                             cellCoordinate(p.z(), inverseCellSize)};
        const auto [at, added] =
            index_.insert(packCellKey(cell), static_cast<std::uint32_t>(cells_.size()));
        if (added) {
            cells_.push_back(cell);
            count.push_back(0);
        }
        cellOf_[n] = *at;
        ++count[*at];
    }

    begin_.assign(cells_.size() + 1, 0);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        begin_[c + 1] = begin_[c] + count[c];
    }
    sorted_.resize(snapshot.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t n = 0; n < snapshot.size(); ++n) {
        sorted_[next[cellOf_[n]]++] = static_cast<std::uint32_t>(n);
    }
}

void GrainGrid::linkCells()
{
    // The outermost cells that a key can tell have no neighbour on one side.
    const auto canBeKeyed = [](std::int32_t i) {
        return i >= -kCellIndexLimit && i < kCellIndexLimit;
    };
    neighbours_.resize(cells_.size());
    const auto cellCount = static_cast<std::int64_t>(cells_.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t c = 0; c < cellCount; ++c) {
        const CellIndex& cell = cells_[c];
        std::size_t slot = 0;
        for (std::int32_t k = cell.k - 1; k <= cell.k + 1; ++k) {
            for (std::int32_t j = cell.j - 1; j <= cell.j + 1; ++j) {
                for (std::int32_t i = cell.i - 1; i <= cell.i + 1; ++i) {
                    const bool exists = canBeKeyed(i) && canBeKeyed(j) && canBeKeyed(k);
                    const std::uint32_t* found =
                        exists ? index_.find(packCellKey(i, j, k)) : nullptr;
                    neighbours_[c][slot++] = found ? *found : kNoCell;
                }
            }
        }
    }
}

double findLargestRadius(const Snapshot& snapshot)
{
    return snapshot.radius.empty()
               ? 0.0
               : double{*std::max_element(snapshot.radius.begin(), snapshot.radius.end())};
}

}  // namespace sandflow
