#include "io/picture_extent.h"

#include "core/errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace sandflow {
namespace {

constexpr double kHeapSlope = 0.488;     ///< tan 26 degrees
constexpr double kSolidFraction = 0.58;  ///< of the volume of poured sand is grains
constexpr double kLeastRim = 0.2;        ///< of a bowl's height, above the place the sand falls on
constexpr double kLargestThing = 10.0;   ///< diagonals of the sand; larger meshes are landscape

/// What sand may fall on.
struct Setting {
    const Scene& scene;
    std::span<const SceneMesh> meshes;
};

Box3 makeBox(const Vec3& min, const Vec3& max)
{
    return Box3(min.cwiseMin(max), min.cwiseMax(max));
}

/// Height of the highest surface of a mesh at (x, y) below z; nothing if there is none.
std::optional<double> findMeshTop(const TriangleMesh& mesh, const Vec3& p)
{
    std::optional<double> top;
    for (const auto& triangle : mesh.triangles) {
        const Vec3& a = mesh.points[triangle[0]];
        const Vec3 u = mesh.points[triangle[1]] - a;
        const Vec3 v = mesh.points[triangle[2]] - a;
        const Vec3 offset = p - a;
        const double det = u.x() * v.y() - u.y() * v.x();
        const double s = offset.x() * v.y() - offset.y() * v.x();
        const double t = u.x() * offset.y() - u.y() * offset.x();
        // Barycentric coordinates s / det and t / det in the plan; upright triangles have no det.
        if (det == 0.0 || s / det < 0.0 || t / det < 0.0 || (s + t) / det > 1.0) {
            continue;
        }
        const double z = a.z() + s / det * u.z() + t / det * v.z();
        if (z < p.z() && (!top || z > *top)) {
            top = z;
        }
    }
    return top;
}

/// Room for sand in the hollow of a mesh at p: its box above the surface there. Empty where it is
/// not hollow, because somewhere around p its rim is missing or low.
Box3 findHollow(const TriangleMesh& mesh, const Vec3& p)
{
    const Box3 bounds = boundsOf(mesh);
    const std::optional<double> bottom = findMeshTop(mesh, p);
    if (!bottom) {
        return {};
    }
    // The highest point in each direction as seen from p in the plan.
    constexpr int directions = 12;
    std::array<double, directions> rim;
    rim.fill(-1e30);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            const Vec3& point = mesh.points[corner];
            const double turn = std::atan2(point.y() - p.y(), point.x() - p.x()) / (2.0 * kPi);
            auto& height = rim[static_cast<std::size_t>(
                std::clamp(static_cast<int>((turn + 0.5) * directions), 0, directions - 1))];
            height = std::max(height, point.z());
        }
    }
    if (*std::ranges::min_element(rim) < *bottom + kLeastRim * bounds.sizes().z()) {
        return {};
    }
    Box3 room = bounds;
    room.min().z() = *bottom;
    return room;
}

/// Height of the ground that sand at p falls on: the highest flat surface below it, 0 if none.
double findGround(const Setting& setting, const Vec3& p)
{
    double ground = -1e30;
    for (const SolidSpec& solid : setting.scene.solids) {
        double top = -1e30;
        if (solid.shape == SolidShape::plane && solid.normal.z() > 0.5) {
            // n . (x - point) = 0 solved for z.
            const Vec3 offset = p - solid.point;
            top = solid.point.z() - (solid.normal.x() * offset.x() +
                                     solid.normal.y() * offset.y()) / solid.normal.z();
        } else if (solid.shape == SolidShape::box && solid.min.x() < p.x() &&
                   p.x() < solid.max.x() && solid.min.y() < p.y() && p.y() < solid.max.y()) {
            top = !solid.hollow ? solid.max.z() : solid.floor ? solid.min.z() : -1e30;
        }
        if (top < p.z()) {
            ground = std::max(ground, top);
        }
    }
    for (const SceneMesh& mesh : setting.meshes) {
        const Box3 room = findHollow(mesh.mesh, p);
        if (!room.isEmpty()) {
            ground = std::max(ground, room.min().z());
        }
    }
    return ground > -1e29 ? ground : 0.0;
}

/// Volume of `count` grains as loose sand, m3.
double pourVolume(const Scene& scene, std::int64_t count)
{
    const double r = scene.grains.radius;
    return static_cast<double>(std::max<std::int64_t>(count, 1)) * 4.0 / 3.0 * kPi * r * r * r /
           kSolidFraction;
}

/// Box around a cone of the given volume: V = pi/3 R^3 tan(theta).
Box3 makeHeapBox(const Vec3& foot, double volume, double slope)
{
    const double radius = std::cbrt(3.0 * volume / (kPi * slope));
    return makeBox(foot - Vec3(radius, radius, 0.0), foot + Vec3(radius, radius, radius * slope));
}

/// Where something thrown from `start` meets the ground, without air.
Vec3 findLanding(const Setting& setting, const Vec3& start, const Vec3& velocity)
{
    const double ground = findGround(setting, start);
    const double drop = start.z() - ground;
    const double g = std::max(1e-6, -setting.scene.gravity.z());
    // 0 = drop + vz t - g t^2 / 2
    const double root = std::sqrt(std::max(0.0, velocity.z() * velocity.z() + 2.0 * g * drop));
    const double time = std::max(0.0, (velocity.z() + root) / g);
    return {start.x() + velocity.x() * time, start.y() + velocity.y() * time, ground};
}

