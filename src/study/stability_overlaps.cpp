#include "dem/dem.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_cases.h"
#include "study/study_scenes.h"
#include "study/user_trial.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// What a soft contact may make of its elastic energy: the integrator's error in one blow.
constexpr double kEnergyLimit = 1.02;

/// Sum of all momenta over the sum of their sizes; floats.
constexpr double kMomentumLimit = 1e-3;

/// Overlap that is left when grains that may go where they like have parted, in r.
constexpr double kLeftLimit = 0.01;

/// A weightless block of 6 x 6 x 6 equal grains, `overlap` [r] into each other. No emitter lets such
/// grains in, so they are put into the grain solver itself.
class OverlappingBlock {
public:
    OverlappingBlock(const RunPlan& plan, const Scene& scene, double overlap)
        : stiffness_(plan.law.stiffness), radius_(scene.grains.radius), step_(plan.step.step),
          dem_(makeSetup(plan, scene))
    {
        constexpr int kEdge = 6;
        const double apart = (2.0 - overlap) * radius_;
        std::uint32_t id = 0;
        for (int k = 0; k < kEdge * kEdge * kEdge; ++k) {
            // A hair off the lattice, which would otherwise part along its axes only.
            const double off = 0.01 * radius_ * std::sin(12.9898 * k);
            dem_.addMobile(apart * Vec3(k % kEdge, k / kEdge % kEdge, k / (kEdge * kEdge)) +
                               Vec3(off, -off, 0.5 * off),
                           Vec3::Zero(), Vec3::Zero(), radius_, ++id);
        }
    }

    void advance(double duration)
    {
        for (double time = 0.0; time < duration; time += step_) {
            if (!dem_.listsHold()) {
                dem_.recordContacts();
                dem_.rebuild(0.0, step_);
            }
            dem_.step(step_, false);
            mostMotion_ = std::max(mostMotion_, motion());
        }
    }

    double elasticEnergy() const
    {
        double sum = 0.0;
        forPairs([&](double overlap) { sum += 0.5 * stiffness_ * overlap * overlap; });
        return sum;
    }

    double deepestOverlap() const
    {
        double deepest = 0.0;
        forPairs([&](double overlap) { deepest = std::max(deepest, overlap / radius_); });
        return deepest;
    }

    double mostMotion() const { return mostMotion_; }

    double momentumShare() const
    {
        Vec3 sum = Vec3::Zero();
        double all = 0.0;
        for (const GrainRecord<float>& g : dem_.mobile().record) {
            const Vec3 p = Vec3(g.vx, g.vy, g.vz) / static_cast<double>(g.inverseMass);
            sum += p;
            all += p.norm();
        }
        return all > 0.0 ? sum.norm() / all : 0.0;
    }

private:
    static DemSetup makeSetup(const RunPlan& plan, const Scene& scene)
    {
        DemSetup setup;
        setup.law = plan.law;
        setup.meanRadius = setup.largestRadius = scene.grains.radius;
        setup.density = scene.grains.density;
        setup.gravity = Vec3::Zero();
        setup.judged = false;
        return setup;
    }

    template <class Visit>
    void forPairs(Visit&& visit) const
    {
        const auto& g = dem_.mobile().record;
        for (std::size_t a = 0; a < g.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                const Vec3 apart(g[a].x - g[b].x, g[a].y - g[b].y, g[a].z - g[b].z);
                const double overlap = 2.0 * radius_ - apart.norm();
                if (overlap > 0.0) {
                    visit(overlap);
                }
            }
        }
    }

    /// Energy of motion, J.
    double motion() const
    {
        double sum = 0.0;
        for (const GrainRecord<float>& g : dem_.mobile().record) {
            const double r = static_cast<double>(g.radius);
            sum += (0.5 * Vec3(g.vx, g.vy, g.vz).squaredNorm() +
                    0.2 * r * r * Vec3(g.wx, g.wy, g.wz).squaredNorm()) /
                   static_cast<double>(g.inverseMass);
        }
        return sum;
    }

    double stiffness_, radius_, step_;
    double mostMotion_ = 0.0;
    Dem<float> dem_;
};

/// The block relaxes: its springs may give no more than is in them, to all sides alike, and in the end
/// no grain is in another.
void judgeBlock(double overlap, double stepShare, Finding& finding)
{
    Scene scene = makeStudyPour(100, Mode::dem);
    scene.grains.sizeSpread = 0.0;
    scene.time.stepSafety = stepShare;
    OverlappingBlock block(planRun(scene), scene, overlap);
    const double stored = block.elasticEnergy();
    try {
        block.advance(2.0);
    } catch (const PhysicsError& error) {
        judgeEnd(TrialEnd::broke, error.what(), finding);
        return;
    }
    const double made = block.mostMotion() / stored;
    judge({{"energy of motion / stored", made, kEnergyLimit, "", Verdict::broke,
            fmt::format("the grains got {:.3g} times the energy that was stored", made)},
           {"momentum", block.momentumShare(), kMomentumLimit, "", Verdict::broke,
            "the block moved off as a whole"},
           {"overlap left", block.deepestOverlap(), kLeftLimit, "r", Verdict::wrongShape,
            fmt::format("grains still overlap by {:.2g} r", block.deepestOverlap())}},
          finding);
}

