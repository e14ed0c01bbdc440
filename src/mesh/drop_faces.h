#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>

/// Each removes triangles that add nothing to the surface and returns how many; the others keep
/// their order. A triangle without which the surface would be open is not removed.
namespace sandflow {

/// Those with the same point at two corners.
std::size_t dropCollapsed(TriangleMesh& mesh);

/// Those with the same corners, the same way round, as an earlier one.
std::size_t dropRepeated(TriangleMesh& mesh);

/// Those whose least height is below `tolerance` (units of the mesh). Between a long edge and two
/// short ones along it they are needed.
std::size_t dropFlat(double tolerance, TriangleMesh& mesh);

/// If every triangle is there once each way round, the surface encloses nothing: of each pair the
/// earlier is kept, provided that these fit together.
std::size_t dropBackFaces(TriangleMesh& mesh);

}  // namespace sandflow
