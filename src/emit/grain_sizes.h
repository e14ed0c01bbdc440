#pragma once

#include "core/random.h"
#include "scene/scene.h"

namespace sandflow {

/// Radius of the largest grain a scene can emit by chance, m.
inline double largestRadius(const GrainSpec& grains)
{
    return grains.radius * (1.0 + grains.sizeSpread);
}

/// A radius uniform in r (1 +- spread), m.
inline double drawRadius(const GrainSpec& grains, Random& random)
{
    return grains.radius * (1.0 + grains.sizeSpread * random.uniform(-1.0, 1.0));
}

/// Mean of r^3 over those sizes times 4 pi / 3, m3: E[(1 + s u)^3] = 1 + s^2 for u in [-1, 1).
inline double meanGrainVolume(const GrainSpec& grains)
{
    const double spread = grains.sizeSpread;
    return 4.0 / 3.0 * kPi * grains.radius * grains.radius * grains.radius *
           (1.0 + spread * spread);
}

}  // namespace sandflow
