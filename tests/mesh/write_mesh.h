#pragma once

#include "mesh/triangle_mesh.h"

#include <fstream>
#include <string>

namespace sandflow {

/// A mesh as a text PLY file; returns its path.
inline std::string writeMesh(const TriangleMesh& mesh, const std::string& path)
{
    std::ofstream out(path);
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
        << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    out.precision(17);
    for (const Vec3& p : mesh.points) {
        out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
    for (const auto& t : mesh.triangles) {
        out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }
    return path;
}

}  // namespace sandflow
