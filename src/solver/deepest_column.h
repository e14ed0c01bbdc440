#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace sandflow {

/// How deep [m] the sand of a scene may come to lie: what the lowest grain may have to carry. On open
/// ground sand runs out to a cone; a container keeps it together, and settled sand stands as deep as
/// it was put in. Planes and meshes that form a narrow shaft are not seen as containers.
double findDeepestColumn(const Scene& scene, std::uint64_t grains);

}  // namespace sandflow
