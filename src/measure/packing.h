#pragma once

#include "grains/snapshot.h"
#include "measure/floor.h"

#include <cstddef>

namespace sandflow {

/// How the grains of a snapshot touch each other. A contact is a pair of grains that overlap; its
/// overlap is r1 + r2 - distance, in units of the smaller radius.
struct PackingFigures {
    std::size_t grains = 0;
    std::size_t contacts = 0;
    double meanCoordination = 0.0;   ///< contacts per grain, 2 contacts / grains
    double meanOverlap = 0.0;        ///< of the smaller radius, over all contacts
    double maxOverlap = 0.0;         ///< of the smaller radius
    std::size_t floatingFrozen = 0;  ///< interface or buried with nothing near: must be none
    std::size_t floatingSlow = 0;    ///< mobile or asleep, slower than 1 cm/s, nothing near: some
                                     ///< may be at the top of a jump
};

/// A grain floats if no other grain is within 2 % of a diameter of touching it, and the floor is
/// farther below it than the cover of a rough floor reaches (1.2 radii). Solids other than the
/// floor are not seen: beside walls and on figures the count is an upper bound.
PackingFigures measurePacking(const Snapshot& snapshot, const FloorHeight& floor);

/// On a floor level at `floorZ` [m].
PackingFigures measurePacking(const Snapshot& snapshot, double floorZ = 0.0);

}  // namespace sandflow