/// A grain is to come in where another lies: the program must let it wait until there is room.
void judgeEntry(double overlap, Mode mode, Finding& finding)
{
    Scene scene;
    scene.mode = mode;
    scene.solids.push_back(makeLevelFloor(false));
    const double r = scene.grains.radius;
    scene.emitters.push_back(makeOneGrain(Vec3(0.0, 0.0, 0.1), Vec3::Zero()));
    scene.emitters.push_back(makeOneGrain(Vec3(0.0, (2.0 - overlap) * r, 0.1), Vec3::Zero()));
    scene.time.duration = 0.5;
    SoundnessWatch watch(scene);
    const SceneTrial trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& f) {
        watch.look(sand, f);
        return true;
    });
    if (judgeEnd(trial.end, trial.message, finding)) {
        return;
    }
    std::vector<Check> checks;
    watch.addChecks(checks);
    checks.push_back({"grains that never came", 2.0 - static_cast<double>(trial.last.emitted), 0.5,
                      "grains", Verdict::broke, "a grain that was held back never came"});
    judge(checks, finding);
}

/// A floor appears that reaches `overlap` [r] into the lowest grains of a bed: what that presses into
/// them is all that may come out.
void judgeAppearingFloor(double overlap, Mode mode, Finding& finding)
{
    Scene scene;
    scene.mode = mode;
    const double r = scene.grains.radius, d = scene.diameter();
    const Vec2 half = Vec2::Constant(4.0 * d);
    SolidSpec rising = makeLevelFloor(false);
    rising.name = "rising floor";
    rising.point.z() = overlap * r;
    rising.from = 0.3;
    scene.solids = {makeLevelFloor(false), makeContainer(half, 20.0 * d, false), rising};
    scene.emitters.push_back(makeSettledFill(half, 5.0 * d));
    scene.time.duration = 1.5;
    SoundnessWatch watch(scene);
    double before = 0.0, highest = 0.0;
    const auto meanHeight = [&] {
        double sum = 0.0;
        for (const Vec3& p : watch.last().position) {
            sum += p.z();
        }
        return sum / static_cast<double>(watch.last().size());
    };
    const SceneTrial trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& f) {
        watch.look(sand, f);
        if (f.time < 0.3) {
            before = meanHeight();
        } else {
            highest = std::max(highest, meanHeight() - before);
        }
        return true;
    });
    if (judgeEnd(trial.end, trial.message, finding)) {
        return;
    }
    std::vector<Check> checks;
    watch.addRestCheck(checks);
    // All of the springs' energy spent on lifting all sand: m g h N = 1/2 k delta^2 for each lowest
    // grain, an eighth of all in a layer of each square d, and the floor's own rise.
    const double mass = 4.0 / 3.0 * kPi * r * r * r * scene.grains.density;
    const double pressed = overlap * r;
    const double lift = 0.5 * trial.plan->law.stiffness * pressed * pressed /
                            (mass * scene.gravity.norm()) * 64.0 /
                            static_cast<double>(trial.last.size()) +
                        pressed;
    checks.push_back({"lift / what the springs give", highest / lift, kEnergyLimit, "",
                      Verdict::broke,
                      fmt::format("the bed was lifted by {:.2g} d, {:.2g} times what was put in",
                                  highest / d, highest / lift)});
    const double below = static_cast<double>(
        std::count_if(trial.last.position.begin(), trial.last.position.end(),
                      [&](const Vec3& p) { return p.z() < rising.point.z(); }));
    checks.push_back({"grains below the floor", below, 0.5, "grains", Verdict::broke,
                      fmt::format("{} grains are below the floor", below)});
    judge(checks, finding);
}

}  // namespace

void addOverlapCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    // 0.6 r is 30 % of the distance at which grains touch.
    const std::vector<double> overlaps =
        quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.6, 1.0};
    for (const double overlap : overlaps) {
        cases.push_back(makeCase("start with overlap", "r", overlap, "dem, free block",
                                 [=](Finding& f) { judgeBlock(overlap, 0.8, f); }));
        cases.push_back(makeCase("start with overlap", "r", overlap, "dem, free block, whole bound",
                                 [=](Finding& f) { judgeBlock(overlap, 1.0, f); }));
        for (const Mode mode : {Mode::dem, Mode::surfaceFlow}) {
            cases.push_back(makeCase("start with overlap", "r", overlap, labelOf(mode) + ", emitted",
                                     [=](Finding& f) { judgeEntry(overlap, mode, f); }));
            cases.push_back(makeCase("start with overlap", "r", overlap,
                                     labelOf(mode) + ", floor appears",
                                     [=](Finding& f) { judgeAppearingFloor(overlap, mode, f); }));
        }
    }
}

}  // namespace sandflow
