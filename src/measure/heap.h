#pragma once

#include "measure/height_map.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace sandflow {

/// Shape of a single heap. Heights are above the floor; d is the mean grain diameter of the scene.
/// All zero for a snapshot without settled grains.
struct HeapFigures {
    std::size_t grains = 0;           ///< that make up the heap
    std::size_t airborne = 0;         ///< left out: in the air or too fast (see settled.h)
    double diameter = 0.0;            ///< d, m
    Vec2 centroid = Vec2::Zero();     ///< m, of the grains' centres
    double apex = 0.0;                ///< m, mean of H over rho < 3 d
    std::optional<double> reposeDeg;  ///< slope of the flank between 15 and 75 % of the apex
                                      ///< [deg]; none if that is less than four annuli
    double r90 = 0.0;                 ///< m, radius that holds 90 % of the grains
    double foot = 0.0;                ///< m, outermost radius where the profile is 1 d high
    double volume = 0.0;              ///< m3, under H
    double solidFraction = 0.0;       ///< volume of the spheres / volume under H
    std::vector<double> profile;      ///< m, mean H over annulus [k d, (k + 1) d) about the
                                      ///< centroid
};

/// Figures of all sand of the snapshot, taken as one heap (beside walls, or for several heaps,
/// angle and foot mean little), on a floor level at `floorZ` [m]. Sand below the floor has no
/// height. Throws InternalError if the snapshot has no mean radius.
HeapFigures measureHeap(const Snapshot& snapshot, double floorZ = 0.0);

/// The same for a map that is there already (and may have another floor: heights are then depths
/// of sand).
HeapFigures measureHeap(const Snapshot& snapshot, const HeightMap& map);

}  // namespace sandflow