/// The sand of a box that slumps: the heap it may become, and at least the ground it stood on.
Box3 slump(const Setting& setting, const EmitterSpec& emitter, double volume)
{
    const Vec3 centre = 0.5 * (emitter.min + emitter.max);
    Box3 box = makeHeapBox(Vec3(centre.x(), centre.y(), findGround(setting, centre)), volume,
                           kHeapSlope);
    const Vec3 reach = 0.5 * (emitter.max - emitter.min);
    box.extend(makeBox(Vec3(centre.x() - reach.x(), centre.y() - reach.y(), box.min().z()),
                       Vec3(centre.x() + reach.x(), centre.y() + reach.y(), box.min().z())));
    return box;
}

Box3 estimateEmitterBox(const Setting& setting, const EmitterSpec& emitter)
{
    const double volume = pourVolume(setting.scene, emitter.count);
    switch (emitter.kind) {
        case EmitterKind::jet:
        case EmitterKind::slot: {
            const Vec3 velocity = emitter.speed * emitter.direction;
            return makeHeapBox(findLanding(setting, emitter.position, velocity), volume,
                               kHeapSlope);
        }
        case EmitterKind::block: return slump(setting, emitter, volume);
        case EmitterKind::fill: return makeBox(emitter.min, emitter.max);
        case EmitterKind::pile:
            return makeHeapBox(emitter.position, volume,
                               std::max(0.05, std::tan(emitter.slopeAngle * kPi / 180.0)));
        case EmitterKind::single: break;
    }
    const double r = emitter.grainRadius.value_or(setting.scene.grains.radius);
    Box3 box(emitter.position);
    box.extend(findLanding(setting, emitter.position, emitter.velocity));
    return makeBox(box.min() - Vec3::Constant(3.0 * r), box.max() + Vec3::Constant(3.0 * r));
}

/// Cuts a box down to the container its centre lies in, if any.
Box3 keepInside(const Setting& setting, const Box3& box)
{
    Box3 kept = box;
    const Vec3 centre = box.center();
    for (const SolidSpec& solid : setting.scene.solids) {
        if (!solid.hollow || solid.until < 1e29) {
            continue;
        }
        Box3 room;
        if (solid.shape == SolidShape::box) {
            room = makeBox(solid.min, solid.max);
        } else if (solid.shape == SolidShape::cylinder && solid.normal.z() > 0.99) {
            const Vec3 side(solid.radius, solid.radius, 0.0);
            room = makeBox(solid.point - side,
                           solid.point + side + Vec3(0.0, 0.0, solid.height));
        } else {
            continue;
        }
        room.max().z() = std::max(room.max().z(), box.max().z());
        if (room.contains(centre)) {
            kept = kept.intersection(room);
        }
    }
    for (const SceneMesh& mesh : setting.meshes) {
        Box3 room = findHollow(mesh.mesh, Vec3(centre.x(), centre.y(), box.max().z()));
        if (room.isEmpty()) {
            continue;
        }
        room.max().z() = std::max(room.max().z(), box.max().z());
        if (room.contains(centre)) {
            kept = kept.intersection(room);
        }
    }
    return kept;
}

}  // namespace

Box3 estimateSandBox(const Scene& scene, std::span<const SceneMesh> meshes)
{
    const Setting setting{scene, meshes};
    Box3 box;
    for (const EmitterSpec& emitter : scene.emitters) {
        box.extend(keepInside(setting, estimateEmitterBox(setting, emitter)));
    }
    if (box.isEmpty()) {
        const double size = 20.0 * scene.grains.radius;
        box = makeBox(Vec3(-size, -size, 0.0), Vec3(size, size, size));
    }
    return box;
}

Box3 measureSandBox(const Snapshot& snapshot)
{
    Box3 box;
    const std::size_t n = snapshot.size();
    if (n == 0) {
        return box;
    }
    const std::size_t dropped = n / 400;
    std::vector<double> values(n);
    Vec3 min;
    Vec3 max;
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < n; ++i) {
            values[i] = snapshot.position[i][axis];
        }
        const auto low = values.begin() + static_cast<std::ptrdiff_t>(dropped);
        const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(dropped);
        std::nth_element(values.begin(), low, values.end());
        min[axis] = *low;
        std::nth_element(values.begin(), high, values.end());
        max[axis] = *high;
    }
    const Vec3 radius = Vec3::Constant(snapshot.meanRadius);
    return makeBox(min - radius, max + radius);
}

bool isThing(const Scene& scene, const Box3& sand, const SceneMesh& mesh)
{
    SAND_CHECK(mesh.solid < scene.solids.size(), "a mesh of solid {} of {}", mesh.solid,
               scene.solids.size());
    const Box3 bounds = boundsOf(mesh.mesh);
    return !bounds.isEmpty() && scene.solids[mesh.solid].look != "none" &&
           bounds.diagonal().norm() <= kLargestThing * sand.diagonal().norm();
}

Box3 measurePictureBox(const Scene& scene, const Box3& sand, std::span<const SceneMesh> meshes)
{
    Box3 box = sand;
    for (const SceneMesh& mesh : meshes) {
        if (isThing(scene, sand, mesh)) {
            box.extend(boundsOf(mesh.mesh));
        }
    }
    return box;
}

}  // namespace sandflow
