#pragma once

#include "scene/scene.h"

#include <string>

namespace sandflow {

/// The scene as TOML with every default written out, bit for bit: readScene gives the same scene
/// back. Keys that do not belong to a solid's shape or an emitter's kind, ends that are open
/// (domain, until), values that are absent (duration, camera) and a contact.repose_angle (friction
/// and rolling friction hold what was solved for it) are left out; Scene::sourcePath is not part of
/// it, so a relative `mesh` stays relative to the first file.
/// Throws InternalError for what no scene file can hold: a number that is not finite, a seed above
/// 2^63 - 1, a `look` that does not exist.
std::string writeScene(const Scene& scene);

}  // namespace sandflow
