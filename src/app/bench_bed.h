#pragma once

#include "core/vec3.h"
#include "dem/dem.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sandflow {

/// The bed on which DEM codes are timed against each other: equal grains at rest in a box with
/// smooth walls, under a linear contact law that every DEM code offers.
namespace bench {
inline constexpr double kRadius = 0.005;    ///< m
inline constexpr double kDensity = 2600.0;  ///< kg/m3
inline constexpr double kBoxEdge = 0.6;     ///< m, x and y
inline constexpr double kStep = 1e-4;       ///< s
}  // namespace bench

/// Centres of the grains, m; index = id - 1. Nothing else: a bed read from a file and one just made
/// are the same bed.
struct Bed {
    std::vector<Vec3> centre;
    std::uint64_t settlingSteps = 0;  ///< steps it took; 0 if it was read
    double secondsToMake = 0.0;       ///< wall time
};

/// The box, the grains and the contact law:
///   k = 1300 N/m, restitution 0.3 by a linear dashpot that may pull, kt = 2/7 k with half the
///   normal dashpot, mu 0.5; rolling (if on): spring kt R*^2 without dashpot, mu_r 0.1.
DemSetup makeBenchSetup(bool rolling);

/// Drops and rolls `grains` grains into the box, then lets them settle under the contact law until
/// their mean kinetic energy is below a thousandth of m g d. The same bits each time. Throws
/// PhysicsError if they do not come to rest.
Bed makeBed(std::size_t grains);

/// Reads `id,x,y,z` in m. Throws InputError for another format, repeated ids, or centres outside
/// the box.
Bed readBed(const std::string& path);

/// Writes what readBed reads, with all digits. Throws SystemError.
void writeBed(const std::string& path, const Bed& bed);

}  // namespace sandflow
