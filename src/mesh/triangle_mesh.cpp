#include "mesh/triangle_mesh.h"

#include "core/hash.h"

namespace sandflow {
namespace {

/// Twice the area along the outward normal.
Vec3 doubleArea(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corner)
{
    const Vec3& a = mesh.points[corner[0]];
    return (mesh.points[corner[1]] - a).cross(mesh.points[corner[2]] - a);
}

}  // namespace

Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            box.extend(mesh.points[corner]);
        }
    }
    return box;
}

double areaOf(const TriangleMesh& mesh)
{
    double area = 0.0;
    for (const auto& triangle : mesh.triangles) {
        area += 0.5 * doubleArea(mesh, triangle).norm();
    }
    return area;
}

double signedVolumeOf(const TriangleMesh& mesh)
{
    // Tetrahedra over the middle of the mesh: far from the origin those over it would cancel badly.
    const Vec3 middle = mesh.triangles.empty() ? Vec3(Vec3::Zero()) : boundsOf(mesh).center();
    double volume = 0.0;
    for (const auto& triangle : mesh.triangles) {
        volume += (mesh.points[triangle[0]] - middle).dot(doubleArea(mesh, triangle)) / 6.0;
    }
    return volume;
}

std::vector<Vec3> smoothNormalsOf(const TriangleMesh& mesh)
{
    std::vector<Vec3> normals(mesh.points.size(), Vec3::Zero());
    for (const auto& triangle : mesh.triangles) {
        const Vec3 weighted = doubleArea(mesh, triangle);
        for (const std::uint32_t corner : triangle) {
            normals[corner] += weighted;
        }
    }
    for (Vec3& normal : normals) {
        const double length = normal.norm();
        normal = length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::UnitZ());
    }
    return normals;
}

std::uint64_t contentHashOf(const TriangleMesh& mesh)
{
    StateHash hash;
    hash.add(mesh.points.data(), mesh.points.size() * sizeof(Vec3));
    hash.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
    return hash.value();
}

}  // namespace sandflow
