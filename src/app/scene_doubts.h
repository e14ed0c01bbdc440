#pragma once

#include "scene/scene.h"
#include "solver/simulation.h"

#include <string>
#include <vector>

namespace sandflow {

/// What is allowed but probably not meant, or will look odd: one sentence each, with a remedy where
/// there is one. What the meshes have to say comes first.
std::vector<std::string> findDoubts(const Scene& scene, const SolidSet& solids,
                                    const RunPlan& plan);

}  // namespace sandflow
