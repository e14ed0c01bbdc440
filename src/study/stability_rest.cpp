#include "measure/heap.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_cases.h"
#include "study/user_trial.h"

#include <cmath>

namespace sandflow {
namespace {

/// A pile left alone for 100,000 steps may not lean by more.
constexpr double kDriftLimit = 0.5;  // degrees

/// After so many steps the pile is looked at.
const std::vector<double> kMarks = {1e3, 3e3, 1e4, 3e4, 1e5};

/// Of the cone that the heap amounts to: a heap of a few hundred grains has no straight flank.
double slopeOf(const Snapshot& sand)
{
    HeapFigures heap = measureHeap(sand);
    for (double& height : heap.profile) {
        height /= heap.diameter;
    }
    return coneAngle(heap.profile);
}

/// Pours a heap, then leaves it alone. Where all sand sleeps no steps are taken; their time passes
/// all the same.
std::vector<Finding> leaveAlone(const Finding& head, Scene scene, const std::vector<double>& marks)
{
    const double settled = static_cast<double>(scene.emitters[0].count) / scene.emitters[0].rate + 1.5;
    std::vector<Finding> findings;
    const auto note = [&](double steps) -> Finding& {
        findings.push_back(head);
        findings.back().value = steps;
        return findings.back();
    };
    double step = 0.0;
    try {
        step = planRun(scene).step.step;
    } catch (const InputError& error) {
        judgeEnd(TrialEnd::refused, error.what(), note(marks.front()));
        return findings;
    }
    scene.time.duration = settled + marks.back() * step + 0.1;

    SoundnessWatch watch(scene);
    std::optional<double> start;  // degrees
    double begin = 0.0;
    const SceneTrial trial =
        runUserTrial(scene, [&](const Simulation& sand, const FrameReport& report) {
            watch.look(sand, report);
            if (!start && report.time >= settled) {
                start = slopeOf(watch.last());
                begin = report.time;
            }
            if (start && findings.size() < marks.size() &&
                report.time - begin >= marks[findings.size()] * step) {
                Finding& finding = note(marks[findings.size()]);
                std::vector<Check> checks;
                watch.addChecks(checks);
                watch.addRestCheck(checks);
                const double now = slopeOf(watch.last());
                checks.push_back({"drift of the slope", std::abs(now - *start), kDriftLimit, "deg",
                                  Verdict::wrongShape,
                                  fmt::format("left alone, the pile went from {:.2f} to {:.2f} degrees",
                                              *start, now)});
                judge(checks, finding);
            }
            return findings.size() < marks.size();
        });
    if (trial.end == TrialEnd::refused || trial.end == TrialEnd::broke) {
        judgeEnd(trial.end, trial.message, note(marks[std::min(findings.size(), marks.size() - 1)]));
    }
    return findings;
}

}  // namespace

void addRestCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    const auto add = [&](Mode mode, bool sleep, const std::string& more) {
        Scene scene = makeStudyPour(quick ? 300 : 800, mode);
        scene.skip.sleep = sleep;
        StabilityCase made;
        made.head.family = "at rest";
        made.head.parameter = "steps";
        made.head.mode = labelOf(mode) + more;
        const std::vector<double> marks = quick ? std::vector<double>{1e3, 1e4} : kMarks;
        made.run = [scene, marks](const Finding& head) { return leaveAlone(head, scene, marks); };
        cases.push_back(made);
    };
    add(Mode::dem, true, "");
    add(Mode::surfaceFlow, true, "");
    add(Mode::surfaceFlow, false, ", no sleep");
}

}  // namespace sandflow
