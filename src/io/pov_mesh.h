#pragma once

#include "mesh/triangle_mesh.h"

#include <string>
#include <string_view>

namespace sandflow {

/// A mesh as it is shaded: one normal per point, and more than one point where the surface has an
/// edge.
struct ShadedMesh {
    std::vector<Vec3> points;
    std::vector<Vec3> normals;  ///< unit, as many as points
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Gives every corner of a triangle the area-weighted normal of those triangles around it that are
/// inclined by less than `creaseAngle` (degrees) to its own, so that a figure is smooth and a box
/// keeps its edges. Triangles without area, which nobody could see, are left out, and so are points
/// that no triangle uses.
ShadedMesh shadeMesh(const TriangleMesh& mesh, double creaseAngle = 50.0);

/// "#declare NAME = mesh2{...}", lengths in units of `unit` (m), without a material. InternalError
/// for a mesh with NaN, without area or with a corner that is no point.
std::string formatPovMesh(std::string_view name, const TriangleMesh& mesh, double unit);

}  // namespace sandflow
