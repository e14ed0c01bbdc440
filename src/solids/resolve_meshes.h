#pragma once

#include "scene/scene.h"
#include "solids/solid_set.h"

namespace sandflow {

/// The scene with its meshes named as they were found, so that a copy of it finds them from any
/// folder. `solids` are those of the scene.
Scene resolveMeshes(Scene scene, const SolidSet& solids);

}  // namespace sandflow
