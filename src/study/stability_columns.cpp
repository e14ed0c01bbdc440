#include "measure/height_map.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_cases.h"
#include "study/study_scenes.h"
#include "study/user_trial.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>

namespace sandflow {
namespace {

/// Sand in a tall box of smooth walls. Without friction the walls carry nothing and every level
/// carries the weight of all that is above it, as in the middle of a wide bed; with friction they
/// carry most of it (Janssen).
Scene makeColumn(double depth, double friction, Mode mode)
{
    Scene scene;
    scene.mode = mode;
    scene.contact.friction = friction;
    scene.contact.rollingFriction = friction == 0.0 ? 0.0 : scene.contact.rollingFriction;
    const double d = scene.diameter();
    const Vec2 half = Vec2::Constant(2.0 * d);
    scene.solids = {makeContainer(half, (depth + 10.0) * d, true)};
    scene.emitters.push_back(makeSettledFill(half, depth * d));
    // A column that sinks under its own weight swings as long as a pendulum of its sag; by then the
    // dashpots have used up the swing.
    scene.time.duration = 1.0 + 0.25 * std::sqrt(depth);
    return scene;
}

/// The vertical force [N] of the normal springs that cross a level, over the weight [N] above it.
double carriedShare(const Snapshot& sand, const Scene& scene, double stiffness, double level)
{
    double force = 0.0, mass = 0.0;
    for (std::size_t a = 0; a < sand.size(); ++a) {
        const double r = sand.radius[a];
        if (sand.position[a].z() > level) {
            mass += 4.0 / 3.0 * kPi * r * r * r * scene.grains.density;
        }
    }
    const double reach = 2.0 * scene.grains.radius * (1.0 + scene.grains.sizeSpread);
    std::vector<std::size_t> near;
    for (std::size_t a = 0; a < sand.size(); ++a) {
        if (std::abs(sand.position[a].z() - level) < reach) {
            near.push_back(a);
        }
    }
    for (const std::size_t a : near) {
        for (const std::size_t b : near) {
            const Vec3 apart = sand.position[a] - sand.position[b];
            const double overlap =
                static_cast<double>(sand.radius[a]) + static_cast<double>(sand.radius[b]) - apart.norm();
            if (sand.position[a].z() > level && sand.position[b].z() <= level && overlap > 0.0) {
                force += stiffness * overlap * apart.z() / apart.norm();
            }
        }
    }
    return force / (mass * scene.gravity.norm());
}

/// Spheres cannot be packed denser than this without order (0.64), but for what they overlap under
/// the load that max_overlap allows at the very bottom: a tenth of that on average.
constexpr double kDensest = 0.68;

/// Share by which a level may carry more or less than the weight above it.
constexpr double kLoadLimit = 0.05;

/// Settled sand is frozen from its birth in surface flow, while in dem it may still sag and close up:
/// by no more of its depth than poured sand differs in density (0.58 to 0.62).
constexpr double kDensityLimit = 0.035;

struct ColumnTrial {
    SceneTrial trial;
    std::vector<Check> checks;
    double top = 0.0;      ///< d, height of the sand's surface at the end
    double carried = 1.0;  ///< mean over time of what a level carries over the weight above it: of
                           ///< three levels the one farthest from 1
};

ColumnTrial runColumn(const Scene& scene)
{
    ColumnTrial column;
    SoundnessWatch watch(scene);
    double carried[3] = {};
    int looks = 0;
    column.trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& report) {
        watch.look(sand, report);
        // A deep column rings like a bell, for long; what its levels carry is right on average.
        if (report.time > 0.5 * *scene.time.duration) {
            ++looks;
            for (int k = 0; k < 3; ++k) {
                const double level = 0.2 * (k + 1) * scene.emitters[0].max.z();
                carried[k] += carriedShare(watch.last(), scene, sand.plan().law.stiffness, level);
            }
        }
        return true;
    });
    for (const double sum : carried) {
        const double share = looks > 0 ? sum / looks : 1.0;
        if (std::abs(share - 1.0) > std::abs(column.carried - 1.0)) {
            column.carried = share;
        }
    }
    watch.addChecks(column.checks);
    if (scene.contact.friction > 0.0) {
        // Without friction grains close up for long; what they carry tells whether they rest.
        watch.addRestCheck(column.checks);
    }
    const Snapshot& sand = column.trial.last;
    std::vector<double> heights;
    for (const Vec3& p : sand.position) {
        heights.push_back(p.z());
    }
    if (!heights.empty()) {
        // The mean of the highest layer of 16.
        const std::size_t layer = std::min<std::size_t>(16, heights.size());
        std::partial_sort(heights.begin(), heights.begin() + layer, heights.end(), std::greater<>());
        for (std::size_t k = 0; k < layer; ++k) {
            column.top += heights[k] / (static_cast<double>(layer) * scene.diameter());
        }
    }
    return column;
}

