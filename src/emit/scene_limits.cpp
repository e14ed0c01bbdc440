#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emit/emitter.h"
#include "emit/layer_clock.h"
#include "emit/settled_packing.h"

namespace sandflow {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Bounds of the scene further out than this mean "none".
constexpr double kUnbounded = 1e29;

/// Planes whose normal leans further than this from straight up are walls, not ground: the sine of
/// their slope is above 0.995.
constexpr double kLeastGround = 0.1;

bool isJet(const EmitterSpec& spec)
{
    return spec.kind == EmitterKind::jet || spec.kind == EmitterKind::slot;
}

struct Box {
    Vec3 min, max;

    /// Largest height of the box above the origin along the unit vector `up`.
    double top(const Vec3& up) const
    {
        return up.cwiseMax(0.0).dot(max) + up.cwiseMin(0.0).dot(min);
    }
    double bottom(const Vec3& up) const { return -top(-up); }
};

/// Box about everywhere a grain of the emitter starts from.
Box startingBox(const EmitterSpec& spec, const GrainSpec& grains)
{
    switch (spec.kind) {
        case EmitterKind::jet: {
            // A disc reaches radius * sqrt(1 - d_k^2) along axis k.
            const Vec3 reach =
                spec.radius * (Vec3::Ones() - spec.direction.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
            return {spec.position - reach, spec.position + reach};
        }
        case EmitterKind::slot: {
            // Its width lies level, its height across that; see EmitterSpec::size.
            const Vec3 level = Vec3::UnitZ().cross(spec.direction);
            const Vec3 width = level.norm() > 1e-9 ? Vec3(level.normalized()) : Vec3(Vec3::UnitX());
            const Vec3 height = spec.direction.cross(width);
            const Vec3 reach =
                0.5 * (spec.size.x() * width.cwiseAbs() + spec.size.y() * height.cwiseAbs());
            return {spec.position - reach, spec.position + reach};
        }
        case EmitterKind::block:
        case EmitterKind::fill:
            return {spec.min, spec.max};
        case EmitterKind::pile: {
            const double height = coneHeight(spec.slopeAngle, spec.count, grains);
            const double base = height / std::tan(spec.slopeAngle * kPi / 180.0);
            return {spec.position - Vec3(base, base, 0.0),
                    spec.position + Vec3(base, base, height)};
        }
        case EmitterKind::single:
            break;
    }
    return {spec.position, spec.position};
}

/// Height along `up` of the lowest part of a solid on which sand that starts in the box can land.
/// None for walls and for meshes.
std::optional<double> solidLevel(const SolidSpec& solid, const Box& start, const Vec3& up)
{
    switch (solid.shape) {
        case SolidShape::plane: {
            const Vec3 normal = solid.normal.normalized();
            const double rise = normal.dot(up);
            if (rise < kLeastGround) {
                return std::nullopt;
            }
            // Straight below the box's lowest corner as seen by the plane: p - up (p - c).n / rise.
            double level = kInfinity;
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3 p((corner & 1) != 0 ? start.max.x() : start.min.x(),
                             (corner & 2) != 0 ? start.max.y() : start.min.y(),
                             (corner & 4) != 0 ? start.max.z() : start.min.z());
                level = std::min(level, p.dot(up) - (p - solid.point).dot(normal) / rise);
            }
            return level;
        }
        case SolidShape::box:
            return Box{solid.min, solid.max}.bottom(up);
        case SolidShape::disc:
        case SolidShape::cylinder: {
            const double along = solid.normal.normalized().dot(up);
            const double length = solid.shape == SolidShape::cylinder ? solid.height : 0.0;
            return solid.point.dot(up) + std::min(0.0, along * length) -
                   solid.radius * std::sqrt(std::max(0.0, 1.0 - along * along));
        }
        case SolidShape::mesh:
            break;
    }
    return std::nullopt;
}

/// The lowest level at which grains from the box can hit something.
double lowestLevel(const Scene& scene, std::span<const Eigen::AlignedBox3d> meshBounds,
                   const Box& start, double lowestEmitter, const Vec3& up)
{
    double level = kInfinity;
    for (const SolidSpec& solid : scene.solids) {
        level = std::min(level, solidLevel(solid, start, up).value_or(kInfinity));
    }
    for (const Eigen::AlignedBox3d& mesh : meshBounds) {
        level = std::min(level, Box{mesh.min(), mesh.max()}.bottom(up));
    }
    if (level == kInfinity || level > start.top(up)) {
        level = std::min(lowestEmitter, start.bottom(up));
    }
    // A grain below the domain has left the scene.
    const bool isBounded =
        scene.domain.min.minCoeff() > -kUnbounded && scene.domain.max.maxCoeff() < kUnbounded;
    if (isBounded) {
        level = std::max(level, Box{scene.domain.min, scene.domain.max}.bottom(up));
    } else if (up.z() > 1.0 - 1e-12 && scene.domain.min.z() > -kUnbounded) {
        level = std::max(level, scene.domain.min.z());
    }
    return level;
}

}  // namespace

double lastEmissionTime(const Scene& scene)
{
    double last = 0.0;
    for (std::size_t index = 0; index < scene.emitters.size(); ++index) {
        const EmitterSpec& spec = scene.emitters[index];
        double time = spec.start;
        if (isJet(spec)) {
            const LayerClock clock = makeLayerClock(scene, index);
            time = clock.dueTime(clock.layerOf(clock.count));
        }
        last = std::max(last, time);
    }
    return last;
}

double fastestPossibleSpeed(const Scene& scene,
                            std::span<const Eigen::AlignedBox3d> meshBounds)
{
    const double g = scene.gravity.norm();
    const Vec3 up = g > 0.0 ? Vec3(-scene.gravity / g) : Vec3::UnitZ();
    double lowestEmitter = kInfinity;
    for (const EmitterSpec& spec : scene.emitters) {
        lowestEmitter = std::min(lowestEmitter, startingBox(spec, scene.grains).bottom(up));
    }
    double fastest = 0.0;
    for (const EmitterSpec& spec : scene.emitters) {
        const Box start = startingBox(spec, scene.grains);
        const double fall = start.top(up) - lowestLevel(scene, meshBounds, start, lowestEmitter, up);
        const double speed = isJet(spec) ? spec.speed : spec.velocity.norm();
        // v^2 = v0^2 + 2 g H, whichever way v0 points.
        fastest = std::max(fastest, std::sqrt(speed * speed + 2.0 * g * std::max(0.0, fall)));
    }
    return fastest;
}

}  // namespace sandflow
