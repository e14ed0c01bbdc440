#pragma once

#include "core/cell_map.h"
#include "grains/snapshot.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sandflow {

/// The grains of a snapshot sorted into cubic cells, so that the neighbours of a grain are found
/// in the 27 cells about it. Only occupied cells exist. Read-only once built; the snapshot must
/// outlive it.
class GrainGrid {
public:
    /// `reach` [m]: largest distance of two centres that will be asked for; > 0. Throws
    /// InternalError for positions that are not finite.
    GrainGrid(const Snapshot& snapshot, double reach);

    /// Calls visit(j) for every grain j other than `grain` in the 27 cells about it, until visit
    /// returns false. The order depends on the snapshot only. Safe from several threads.
    template <typename Visit>
    void visitNear(std::size_t grain, Visit&& visit) const
    {
        for (const std::uint32_t cell : neighbours_[cellOf_[grain]]) {
            if (cell == kNoCell) {
                continue;
            }
            for (std::uint32_t at = begin_[cell]; at < begin_[cell + 1]; ++at) {
                if (sorted_[at] != grain && !visit(std::size_t{sorted_[at]})) {
                    return;
                }
            }
        }
    }

private:
    static constexpr std::uint32_t kNoCell = ~std::uint32_t{0};

    void sortGrains(const Snapshot& snapshot, double inverseCellSize);
    void linkCells();

    std::vector<CellIndex> cells_;                           ///< in order of first appearance
    std::vector<std::array<std::uint32_t, 27>> neighbours_;  ///< per cell, itself included
    std::vector<std::uint32_t> cellOf_;                      ///< per grain
    std::vector<std::uint32_t> begin_;                       ///< per cell, into sorted_; one past
    std::vector<std::uint32_t> sorted_;                      ///< grains by cell, ascending within
    CellMap index_;
};

/// Radius of the largest grain, m; 0 for none.
double findLargestRadius(const Snapshot& snapshot);

}  // namespace sandflow
