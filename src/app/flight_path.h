#pragma once

#include "scene/scene.h"
#include "solids/solid_set.h"

#include <optional>

namespace sandflow {

/// Where a grain in free flight meets a solid.
struct Impact {
    Vec3 place;     ///< m, centre of the grain
    double time;    ///< s
    double speed;   ///< m/s
    int solid;      ///< index into Scene::solids
    bool onGround;  ///< the surface can carry sand: it is no wall or ceiling
};

/// The way of one grain from an emitter: through the air to the first solid and, if that is a wall,
/// down along it.
struct Flight {
    std::optional<Impact> first;    ///< first solid met
    std::optional<Impact> landing;  ///< first one that can carry sand
};

/// Follows a grain of mean radius from position [m] with velocity [m/s] at time `start` [s] through
/// the solids; other grains do not count.
Flight followGrain(const Scene& scene, const SolidSet& solids, const Vec3& position,
                   const Vec3& velocity, double start);

}  // namespace sandflow
