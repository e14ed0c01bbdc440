#pragma once

#include "measure/floor.h"
#include "study/error_trial.h"

#include <functional>
#include <string>
#include <vector>

namespace sandflow {

/// What a study runs. Seeds are the scene's and the ones that follow it.
struct ErrorStudyPlan {
    std::string scenePath;
    std::vector<std::string> overrides;  ///< KEY=VALUE, for every trial
    std::size_t seeds = 2;
    bool quick = false;                  ///< only the ends of each sweep
    ErrorReference reference;
};

/// The ground of a scene at a time [s].
using SceneFloor = std::function<FloorHeight(const Scene&, double)>;

/// Told of every trial that is done, and of how many there will be.
using ErrorTrialWatcher =
    std::function<void(const ErrorTrial&, std::size_t done, std::size_t planned)>;

/// Runs the trials of a study one after another, seed by seed, the reference first, into a folder
/// that must not exist: scene.toml, trials.csv (a row as soon as its trial is done) and the
/// references' final states.
///
/// Throws InputError for a scene that cannot be studied, before there is a folder; what a trial
/// says if the reference or the default themselves fail.
void runErrorStudy(const ErrorStudyPlan& plan, const std::string& folder, const SceneFloor& floor,
                   const ErrorTrialWatcher& watch);

/// The trials of one or several studies of the same scene with different seeds.
struct ErrorStudyRecord {
    Scene scene;
    std::vector<ErrorTrial> trials;
    std::vector<HeapErrors> referencePairs;  ///< of different seeds, the later against the earlier
};

/// Throws InputError for a folder that holds no study, and if scenes differ or a seed is there
/// twice.
ErrorStudyRecord readErrorStudies(const std::vector<std::string>& folders, const SceneFloor& floor);

}  // namespace sandflow
