#include "measure/compare.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_cases.h"
#include "study/study_scenes.h"
#include "study/user_trial.h"

#include <cmath>
#include <memory>
#include <mutex>

namespace sandflow {
namespace {

/// On cells of 5 d: what the program promises of sand that is no single heap.
constexpr double kCellLimit = 0.7;  // d

/// Poured sand of such grains lies at 22 to 28 degrees, and a bed at rest stands a few degrees more.
/// Up to here it must stay, from there on it must flow; between them dem tells.
constexpr double kMustStay = 20.0, kMustFlow = 45.0;  // degrees

/// A bed that flowed has changed its height by at least this, on average over the container.
constexpr double kFlowed = 1.0;  // d

/// A level bed in a container, with gravity leaning towards +x.
Scene makeTiltedBed(double degrees, Mode mode, bool quick)
{
    Scene scene;
    scene.mode = mode;
    const double d = scene.diameter(), tilt = degrees * kPi / 180.0;
    const Vec2 half = quick ? Vec2(8.0 * d, 4.0 * d) : Vec2(15.0 * d, 4.0 * d);
    scene.gravity = kGravity * Vec3(std::sin(tilt), 0.0, -std::cos(tilt));
    scene.solids = {makeLevelFloor(true), makeContainer(half, 40.0 * d, false)};
    scene.emitters.push_back(makeSettledFill(half, 6.0 * d));
    scene.time.duration = quick ? 1.0 : 2.0;
    return scene;
}

struct BedTrial {
    SceneTrial trial;
    Snapshot first;
    std::vector<Check> checks;
};

BedTrial runBed(const Scene& scene)
{
    BedTrial bed;
    SoundnessWatch watch(scene);
    bed.trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& report) {
        watch.look(sand, report);
        if (report.frame == 1) {
            bed.first = watch.last();
        }
        return true;
    });
    watch.addChecks(bed.checks);
    watch.addRestCheck(bed.checks);
    return bed;
}

/// A bed that is run when it is first asked for, once.
class BedRun {
public:
    explicit BedRun(Scene scene) : scene_(std::move(scene)) {}
    const BedTrial& get()
    {
        std::call_once(made_, [this] { bed_ = runBed(scene_); });
        return bed_;
    }

private:
    Scene scene_;
    std::once_flag made_;
    BedTrial bed_;
};

void judgeTilt(double degrees, const BedTrial& bed, Finding& finding)
{
    if (judgeEnd(bed.trial.end, bed.trial.message, finding)) {
        return;
    }
    std::vector<Check> checks = bed.checks;
    const double moved = compareHeaps(bed.first, bed.trial.last).cells.mean;
    if (degrees <= kMustStay) {
        checks.push_back({"mean |dH| since the start", moved, kShapeLimit, "d", Verdict::wrongShape,
                          fmt::format("the bed lies below its angle of repose and moved by {:.2f} d",
                                      moved)});
    }
    if (degrees >= kMustFlow) {
        checks.push_back({"flow wanted / seen", kFlowed / std::max(moved, 1e-3), 1.0, "",
                          Verdict::wrongShape,
                          fmt::format("the bed lies {:.0f} degrees steep and moved by {:.2f} d only",
                                      degrees, moved)});
    }
    judge(checks, finding);
}

/// Against dem as well.
void judgeTiltOfFlow(double degrees, const BedTrial& bed, const BedTrial& truth, Finding& finding)
{
    judgeTilt(degrees, bed, finding);
    if (finding.verdict != Verdict::sound ||
        judgeEnd(truth.trial.end, "the reference: " + truth.trial.message, finding)) {
        return;
    }
    const HeapComparison difference = compareHeaps(truth.trial.last, bed.trial.last);
    judge({finding.decisive,
           {"mean |dH| on 5 d cells", difference.cells.mean, kCellLimit, "d", Verdict::wrongShape,
            fmt::format("the bed differs from that of dem by {:.2f} d on average and {:.1f} d at "
                        "worst",
                        difference.cells.mean, difference.cells.worst)}},
          finding);
}

}  // namespace

void addTiltCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    const std::vector<double> tilts =
        quick ? std::vector<double>{20.0}
              : std::vector<double>{0.0, 10.0, 20.0, 30.0, 35.0, 40.0, 45.0};
    for (const double tilt : tilts) {
        const auto dem = std::make_shared<BedRun>(makeTiltedBed(tilt, Mode::dem, quick));
        const auto flow = std::make_shared<BedRun>(makeTiltedBed(tilt, Mode::surfaceFlow, quick));
        cases.push_back(makeCase("tilted gravity", "degrees", tilt, labelOf(Mode::dem),
                                 [=](Finding& f) { judgeTilt(tilt, dem->get(), f); }));
        cases.push_back(makeCase(
            "tilted gravity", "degrees", tilt, labelOf(Mode::surfaceFlow),
            [=](Finding& f) { judgeTiltOfFlow(tilt, flow->get(), dem->get(), f); }));
    }
}

}  // namespace sandflow
