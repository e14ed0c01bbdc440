#pragma once

#include "scene/scene.h"

/// Side discharge from a plate, Zhou et al. 2002 as set up by Lethe.
namespace sandflow::verification {

struct PlateDischargeResult {
    double angle = 0.0;          ///< degrees, of the heap left on the plate: mean of both flanks
    double leftAngle = 0.0;      ///< degrees
    double rightAngle = 0.0;     ///< degrees
    double left = 0.0;           ///< grains left on the plate
    double lastOutflow = 0.0;    ///< grains/s in the last half second
    std::vector<double> height;  ///< m above the plate, per d of length from x = -0.45 m
};

/// 52,000 equal spheres of 10 mm lie 0.9 m long and 0.2 m thick on a plate between two walls; the
/// outermost 0.05 m of the box's 1 m are closed until the discharge begins.
PlateDischargeResult measurePlateDischarge(Mode mode, double rollingFriction, std::uint64_t seed);

}  // namespace sandflow::verification
