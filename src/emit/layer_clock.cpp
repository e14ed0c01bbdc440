#include "emit/layer_clock.h"

#include <algorithm>
#include <cmath>

#include "emit/grain_sizes.h"
#include "emit/refusal.h"

namespace sandflow {

namespace {

/// Layers further apart than this are numbered by a double without holes.
constexpr double kMostLayers = 4e15;

}  // namespace

std::int64_t LayerClock::emittedAfter(std::int64_t layers) const
{
    const double sum = std::floor(perLayer * static_cast<double>(layers));
    return sum < static_cast<double>(count) ? static_cast<std::int64_t>(sum) : count;
}

std::int64_t LayerClock::layerOf(std::int64_t serial) const
{
    const double guess = std::ceil(static_cast<double>(serial) / perLayer) - 1.0;
    auto layer = static_cast<std::int64_t>(std::max(0.0, guess));
    while (layer > 0 && emittedAfter(layer) >= serial) {
        --layer;
    }
    while (emittedAfter(layer + 1) < serial) {
        ++layer;
    }
    return layer;
}

LayerClock makeLayerClock(const Scene& scene, std::size_t index)
{
    const EmitterSpec& spec = scene.emitters.at(index);
    if (spec.count < 1) {
        refuseEmitter(scene, index, fmt::format("count must be at least 1, not {}", spec.count));
    }
    if (!(spec.rate > 0.0) || !std::isfinite(spec.rate)) {
        refuseEmitter(scene, index,
                      fmt::format("rate must be a positive number of grains/s, not {}", spec.rate));
    }
    if (!(spec.speed > 0.0) || !std::isfinite(spec.speed)) {
        refuseEmitter(scene, index,
                      fmt::format("speed must be positive (m/s), not {}: grains "
                                  "leave in layers that move out of each other's way",
                                  spec.speed));
    }
    const double spacing = kLayerSpacing * 2.0 * largestRadius(scene.grains);
    const double braking = -scene.gravity.dot(spec.direction);  // m/s2 against the jet

    LayerClock clock;
    clock.start = spec.start;
    clock.count = spec.count;
    clock.interval = spacing / spec.speed;
    if (braking > 0.0) {
        // The layer in front has slowed down: spacing = v T - braking T^2 / 2, the smaller root,
        // written without the difference of two near numbers.
        const double discriminant = spec.speed * spec.speed - 2.0 * braking * spacing;
        if (discriminant <= 0.0) {
            refuseEmitter(scene, index,
                          fmt::format("at {} m/s grains fall back onto the next layer; an upward "
                                      "jet of this direction needs more than {:.3g} m/s",
                                      spec.speed, std::sqrt(2.0 * braking * spacing)));
        }
        clock.interval = 2.0 * spacing / (spec.speed + std::sqrt(discriminant));
    }
    clock.perLayer = spec.rate * clock.interval;
    if (static_cast<double>(spec.count) / clock.perLayer > kMostLayers) {
        refuseEmitter(scene, index,
                      fmt::format("a rate of {} grains/s never ends; raise it", spec.rate));
    }
    return clock;
}

}  // namespace sandflow
