#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

/// Side discharge from a plate, Zhou et al. 2002 as set up by Lethe.
namespace sandflow::verification {

/// The heap on the plate at one time.
struct PlateHeap {
    double time = 0.0;           ///< s
    double leftAngle = 0.0;      ///< degrees
    double rightAngle = 0.0;     ///< degrees
    double outflow = 0.0;        ///< grains/s in the second before
    std::uint64_t grains = 0;    ///< left on the plate
    std::vector<double> height;  ///< m above the plate, per d of length from x = -0.45 m

    double angle() const { return 0.5 * (leftAngle + rightAngle); }
};

/// 52,000 equal spheres of 10 mm lie 0.9 m long and 0.2 m thick on a plate between two walls; the
/// outermost 0.05 m of the box's 1 m are closed until the discharge begins. One heap per second;
/// the last one is what Lethe's angles are taken of.
std::vector<PlateHeap> measurePlateDischarge(Mode mode, double rollingFriction, std::uint64_t seed);

}  // namespace sandflow::verification
