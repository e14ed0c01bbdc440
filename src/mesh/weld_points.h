#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>

namespace sandflow {

/// Makes points one that lie within `tolerance` (units of the mesh) of an earlier point, which
/// stays where it is. Points that no triangle uses are not looked at. Returns how many points went
/// into others; they stay in the list, unused. The bounding box of the used points may have
/// 2^21 tolerances at most.
std::size_t weldPoints(double tolerance, TriangleMesh& mesh);

/// Removes the points that no triangle uses; the others keep their order. Returns how many went.
std::size_t dropUnusedPoints(TriangleMesh& mesh);

}  // namespace sandflow
