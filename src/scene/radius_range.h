#pragma once

#include "scene/scene.h"

#include <algorithm>

namespace sandflow {

/// Smallest and largest radius that a scene's grains can have, m.
struct RadiusRange {
    double smallest;
    double largest;
};

inline RadiusRange radiusRange(const Scene& scene)
{
    RadiusRange range{scene.grains.radius * (1.0 - scene.grains.sizeSpread),
                      scene.grains.radius * (1.0 + scene.grains.sizeSpread)};
    for (const EmitterSpec& emitter : scene.emitters) {
        if (emitter.grainRadius) {
            range.smallest = std::min(range.smallest, *emitter.grainRadius);
            range.largest = std::max(range.largest, *emitter.grainRadius);
        }
    }
    return range;
}

}  // namespace sandflow
