#include "measure/compare.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_cases.h"
#include "study/study_scenes.h"
#include "study/user_trial.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace sandflow {
namespace {

constexpr double kCellLimit = 0.7;  // d, what is promised of sand that is no single heap

/// Grains that a blow moves by more than a diameter: so many times more or fewer than in dem, where
/// chance alone may move this many.
constexpr double kMovedFactor = 2.0;
constexpr double kMovedByChance = 10.0;

constexpr double kBlowAt = 0.2;  // s, when the bed has come to rest

Scene makeShotBed(double speed, Mode mode, bool quick)
{
    Scene scene;
    scene.mode = mode;
    const double d = scene.diameter();
    const Vec2 half = Vec2::Constant((quick ? 5.0 : 6.0) * d);
    scene.solids = {makeLevelFloor(true), makeContainer(half, 30.0 * d, false)};
    scene.emitters.push_back(makeSettledFill(half, 5.0 * d));
    scene.emitters.push_back(makeOneGrain(Vec3(0.1 * d, 0.2 * d, 9.0 * d), Vec3(0.0, 0.0, -speed)));
    scene.emitters.back().start = kBlowAt;
    scene.time.duration = quick ? 0.8 : 1.2;
    return scene;
}

struct ShotBed {
    SceneTrial trial;
    std::vector<Check> checks;
    double moved = 0.0;  ///< grains that lie over 1 d from where they lay before
};

ShotBed shoot(const Scene& scene)
{
    ShotBed bed;
    SoundnessWatch watch(scene);
    Snapshot before;
    bed.trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& report) {
        watch.look(sand, report);
        if (report.time <= kBlowAt) {
            before = watch.last();
        }
        return true;
    });
    watch.addChecks(bed.checks);
    watch.addRestCheck(bed.checks);
    const Snapshot& after = bed.trial.last;
    for (std::size_t a = 0, b = 0; a < before.size() && b < after.size(); ++a) {
        while (b < after.size() && after.id[b] < before.id[a]) {
            ++b;
        }
        if (b < after.size() && after.id[b] == before.id[a]) {
            bed.moved += (after.position[b] - before.position[a]).norm() > scene.diameter() ? 1 : 0;
        }
    }
    return bed;
}

void judgeShot(double speed, Mode mode, bool quick, Finding& finding)
{
    const ShotBed bed = shoot(makeShotBed(speed, mode, quick));
    if (judgeEnd(bed.trial.end, bed.trial.message, finding)) {
        return;
    }
    std::vector<Check> checks = bed.checks;
    if (mode == Mode::surfaceFlow) {
        const ShotBed truth = shoot(makeShotBed(speed, Mode::dem, quick));
        if (judgeEnd(truth.trial.end, "the reference: " + truth.trial.message, finding)) {
            return;
        }
        const double shape = compareHeaps(truth.trial.last, bed.trial.last).cells.mean;
        checks.push_back({"mean |dH| on 5 d cells", shape, kCellLimit, "d", Verdict::wrongShape,
                          fmt::format("the bed differs from that of dem by {:.2f} d", shape)});
        const double more = (bed.moved + kMovedByChance) / (truth.moved + kMovedByChance);
        checks.push_back({"grains moved, against dem", std::max(more, 1.0 / more), kMovedFactor, "x",
                          Verdict::wrongShape,
                          fmt::format("the blow moved {} grains by over 1 d, in dem {}", bed.moved,
                                      truth.moved)});
    }
    judge(checks, finding);
}

}  // namespace

void addImpactCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    const std::vector<double> speeds =
        quick ? std::vector<double>{10.0} : std::vector<double>{0.1, 0.3, 1.0, 3.0, 10.0, 30.0};
    for (const double speed : speeds) {
        for (const Mode mode : {Mode::dem, Mode::surfaceFlow}) {
            cases.push_back(makeCase("impact speed, bed", "m/s", speed, labelOf(mode),
                                     [=](Finding& f) { judgeShot(speed, mode, quick, f); }));
        }
    }
}

}  // namespace sandflow
