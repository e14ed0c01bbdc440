#include "study/heap_sample.h"
#include "study/stability_cases.h"
#include "study/study_scenes.h"
#include "study/user_trial.h"

#include <cmath>

namespace sandflow {
namespace {

/// |e measured - e asked for|. At a tenth of the step bound as solvers that are set against each other
/// (Chung and Ooi 2011); at the step of a run, the coarsest that is stable, as MFIX asks of its own
/// rebounds.
constexpr double kFineLimit = 0.005, kLimit = 0.05;
constexpr double kFineStep = 0.1;

/// Against the speed of the blow: masses are floats.
constexpr double kMomentumLimit = 1e-4;

/// Weightless but for so little that it changes no speed by more than one in 10^5, over in ten times
/// the fall through one radius. Surface flow must know where down is.
void lastForOneBlow(Scene& scene, double speed)
{
    const double duration = 10.0 * scene.grains.radius / speed;
    scene.gravity = Vec3(0.0, 0.0, -1e-6 * speed / duration);
    scene.time.duration = duration;
    scene.time.framesPerSecond = 5.0 / duration;
}

void setStep(bool fine, Scene& scene)
{
    scene.time.stepSafety = fine ? kFineStep : scene.time.stepSafety;
}

/// A grain meets a smooth floor head-on: it must come back with e times its speed.
void judgeBounce(double speed, double restitution, bool fine, Mode mode, Finding& finding)
{
    Scene scene;
    scene.mode = mode;
    setStep(fine, scene);
    scene.grains.sizeSpread = 0.0;
    scene.contact.restitution = restitution;
    scene.solids.push_back(makeLevelFloor(false));
    const double r = scene.grains.radius;
    scene.emitters.push_back(makeOneGrain(Vec3(0.0, 0.0, 2.0 * r), Vec3(0.0, 0.0, -speed)));
    lastForOneBlow(scene, speed);
    const SceneTrial trial = runUserTrial(scene);
    if (judgeEnd(trial.end, trial.message, finding)) {
        return;
    }
    const double back = trial.last.size() == 1 ? trial.last.velocity[0].z() / speed : std::nan("");
    judge({{"speed after / before, against e", std::abs(back - restitution), fine ? kFineLimit : kLimit, "",
            Verdict::wrongShape,
            fmt::format("it comes back with {:.4f} of its speed, not {:.4g}", back, restitution)}},
          finding);
}

/// Two grains meet head-on in the air: they must part with e times the speed, and what one loses of
/// momentum the other gains.
void judgeBlow(double ratio, bool fine, Mode mode, Finding& finding)
{
    constexpr double kSpeed = 1.0;
    Scene scene;
    scene.mode = mode;
    setStep(fine, scene);
    scene.grains.sizeSpread = 0.0;
    scene.solids.push_back(makeLevelFloor(true));
    const double small = 2.0 * scene.grains.radius / (1.0 + ratio), large = ratio * small;
    const double height = 10.0 * large;
    EmitterSpec left = makeOneGrain(Vec3(-1.5 * large, 0.0, height), Vec3(kSpeed, 0.0, 0.0));
    left.grainRadius = large;
    EmitterSpec right = makeOneGrain(Vec3(1.5 * large, 0.0, height), Vec3::Zero());
    right.grainRadius = small;
    scene.emitters = {left, right};
    lastForOneBlow(scene, kSpeed);
    const SceneTrial trial = runUserTrial(scene);
    if (judgeEnd(trial.end, trial.message, finding)) {
        return;
    }
    if (trial.last.size() != 2) {
        finding.verdict = Verdict::broke;
        finding.cause = "two grains came in, others are there";
        return;
    }
    const double a = trial.last.velocity[0].x(), b = trial.last.velocity[1].x();
    const double ma = std::pow(large, 3.0), mb = std::pow(small, 3.0);
    const double e = scene.contact.restitution;
    judge({{"speed after / before, against e", std::abs((b - a) / kSpeed - e), fine ? kFineLimit : kLimit, "",
            Verdict::wrongShape,
            fmt::format("they part with {:.4f} of their speed, not {:.4g}", (b - a) / kSpeed, e)},
           {"momentum", std::abs((ma * a + mb * b) / (ma * kSpeed) - 1.0), kMomentumLimit, "",
            Verdict::broke, "the two do not keep their momentum"}},
          finding);
}

}  // namespace

void addBounceCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    const auto add = [&](const char* family, const char* parameter,
                         const std::vector<double>& values, auto judgeOne) {
        for (const double value : values) {
            for (const Mode mode : {Mode::dem, Mode::surfaceFlow}) {
                for (const bool fine : {false, true}) {
                    cases.push_back(makeCase(family, parameter, value,
                                             labelOf(mode) + (fine ? ", fine step" : ""),
                                             [=](Finding& f) { judgeOne(value, fine, mode, f); }));
                }
            }
        }
    };
    using Values = std::vector<double>;
    add("impact speed, one grain", "m/s",
        quick ? Values{0.1, 30.0} : Values{0.1, 0.3, 1.0, 3.0, 10.0, 30.0},
        [](double v, bool fine, Mode mode, Finding& f) { judgeBounce(v, 0.3, fine, mode, f); });
    add("restitution, one grain", "e",
        quick ? Values{0.005, 0.01, 1.0} : Values{0.005, 0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0},
        [](double e, bool fine, Mode mode, Finding& f) { judgeBounce(1.0, e, fine, mode, f); });
    add("size ratio, two grains", "large / small",
        quick ? Values{5.0, 6.0} : Values{1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
        [](double ratio, bool fine, Mode mode, Finding& f) { judgeBlow(ratio, fine, mode, f); });
}

}  // namespace sandflow
