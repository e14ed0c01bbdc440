#pragma once

#include <cstdint>
#include <vector>

#include "emit/emitter.h"
#include "scene/scene.h"

namespace sandflow {

/// Settles grains by dropping and rolling in the box [min, max] with smooth walls and floor until
/// `count` are in or, with count 0, no more fit. With a count that does not fit, fewer come back.
/// The first grains lie deepest. Every grain is held by three others, walls or the floor without
/// needing friction.
std::vector<NewGrain> packBox(const Vec3& min, const Vec3& max, std::int64_t count,
                              const GrainSpec& grains, std::uint64_t seed, std::size_t emitter);

/// Settles `count` grains as a cone of the given slope on the level z = apexFoot.z() about
/// apexFoot, in m. Returns fewer when the grains will not hold such a slope.
std::vector<NewGrain> packCone(const Vec3& apexFoot, double slopeAngle, std::int64_t count,
                               const GrainSpec& grains, std::uint64_t seed, std::size_t emitter);

/// Height of a cone of sand of that slope, degrees, and number of grains, m; of the solid fraction
/// that packCone reaches.
double coneHeight(double slopeAngle, std::int64_t count, const GrainSpec& grains);

}  // namespace sandflow
