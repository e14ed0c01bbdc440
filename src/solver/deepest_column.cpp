#include "solver/deepest_column.h"

#include "emit/settled_packing.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Loosely poured sand.
constexpr double kSolidFraction = 0.58;

/// Room [m3] that so many mean grains take.
double looseVolume(const GrainSpec& grains, double count)
{
    return count * 4.0 / 3.0 * kPi * std::pow(grains.radius, 3.0) / kSolidFraction;
}

/// Height [m] of the cone that they would make, steep and loose.
double coneOf(double volume)
{
    constexpr double kSlope = 0.577;  // 30 degrees
    return std::cbrt(3.0 * volume * kSlope * kSlope / kPi);
}

/// Depth [m] of that volume in a hollow solid; no more than up to its rim. 0 for other solids.
double depthInside(const SolidSpec& solid, double volume)
{
    if (!solid.hollow) {
        return 0.0;
    }
    if (solid.shape == SolidShape::cylinder) {
        return std::min(solid.height, volume / (kPi * solid.radius * solid.radius));
    }
    const Vec3 size = solid.max - solid.min;
    return std::min(size.z(), volume / (size.x() * size.y()));
}

/// Depth [m] that an emitter of settled sand starts with; 0 for the others.
double depthAtStart(const EmitterSpec& emitter, const GrainSpec& grains)
{
    if (emitter.kind == EmitterKind::pile) {
        return coneHeight(emitter.slopeAngle, emitter.count, grains);
    }
    if (emitter.kind != EmitterKind::fill) {
        return 0.0;
    }
    const Vec3 size = emitter.max - emitter.min;
    const double full = size.z();
    return emitter.count == 0
               ? full
               : std::min(full, looseVolume(grains, static_cast<double>(emitter.count)) /
                                    (size.x() * size.y()));
}

}  // namespace

double findDeepestColumn(const Scene& scene, std::uint64_t grains)
{
    const double volume = looseVolume(scene.grains, static_cast<double>(grains));
    double deepest = coneOf(volume);
    for (const SolidSpec& solid : scene.solids) {
        deepest = std::max(deepest, depthInside(solid, volume));
    }
    for (const EmitterSpec& emitter : scene.emitters) {
        deepest = std::max(deepest, depthAtStart(emitter, scene.grains));
    }
    return deepest;
}

}  // namespace sandflow
