#pragma once

#include "mesh/clean_mesh.h"

#include <string>
#include <vector>

namespace sandflow {

/// What may go wrong between a mesh and grains of radius `grainRadius`, m: one sentence each for
/// holes wider than a radius, other defects of the surface, a size outside 1 to 10^4 radii, and
/// coordinates too far from the origin for single precision. `scale` in metres per unit of the
/// file, as scaleOf gives it.
std::vector<std::string> checkMeshAgainstGrains(const MeshReport& report, double scale,
                                                double grainRadius);

}  // namespace sandflow
