#include "study/user_trial.h"

#include "core/errors.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"

namespace sandflow {

SceneTrial runUserTrial(const Scene& scene, const TrialWatcher& watch)
{
    Scene read;
    try {
        read = parseScene(writeScene(scene), "scene.toml");
    } catch (const InputError& error) {
        SceneTrial refused;
        refused.end = TrialEnd::refused;
        refused.message = error.what();
        return refused;
    }
    return runTrial(read, watch);
}

}  // namespace sandflow
