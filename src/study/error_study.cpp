#include "study/error_study.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/state_file.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "solids/resolve_meshes.h"
#include "study/study_folder.h"
#include "study/trial_csv.h"

#include <algorithm>
#include <set>

namespace sandflow {
namespace {

std::string trialsPath(const std::string& folder)
{
    return folder + "/trials.csv";
}

std::string scenePath(const std::string& folder)
{
    return folder + "/scene.toml";
}

std::string referencePath(const std::string& folder, std::uint64_t seed)
{
    return fmt::format("{}/reference_seed_{}.bin", folder, seed);
}

/// The settings with the default among them again every few trials, and at the end: machines change
/// their pace within minutes, and it is what times are compared with.
std::vector<ErrorSetting> withPaceTrials(const std::vector<ErrorSetting>& settings)
{
    constexpr std::size_t kApart = 8;
    std::vector<ErrorSetting> schedule;
    for (std::size_t k = 0; k < settings.size(); ++k) {
        schedule.push_back(settings[k]);
        if (k > 0 && (k % kApart == 0 || k + 1 == settings.size())) {
            schedule.push_back(settings.front());
        }
    }
    return schedule;
}

/// The trials of one seed after another.
class ErrorStudy {
public:
    ErrorStudy(const ErrorStudyPlan& plan, const std::string& folder, const SceneFloor& floor,
               const ErrorTrialWatcher& watch)
        : plan_(plan), folder_(folder), floor_(floor), watch_(watch)
    {
        base_ = readScene(plan.scenePath, plan.overrides);
        const std::unique_ptr<Simulation> sand = makeSimulation(base_);
        const double stiffness = sand->plan().law.stiffness;
        schedule_ = withPaceTrials(listErrorSettings(base_, stiffness, plan.quick));
        reference_ = makeReferenceSetting(base_, stiffness, plan.reference);
        refuseBeforehand(sand->solids().meshBounds());
        makeStudyFolder(folder);
        writeFileAtomically(scenePath(folder), writeScene(resolveMeshes(base_, sand->solids())));
    }

    void run()
    {
        TrialCsv csv(trialsPath(folder_), errorTrialColumns());
        for (std::uint64_t seed = base_.seed; seed < base_.seed + plan_.seeds; ++seed) {
            runSeed(seed, csv);
        }
    }

private:
    /// What no seed may have is said now, not after the first hour: an emitter's opening may be too
    /// small with one seed and not with another.
    void refuseBeforehand(std::span<const Eigen::AlignedBox3d> meshBounds) const
    {
        for (std::uint64_t seed = base_.seed; seed < base_.seed + plan_.seeds; ++seed) {
            try {
                planRun(readWith(schedule_.front(), seed), meshBounds);
                planRun(readWith(reference_, seed), meshBounds);
            } catch (const InputError& error) {
                throw InputError(fmt::format("with seed {}: {}", seed, error.what()));
            }
        }
    }

    Scene readWith(const ErrorSetting& setting, std::uint64_t seed) const
    {
        std::vector<std::string> overrides = plan_.overrides;
        overrides.insert(overrides.end(), setting.overrides.begin(), setting.overrides.end());
        overrides.push_back(fmt::format("seed={}", seed));
        return readScene(plan_.scenePath, overrides);
    }

    SceneTrial runWith(const ErrorSetting& setting, std::uint64_t seed) const
    {
        try {
            return runTrial(readWith(setting, seed));
        } catch (const InputError& error) {  // keys of the scene that do not go with the setting's
            SceneTrial refused;
            refused.end = TrialEnd::refused;
            refused.message = error.what();
            return refused;
        }
    }

