#pragma once

#include "mesh/clean_copy.h"
#include "mesh/triangle_mesh.h"

#include <string>

namespace sandflow {

/// The triangles that assimp makes of a clean copy: polygons split, nodes applied (mirrored ones
/// too: what faces outwards still does), single corners. Throws InputError, with `file` for its
/// name, if a polygon cannot be split or assimp sees other faces than the gate did.
TriangleMesh readWithAssimp(const CleanCopy& copy, const std::string& file);

}  // namespace sandflow
