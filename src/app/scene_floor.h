#pragma once

#include "measure/floor.h"
#include "scene/scene.h"

namespace sandflow {

/// The ground of a scene: over (x, y) the lowest surface with room for sand above it, of the solids
/// that exist at `time` [s]; 0 where there is none. Throws InputError for a solid that cannot be
/// built.
FloorHeight makeSceneFloor(const Scene& scene, double time);

}  // namespace sandflow
