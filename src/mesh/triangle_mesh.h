#pragma once

#include "core/vec3.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Triangles over shared corners, m. Corners run counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Of the points that triangles use; empty for a mesh without triangles.
Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh);
double areaOf(const TriangleMesh& mesh);          ///< m2
/// m3, by the divergence theorem; positive if a closed surface faces outwards.
double signedVolumeOf(const TriangleMesh& mesh);
/// One unit normal per point, its triangles weighted by area; UnitZ where they cancel or none is.
std::vector<Vec3> smoothNormalsOf(const TriangleMesh& mesh);
/// Equal for equal points and triangles in the same order.
std::uint64_t contentHashOf(const TriangleMesh& mesh);

}  // namespace sandflow
