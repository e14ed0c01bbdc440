#include "emit/emitter.h"
#include "scene/radius_range.h"
#include "solver/deepest_column.h"
#include "solver/simulation.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

RunPlan planRun(const Scene& scene, std::span<const Eigen::AlignedBox3d> meshBounds)
{
    RunPlan plan;
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
        plan.grains += static_cast<std::uint64_t>(makeEmitter(scene, e)->planned());
    }
    const RadiusRange radii = radiusRange(scene);
    plan.load.fastestSpeed = fastestPossibleSpeed(scene, meshBounds);
    plan.load.deepestColumn = findDeepestColumn(scene, plan.grains);
    plan.load.minRadius = radii.smallest;
    plan.load.maxRadius = radii.largest;
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
