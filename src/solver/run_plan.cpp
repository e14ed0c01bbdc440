#include "emit/emitter.h"
#include "solver/simulation.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Height of the cone that all grains of the scene would make, steep and loose: no column of sand on
/// open ground gets deeper.
double deepestColumn(const Scene& scene, std::uint64_t grains)
{
    constexpr double kSlope = 0.577, kSolidFraction = 0.58;  // 30 degrees, poured loosely
    const double r = scene.grains.radius;
    const double volume = static_cast<double>(grains) * 4.0 / 3.0 * kPi * r * r * r / kSolidFraction;
    return std::cbrt(3.0 * volume * kSlope * kSlope / kPi);
}

}  // namespace

RunPlan planRun(const Scene& scene, std::span<const Eigen::AlignedBox3d> meshBounds)
{
    RunPlan plan;
    double smallest = scene.grains.radius * (1.0 - scene.grains.sizeSpread);
    double largest = scene.grains.radius * (1.0 + scene.grains.sizeSpread);
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
        plan.grains += static_cast<std::uint64_t>(makeEmitter(scene, e)->planned());
        if (scene.emitters[e].grainRadius) {
            smallest = std::min(smallest, *scene.emitters[e].grainRadius);
            largest = std::max(largest, *scene.emitters[e].grainRadius);
        }
    }
    plan.load.fastestSpeed = fastestPossibleSpeed(scene, meshBounds);
    plan.load.deepestColumn = deepestColumn(scene, plan.grains);
    plan.load.minRadius = smallest;
    plan.load.maxRadius = largest;
    plan.load.density = scene.grains.density;
    plan.load.gravity = scene.gravity.norm();
    plan.law = makeContactCoefficients(scene, plan.load, plan.stiffness);
    plan.step = stableStep(plan.law, plan.load, scene.contact.maxOverlap * scene.grains.radius,
                           scene.time.stepSafety, scene.time.step);
    plan.repose = reportRepose(scene);
    plan.framePeriod = 1.0 / scene.time.framesPerSecond;
    const double end = scene.time.duration ? *scene.time.duration
                                           : lastEmissionTime(scene) + scene.time.settle;
    plan.frames = static_cast<std::uint64_t>(std::ceil(end / plan.framePeriod - 1e-9));
    plan.endTime = static_cast<double>(plan.frames) * plan.framePeriod;
    return plan;
}

}  // namespace sandflow
