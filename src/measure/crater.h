#pragma once

#include "grains/snapshot.h"
#include "measure/floor.h"

#include <vector>

namespace sandflow {

/// The hollow that something dug into sand between two moments: what the surface sank by, averaged
/// over annuli 1 d wide about its middle. d is the mean grain diameter. All zero where nothing sank.
struct CraterFigures {
    Vec2 centre = Vec2::Zero();  ///< m, middle of what sank
    double depth = 0.0;          ///< m, most that the surface sank by: over the middle (a disc of
                                 ///< 2 d) or over any annulus within the rim
    double volume = 0.0;         ///< m3, sunk within the rim
    double rim = 0.0;            ///< m, radius where the surface begins to be as high as before
    std::vector<double> fall;    ///< m, by annulus out to where sand lay or lies
};

/// Only sand that was there before and is still there counts, so that the hollow is seen without
/// the grains that dug it. Both snapshots must be of the same run; throws InputError if no grain
/// is in both.
CraterFigures measureCrater(const Snapshot& before, const Snapshot& after,
                            const FloorHeight& floor);

}  // namespace sandflow
