#include <cmath>

#include "emit/batch_emitter.h"
#include "emit/emitter.h"
#include "emit/jet_emitter.h"
#include "emit/refusal.h"

namespace sandflow {

std::unique_ptr<Emitter> makeEmitter(const Scene& scene, std::size_t index)
{
    const EmitterSpec& spec = scene.emitters.at(index);
    const GrainSpec& grains = scene.grains;
    if (!(grains.radius > 0.0) || !(grains.sizeSpread >= 0.0 && grains.sizeSpread < 1.0)) {
        refuseEmitter(scene, index,
                      fmt::format("grains need a positive radius and a size spread of 0 to below "
                                  "1, not {} m and {}",
                                  grains.radius, grains.sizeSpread));
    }
    if (!std::isfinite(spec.start)) {
        refuseEmitter(scene, index, fmt::format("start must be a time in s, not {}", spec.start));
    }
    if (spec.kind == EmitterKind::jet || spec.kind == EmitterKind::slot) {
        return std::make_unique<JetEmitter>(scene, index);
    }
    return std::make_unique<BatchEmitter>(scene, index);
}

}  // namespace sandflow
