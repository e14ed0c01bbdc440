#pragma once

#include "study/scene_trial.h"

namespace sandflow {

/// runTrial of a scene as a user would give it: as a scene file, so that what the reader refuses is
/// refused here as well.
SceneTrial runUserTrial(const Scene& scene, const TrialWatcher& watch = {});

}  // namespace sandflow
