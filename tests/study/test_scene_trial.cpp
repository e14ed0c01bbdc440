#include "solver/scenes.h"
#include "study/scene_trial.h"

namespace sandflow {
namespace {

using testing::makePour;

TEST(SceneTrial, EndsWhereARunEnds)
{
    Scene scene = makePour(60, Mode::surfaceFlow);
    scene.time.duration = 0.3;
    const SceneTrial trial = runTrial(scene);
    const auto twin = testing::run(scene);
    ASSERT_EQ(trial.end, TrialEnd::finished) << trial.message;
    EXPECT_TRUE(trial.gaveSand());
    EXPECT_EQ(trial.stateHash, twin->stateHash());
    EXPECT_EQ(trial.frames.size(), 9u);  // 30 a second
    EXPECT_EQ(trial.last.size(), trial.frames.back().ledger.emitted);
    EXPECT_EQ(trial.plan->grains, 60u);
    EXPECT_GT(trial.wallSeconds, 0.0);
    EXPECT_GT(trial.processorSeconds, 0.0);
}

TEST(SceneTrial, TheWatcherEndsIt)
{
    Scene scene = makePour(60, Mode::dem);
    scene.time.duration = 0.3;
    const SceneTrial trial = runTrial(
        scene, [](const Simulation&, const FrameReport& report) { return report.frame < 4; });
    EXPECT_EQ(trial.end, TrialEnd::stopped);
    EXPECT_EQ(trial.frames.size(), 4u);
    EXPECT_EQ(trial.last.frame, 4u);
}

TEST(SceneTrial, ARefusedSceneIsAnOutcome)
{
    Scene scene = makePour(60, Mode::dem);
    scene.time.step = 0.05;  // far beyond the bound
    const SceneTrial trial = runTrial(scene);
    EXPECT_EQ(trial.end, TrialEnd::refused);
    EXPECT_FALSE(trial.gaveSand());
    EXPECT_NE(trial.message.find("time.step"), std::string::npos) << trial.message;
    EXPECT_FALSE(trial.plan.has_value());
    EXPECT_TRUE(trial.frames.empty());
}

TEST(SceneTrial, BrokenPhysicsIsAnOutcomeThatKeepsItsFrames)
{
    Scene scene = makePour(60, Mode::dem);
    scene.time.duration = 0.3;
    const SceneTrial trial =
        runTrial(scene, [](const Simulation&, const FrameReport& report) -> bool {
            return report.frame < 3 ? true : throw PhysicsError("as a solver would say it");
        });
    EXPECT_EQ(trial.end, TrialEnd::broke);
    EXPECT_FALSE(trial.gaveSand());
    EXPECT_EQ(trial.frames.size(), 3u);
    EXPECT_EQ(trial.message, "as a solver would say it");
}

TEST(SceneTrial, AFaultOfOursIsNot)
{
    EXPECT_THROW(runTrial(makePour(10, Mode::dem),
                          [](const Simulation&, const FrameReport&) -> bool {
                              throw InternalError("broken");
                          }),
                 InternalError);
}

}  // namespace
}  // namespace sandflow
