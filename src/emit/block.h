#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "emit/emitter.h"
#include "scene/scene.h"

namespace sandflow {

/// The most grains of radius up to `largest` that a block emitter puts into the box [min, max].
std::int64_t blockCapacity(const Vec3& min, const Vec3& max, double largest);

/// Fills the box evenly with `count` <= blockCapacity grains at rest: a stack of hexagonal layers
/// as wide as the box allows, some sites left empty, every grain then moved by chance as far as it
/// cannot touch another. Not in contact, so not a packing at rest: loose sand about to fall.
void fillBlock(const Vec3& min, const Vec3& max, std::int64_t count, const GrainSpec& grains,
               Random& sizes, Random& places, std::vector<NewGrain>& out);

}  // namespace sandflow
