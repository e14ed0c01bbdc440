#include "study/scene_trial.h"

#include "core/errors.h"
#include "core/stage_clock.h"

#include <time.h>

#include <memory>

namespace sandflow {
namespace {

double processorSecondsNow()
{
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

FrameReport advanceTimed(Simulation& sand, SceneTrial& trial)
{
    const double before = processorSecondsNow();
    FrameReport report;
    {
        StageClock clock(trial.wallSeconds);
        report = sand.advanceFrame();
    }
    trial.processorSeconds += processorSecondsNow() - before;
    return report;
}

}  // namespace

const char* nameOf(TrialEnd end)
{
    switch (end) {
    case TrialEnd::finished:
        return "finished";
    case TrialEnd::stopped:
        return "stopped";
    case TrialEnd::refused:
        return "refused";
    case TrialEnd::broke:
        return "broke";
    }
    throw InternalError("unknown end of a trial");
}

SceneTrial runTrial(const Scene& scene, const TrialWatcher& watch)
{
    SceneTrial trial;
    try {
        const std::unique_ptr<Simulation> sand = makeSimulation(scene);
        trial.plan = sand->plan();
        while (!sand->finished()) {
            trial.frames.push_back(advanceTimed(*sand, trial));
            if (watch && !watch(*sand, trial.frames.back())) {
                trial.end = TrialEnd::stopped;
                break;
            }
        }
        sand->takeSnapshot(trial.last);
        trial.stateHash = sand->stateHash();
    } catch (const InputError& error) {
        trial.end = TrialEnd::refused;
        trial.message = error.what();
    } catch (const PhysicsError& error) {
        trial.end = TrialEnd::broke;
        trial.message = error.what();
    }
    return trial;
}

}  // namespace sandflow
