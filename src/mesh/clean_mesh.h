#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>
#include <string>
#include <vector>

namespace sandflow {

/// What is known of a mesh after its clean-up. Lengths in the units of the file.
struct MeshReport {
    std::size_t points = 0;
    std::size_t triangles = 0;
    std::size_t components = 0;        ///< triangles with a common point are connected
    std::size_t boundaryEdges = 0;     ///< with one triangle
    std::size_t nonManifoldEdges = 0;  ///< with more than two
    std::size_t unbalancedEdges = 0;   ///< not passed equally often in both directions
    double largestHole = 0.0;          ///< diagonal of a rim's bounding box; 0 without a rim
    double signedVolume = 0.0;         ///< units cubed; positive: faces outwards
    Eigen::AlignedBox3d bounds;
    std::vector<std::string> repairs;  ///< one sentence each, for the user to see
};

/// Welds equal points, drops triangles without area, repeated ones and unused points, turns round
/// what faces the wrong way. Flat and repeated triangles stay where the surface would be open
/// without them, so triangles may have no area; none has the same point twice. Throws InputError,
/// with `file` for its name, if nothing is left or the coordinates are not finite.
MeshReport cleanMesh(TriangleMesh& mesh, const std::string& file);

}  // namespace sandflow
