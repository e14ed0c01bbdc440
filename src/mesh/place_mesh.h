#pragma once

#include "mesh/triangle_mesh.h"

#include <optional>

namespace sandflow {

/// How a mesh comes from its file into the scene.
struct MeshPlacement {
    bool yUp = false;                 ///< the file's y axis points up, not its z axis
    double scale = 1.0;               ///< metres per unit of the file
    std::optional<double> fitHeight;  ///< m, vertical extent; replaces scale
    std::optional<double>
        fitLength;              ///< m, longer horizontal extent before turning; replaces scale
    double turnDegrees = 0.0;   ///< about z, counter-clockwise seen from above
    bool stand = true;          ///< the middle of its box's bottom comes to point, else its
                                ///< origin does
    Vec3 point = Vec3::Zero();  ///< m
};

/// Metres per unit of the file that the placement gives the mesh. Throws InputError if it is to be
/// fitted along an axis in which it has no extent.
double scaleOf(const TriangleMesh& mesh, const MeshPlacement& placement);

/// Upright, scaled, turned and at its place, m. Rotations only: what faces outwards still does.
TriangleMesh placeMesh(TriangleMesh mesh, const MeshPlacement& placement);

}  // namespace sandflow
