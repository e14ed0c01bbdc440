#include "app/seen_through.h"

#include <algorithm>

namespace sandflow {
namespace {

/// Deeper than this many diameters behind a pane nothing is seen between the grains.
constexpr double kSightDepth = 3.0;

}  // namespace

std::function<bool(const Vec3&)> findSeenThrough(const Scene& scene, const SolidSet& solids)
{
    const auto isClear = [&scene](int solid) {
        const std::string& look = scene.solids[static_cast<std::size_t>(solid)].look;
        return look == "glass" || look == "none";
    };
    const double depth = kSightDepth * scene.diameter();
    std::vector<const Primitive*> panes;
    for (const Primitive& primitive : solids.primitives()) {
        if (isClear(primitive.solid)) {
            panes.push_back(&primitive);
        }
    }
    std::vector<Eigen::AlignedBox3d> meshes;
    for (const MeshSolid& mesh : solids.meshes()) {
        if (isClear(mesh.solid)) {
            const Vec3 margin = Vec3::Constant(depth);
            const Eigen::AlignedBox3d box = boundsOf(mesh.mesh);
            meshes.emplace_back(box.min() - margin, box.max() + margin);
        }
    }
    if (panes.empty() && meshes.empty()) {
        return {};
    }
    return [panes, meshes, depth](const Vec3& p) {
        return std::any_of(panes.begin(), panes.end(),
                           [&](const Primitive* pane) {
                               return std::abs(nearestSurface(*pane, p).distance) < depth;
                           }) ||
               std::any_of(meshes.begin(), meshes.end(),
                           [&](const Eigen::AlignedBox3d& box) { return box.contains(p); });
    };
}

}  // namespace sandflow