    void runSeed(std::uint64_t seed, TrialCsv& csv)
    {
        const SceneTrial exact = runWith(reference_, seed);
        record(reference_, seed, exact, {}, csv);
        insistOn(exact);
        writeState(referencePath(folder_, seed), exact.last);
        const FloorHeight ground = floor_(base_, exact.last.time);
        for (std::size_t k = 0; k < schedule_.size(); ++k) {
            const SceneTrial trial = runWith(schedule_[k], seed);
            const HeapErrors errors = trial.end == TrialEnd::finished
                                          ? errorsOf(compareHeaps(exact.last, trial.last, ground))
                                          : HeapErrors{};
            record(schedule_[k], seed, trial, errors, csv);
            if (k == 0) {
                insistOn(trial);
            }
        }
    }

    /// Without the reference and the default nothing else can be judged.
    static void insistOn(const SceneTrial& trial)
    {
        if (trial.end == TrialEnd::refused) {
            throw InputError(trial.message);
        }
        if (trial.end == TrialEnd::broke) {
            throw PhysicsError(trial.message);
        }
    }

    void record(const ErrorSetting& setting, std::uint64_t seed, const SceneTrial& trial,
                const HeapErrors& errors, TrialCsv& csv)
    {
        ErrorTrial row;
        row.setting = setting;
        row.seed = seed;
        row.end = trial.end;
        row.wallSeconds = trial.wallSeconds;
        row.processorSeconds = trial.processorSeconds;
        for (const FrameReport& frame : trial.frames) {
            row.steps += frame.steps;
            row.grainSteps += frame.grainSteps;
        }
        row.errors = errors;
        row.message = trial.message;
        csv.append(errorTrialFields(row));
        watch_(row, ++done_, plan_.seeds * (schedule_.size() + 1));
    }

    const ErrorStudyPlan& plan_;
    const std::string& folder_;
    const SceneFloor& floor_;
    const ErrorTrialWatcher& watch_;
    Scene base_;
    std::vector<ErrorSetting> schedule_;
    ErrorSetting reference_;
    std::size_t done_ = 0;
};

/// Seeds with a reference that finished.
std::vector<std::uint64_t> referencedSeeds(const std::vector<ErrorTrial>& trials)
{
    std::vector<std::uint64_t> seeds;
    for (const ErrorTrial& trial : trials) {
        if (trial.isReference() && trial.end == TrialEnd::finished) {
            seeds.push_back(trial.seed);
        }
    }
    return seeds;
}

}  // namespace

void runErrorStudy(const ErrorStudyPlan& plan, const std::string& folder, const SceneFloor& floor,
                   const ErrorTrialWatcher& watch)
{
    ErrorStudy(plan, folder, floor, watch).run();
}

ErrorStudyRecord readErrorStudies(const std::vector<std::string>& folders, const SceneFloor& floor)
{
    ErrorStudyRecord record;
    std::vector<Snapshot> references;
    std::set<std::uint64_t> known;
    for (const std::string& folder : folders) {
        const std::vector<ErrorTrial> trials = readErrorTrials(trialsPath(folder));
        Scene scene = readScene(scenePath(folder));
        if (&folder == &folders.front()) {
            record.scene = scene;
        }
        scene.seed = record.scene.seed;
        if (writeScene(scene) != writeScene(record.scene)) {
            throw InputError(fmt::format("{} and {} are studies of different scenes: see the "
                                         "scene.toml of each",
                                         folders.front(), folder));
        }
        for (const std::uint64_t seed : referencedSeeds(trials)) {
            if (!known.insert(seed).second) {
                throw InputError(fmt::format("{}: seed {} is in another of the studies too: give "
                                             "each its own with --set seed=N",
                                             folder, seed));
            }
            references.push_back(readState(referencePath(folder, seed)));
        }
        record.trials.insert(record.trials.end(), trials.begin(), trials.end());
    }
    for (std::size_t b = 1; b < references.size(); ++b) {
        const FloorHeight ground = floor(record.scene, references[b].time);
        for (std::size_t a = 0; a < b; ++a) {
            record.referencePairs.push_back(
                errorsOf(compareHeaps(references[a], references[b], ground)));
        }
    }
    return record;
}

}  // namespace sandflow
