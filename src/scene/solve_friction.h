#pragma once

#include "scene/scene_source.h"

namespace sandflow {

struct ContactSpec;

/// Solves the rolling friction, or the friction, for contact.repose_angle if the file gives that;
/// which of the two follows from the keys that are there (scenes/README.md). Throws InputError
/// where the keys do not go together or no coefficient gives the angle.
void solveFriction(const SceneSource& source, ContactSpec& contact);

}  // namespace sandflow
