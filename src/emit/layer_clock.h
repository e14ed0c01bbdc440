#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace sandflow {

/// Share of free room between the layers of a jet: they follow each other by this many largest
/// diameters, because anything closer than 1.15 explodes in a contact law's first steps.
inline constexpr double kLayerSpacing = 1.15;

/// When the layers of a jet or slot leave and how many grains each holds.
struct LayerClock {
    double start = 0.0;      ///< s, first layer
    double interval = 0.0;   ///< s between layers
    double perLayer = 0.0;   ///< mean number of grains in a layer, any positive number
    std::int64_t count = 0;  ///< grains in all

    double dueTime(std::int64_t layer) const
    {
        return start + interval * static_cast<double>(layer);
    }

    /// Grains that have left with the first `layers` layers. Counting from the start, never adding
    /// up shares, keeps the mean rate exact to one grain for ever.
    std::int64_t emittedAfter(std::int64_t layers) const;

    /// The layer that holds grain number `serial` = 1 .. count.
    std::int64_t layerOf(std::int64_t serial) const;
};

/// Throws InputError (naming scene and emitter) for a speed, rate or count that gives no jet: not
/// positive, or too slow upwards for one layer to be clear of the next.
LayerClock makeLayerClock(const Scene& scene, std::size_t index);

}  // namespace sandflow
