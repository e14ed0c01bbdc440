#pragma once

#include "scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace sandflow {

/// Told the keys that do not go together (the one to blame first) and what is wrong. Must throw.
using SceneComplaint =
    std::function<void(const std::vector<std::string>& keys, const std::string& problem)>;

/// Checks what no single value can tell: ends in order, sizes within a factor of five, grains that
/// fit the ids, ... Each value by itself is taken to be in its range.
void checkScene(const Scene& scene, const SceneComplaint& complain);

}  // namespace sandflow