/// A column that is run when it is first asked for, once.
class ColumnRun {
public:
    explicit ColumnRun(Scene scene) : scene_(std::move(scene)) {}
    const Scene& scene() const { return scene_; }
    const ColumnTrial& get()
    {
        std::call_once(made_, [this] { column_ = runColumn(scene_); });
        return column_;
    }

private:
    Scene scene_;
    std::once_flag made_;
    ColumnTrial column_;
};

/// `dem`: the same column in dem, which is the truth for surface flow.
void judgeColumn(double depth, ColumnRun& run, ColumnRun& dem, Finding& finding)
{
    const Scene& scene = run.scene();
    const double friction = scene.contact.friction;
    const Mode mode = scene.mode;
    const ColumnTrial& column = run.get();
    if (judgeEnd(column.trial.end, column.trial.message, finding)) {
        return;
    }
    std::vector<Check> checks = column.checks;
    const Snapshot& sand = column.trial.last;
    const double d = scene.diameter();
    double volume = 0.0;
    for (const float r : sand.radius) {
        volume += 4.0 / 3.0 * kPi * std::pow(static_cast<double>(r), 3.0);
    }
    const double fraction = volume / (16.0 * d * d * column.top * d);
    checks.push_back({"solid fraction", fraction, kDensest, "", Verdict::wrongShape,
                      fmt::format("the column shrank to a solid fraction of {:.2f}: grains lie in "
                                  "each other",
                                  fraction)});
    if (friction == 0.0 && mode == Mode::dem) {
        checks.push_back({"load carried / weight above", std::abs(column.carried - 1.0), kLoadLimit,
                          "", Verdict::broke,
                          fmt::format("a level carries {:.2f} of the weight above it",
                                      column.carried)});
    }
    if (mode == Mode::surfaceFlow && friction > 0.0) {
        const ColumnTrial& truth = dem.get();
        if (judgeEnd(truth.trial.end, "the reference: " + truth.trial.message, finding)) {
            return;
        }
        const double sunk = column.top - truth.top;
        const double limit = std::max(kShapeLimit, kDensityLimit * depth);
        checks.push_back({"height, against dem", std::abs(sunk), limit, "d", Verdict::wrongShape,
                          fmt::format("it stands {:.1f} d high, in dem {:.1f} d", column.top,
                                      truth.top)});
    }
    judge(checks, finding);
}

}  // namespace

void addColumnCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const std::vector<double> depths = size == StudySize::quick
                                           ? std::vector<double>{10.0, 30.0}
                                           : std::vector<double>{10.0, 30.0, 100.0, 300.0};
    for (const double friction : {0.0, 0.5}) {
        for (const double depth : depths) {
            const auto dem = std::make_shared<ColumnRun>(makeColumn(depth, friction, Mode::dem));
            for (const Mode mode : {Mode::dem, Mode::surfaceFlow}) {
                const auto run = mode == Mode::dem
                                     ? dem
                                     : std::make_shared<ColumnRun>(makeColumn(depth, friction, mode));
                cases.push_back(makeCase(
                    friction == 0.0 ? "depth, no friction" : "depth", "d", depth, labelOf(mode),
                    [=](Finding& f) { judgeColumn(depth, *run, *dem, f); }));
            }
        }
    }
}

}  // namespace sandflow
