#pragma once

#include "scene/scene.h"
#include "solids/solid_set.h"

#include <functional>

namespace sandflow {

/// True for a place within a few grains of a solid that one can look through, of glass or not drawn:
/// sand that is buried there is seen all the same. Empty if there is no such solid. `solids` must
/// outlive the result.
std::function<bool(const Vec3&)> findSeenThrough(const Scene& scene, const SolidSet& solids);

}  // namespace sandflow
