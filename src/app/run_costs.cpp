#include "app/run_costs.h"

#include "emit/emitter.h"
#include "emit/layer_clock.h"

#include <algorithm>

namespace sandflow {
namespace {

/// Its copy in the frame that is being written, and that frame's text.
constexpr double kBytesPerOutput = 57.0 + 33.0;
/// The program itself.
constexpr double kBytesAlways = 20e6;
/// One sphere of a picture file.
constexpr double kBytesPerSphere = 33.0;

/// In surface-flow mode the height field holds about this share of a heap.
constexpr double kBuriedShare = 0.5;

std::uint64_t emittedBy(const EmitterPlan& emitter, double time)
{
    if (time < emitter.start) {
        return 0;
    }
    if (time >= emitter.end) {
        return emitter.count;
    }
    const double share = (time - emitter.start) / (emitter.end - emitter.start);
    return static_cast<std::uint64_t>(share * static_cast<double>(emitter.count));
}

}  // namespace

std::vector<EmitterPlan> planEmitters(const Scene& scene)
{
    std::vector<EmitterPlan> plans;
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
        const EmitterSpec& spec = scene.emitters[e];
        EmitterPlan plan;
        plan.count = static_cast<std::uint64_t>(makeEmitter(scene, e)->planned());
        plan.start = plan.end = spec.start;
        if (spec.kind == EmitterKind::jet || spec.kind == EmitterKind::slot) {
            const LayerClock clock = makeLayerClock(scene, e);
            plan.end = clock.dueTime(clock.layerOf(clock.count));
        }
        plans.push_back(plan);
    }
    return plans;
}

RunCosts estimateCosts(const Scene& scene, const RunPlan& plan,
                       const std::vector<EmitterPlan>& emitters)
{
    RunCosts costs;
    const double buried = scene.mode == Mode::surfaceFlow ? kBuriedShare : 0.0;
    const double stepsPerFrame = plan.framePeriod / plan.step.step;
    for (std::uint64_t frame = 1; frame <= plan.frames; ++frame) {
        const double time = static_cast<double>(frame) * plan.framePeriod;
        double grains = 0.0;
        for (const EmitterPlan& emitter : emitters) {
            grains += static_cast<double>(emittedBy(emitter, time));
        }
        costs.grainSteps += grains * stepsPerFrame;
        costs.frameBytes += (1.0 - buried) * grains * kBytesPerSphere;
    }
    costs.memoryBytes = kBytesAlways + static_cast<double>(plan.grains) *
                                           (kBytesPerOutput + (1.0 - buried) * kBytesPerMobile +
                                            buried * kBytesPerBuried);
    return costs;
}

}  // namespace sandflow
