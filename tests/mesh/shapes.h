#pragma once

#include "mesh/triangle_mesh.h"

namespace sandflow {

/// Closed meshes of known area and volume, facing outwards.
inline TriangleMesh makeBoxMesh(const Vec3& min, const Vec3& max)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.points.push_back({(corner & 1) ? max.x() : min.x(), (corner & 2) ? max.y() : min.y(),
                               (corner & 4) ? max.z() : min.z()});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

}  // namespace sandflow
