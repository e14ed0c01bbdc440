#pragma once

#include "mesh/clean_copy.h"
#include "mesh/triangle_mesh.h"

#include <string>

namespace sandflow {

/// The triangles that assimp makes of a clean copy, with the transforms of nodes applied; what
/// faces outwards in the file still does where a node mirrors it. Throws InputError, with `file`
/// for its name, if assimp sees other triangles than the gate did.
TriangleMesh readWithAssimp(const CleanCopy& copy, const std::string& file);

}  // namespace sandflow
