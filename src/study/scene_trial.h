#pragma once

#include "grains/snapshot.h"
#include "scene/scene.h"
#include "solver/simulation.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sandflow {

enum class TrialEnd {
    finished,
    stopped,  ///< the watcher had seen enough
    refused,  ///< the scene's numbers cannot work: nothing was simulated
    broke     ///< the physics broke on the way
};

/// "finished", "stopped", "refused" or "broke".
const char* nameOf(TrialEnd end);

/// What one run of a scene gave and cost, kept in memory.
struct SceneTrial {
    TrialEnd end = TrialEnd::finished;
    std::string message;              ///< of a refused or broken trial: one sentence
    std::optional<RunPlan> plan;      ///< none if it was refused
    std::vector<FrameReport> frames;  ///< of the frames that were finished
    Snapshot last;                    ///< after the last of them; not of a broken trial
    std::uint64_t stateHash = 0;      ///< likewise
    double wallSeconds = 0.0;         ///< of the frames: no set-up, no measuring
    double processorSeconds = 0.0;    ///< likewise, of all threads; steady on a busy machine

    bool gaveSand() const { return end == TrialEnd::finished || end == TrialEnd::stopped; }
};

/// Looks at a run after every frame; false ends it.
using TrialWatcher = std::function<bool(const Simulation&, const FrameReport&)>;

/// Runs a scene to its end, or until the watcher ends it, with the threads that OpenMP is set to.
/// InputError and PhysicsError become the trial's end and message, so that a study goes on to its
/// next trial; everything else is passed on.
SceneTrial runTrial(const Scene& scene, const TrialWatcher& watch = {});

}  // namespace sandflow
