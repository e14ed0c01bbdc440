#include "core/errors.h"
#include "emit/emitter.h"
#include "scenes.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

TEST(RunPlan, EndsWhenTheLastGrainHasSettled)
{
    const Scene scene = makePour(1200, Mode::surfaceFlow);
    const RunPlan plan = planRun(scene);
    EXPECT_EQ(plan.grains, 1200u);
    EXPECT_DOUBLE_EQ(plan.framePeriod, 1.0 / 30.0);
    const double end = lastEmissionTime(scene) + scene.time.settle;
    EXPECT_GT(end, 2.9);
    EXPECT_GE(plan.endTime, end - 1e-9);
    EXPECT_LT(plan.endTime, end + plan.framePeriod);
    EXPECT_NEAR(plan.endTime, static_cast<double>(plan.frames) * plan.framePeriod, 1e-12);
}

TEST(RunPlan, AGivenDurationReplacesThat)
{
    Scene scene = makePour(1200, Mode::surfaceFlow);
    scene.time.duration = 0.5;
    EXPECT_EQ(planRun(scene).frames, 15u);
    scene.time.duration = 0.51;
    EXPECT_EQ(planRun(scene).frames, 16u);
}

TEST(RunPlan, SaysWhereItsNumbersComeFrom)
{
    const Scene scene = makePour(1200, Mode::surfaceFlow);
    const RunPlan plan = planRun(scene);
    EXPECT_TRUE(plan.stiffness.automatic);
    EXPECT_FALSE(plan.stiffness.reason.empty());
    EXPECT_FALSE(plan.step.reason.empty());
    EXPECT_GT(plan.step.step, 0.0);
    EXPECT_LE(plan.step.step, scene.time.stepSafety * plan.step.bound * (1.0 + 1e-12));
    EXPECT_GT(plan.law.stiffness, 0.0);
    EXPECT_LE(plan.stiffness.impactOverlap, 0.3 + 1e-9);
    EXPECT_LE(plan.stiffness.loadOverlap, 0.3 + 1e-9);
    // 0.5 m/s and a fall of 0.12 m.
    EXPECT_NEAR(plan.load.fastestSpeed, std::sqrt(0.25 + 2.0 * kGravity * 0.12), 0.05);
    EXPECT_NEAR(plan.load.minRadius, 0.0046, 1e-12);
    EXPECT_NEAR(plan.load.maxRadius, 0.0054, 1e-12);
    EXPECT_DOUBLE_EQ(plan.load.density, 2600.0);
    EXPECT_GT(plan.load.deepestColumn, 0.05);
    EXPECT_LT(plan.load.deepestColumn, 0.3);
}

TEST(RunPlan, TheNeutralSlopeMayBeTheMaterials)
{
    Scene scene = makePour(100, Mode::surfaceFlow);
    scene.surfaceFlow.reposeAngle = 31.5;
    EXPECT_EQ(planRun(scene).repose.neutralSlope(), 31.5);
    scene.surfaceFlow.reposeAngle.reset();
    const ReposeReport sand = planRun(scene).repose;
    EXPECT_EQ(sand.neutralSlope(), sand.expected + kAutoReposeMargin);
    scene.contact.friction = 0.1;
    EXPECT_LT(planRun(scene).repose.neutralSlope(), sand.neutralSlope() - 5.0);
}

TEST(RunPlan, CountsSinglesOfTheirOwnSize)
{
    Scene scene = makePour(100, Mode::dem);
    scene.emitters.push_back(makeSingle(Vec3(0, 0, 0.5)));
    scene.emitters.back().grainRadius = 0.009;
    const RunPlan plan = planRun(scene);
    EXPECT_EQ(plan.grains, 101u);
    EXPECT_DOUBLE_EQ(plan.load.maxRadius, 0.009);
}

TEST(RunPlan, RefusesAStepOrAStiffnessThatCannotHold)
{
    Scene coarse = makePour(100, Mode::dem), soft = coarse, fine = coarse;
    coarse.time.step = 0.01;
    EXPECT_THROW(planRun(coarse), InputError);
    soft.contact.stiffness = 1.0;
    EXPECT_THROW(planRun(soft), InputError);
    fine.time.step = 2e-5;
    EXPECT_DOUBLE_EQ(planRun(fine).step.step, 2e-5);
}

/// Twelve columns of `depth` side by side, in a container if there is one.
Scene makeShaft(double depth, bool contained)
{
    Scene scene = makeEmptyScene();
    EmitterSpec fill;
    fill.kind = EmitterKind::fill;
    fill.min = Vec3(-0.03, -0.03, 0.0);
    fill.max = Vec3(0.03, 0.03, depth);
    scene.emitters.push_back(fill);
    if (contained) {
        SolidSpec tube;
        tube.shape = SolidShape::cylinder;
        tube.hollow = true;
        tube.radius = 0.045;
        tube.height = depth + 0.1;
        scene.solids.push_back(tube);
    }
    return scene;
}

TEST(RunPlan, SettledSandStandsAsDeepAsItWasPutIn)
{
    for (const double depth : {0.1, 1.0, 3.0}) {
        const RunPlan plan = planRun(makeShaft(depth, false));
        EXPECT_GE(plan.load.deepestColumn, depth);
        EXPECT_LE(plan.load.deepestColumn, std::max(0.15, 1.01 * depth));
        EXPECT_LE(plan.stiffness.loadOverlap, 0.3 + 1e-9);
    }
}

TEST(RunPlan, AContainerKeepsSandFromRunningOut)
{
    // The same grains from a jet: on open ground a low cone, in a tube a column.
    Scene scene = makePour(3000, Mode::dem);
    const double open = planRun(scene).load.deepestColumn;
    SolidSpec tube;
    tube.shape = SolidShape::cylinder;
    tube.hollow = true;
    tube.radius = 0.03;
    tube.height = 2.0;
    scene.solids.push_back(tube);
    const double volume = 3000.0 * 4.0 / 3.0 * kPi * std::pow(0.005, 3);
    const double densest = volume / 0.64 / (kPi * 0.03 * 0.03);
    const double inTube = planRun(scene).load.deepestColumn;
    EXPECT_GT(inTube, densest);
    EXPECT_LT(inTube, 1.2 * densest);
    EXPECT_LT(open, 0.3 * inTube);
    // It runs over at the rim; what has run over makes no deeper column than on open ground.
    scene.solids.back().height = 0.2;
    EXPECT_DOUBLE_EQ(planRun(scene).load.deepestColumn, std::max(open, 0.2));
    // A block of that size is no container.
    scene.solids.back().hollow = false;
    EXPECT_DOUBLE_EQ(planRun(scene).load.deepestColumn, open);
}

TEST(RunPlan, IsWhatTheSimulationDoes)
{
    Scene scene = makePour(100, Mode::dem);
    scene.time.duration = 0.2;
    std::uint64_t steps = 0;
    double dtMin = 1.0;
    const auto simulation = run(scene, [&](const Simulation&, const FrameReport& report) {
        if (report.steps > 0) {
            steps += report.steps;
            dtMin = std::min(dtMin, report.dtMin);
            EXPECT_LE(report.dtMin, report.dtMean);
        }
    });
    const RunPlan plan = planRun(scene);
    EXPECT_EQ(simulation->plan().step.step, plan.step.step);
    EXPECT_LE(dtMin, plan.step.step);
    EXPECT_GE(static_cast<double>(steps) * plan.step.step, 0.2 - 0.01);
    EXPECT_LE(static_cast<double>(steps) * plan.step.step, 1.1 * 0.2);
}

}  // namespace
}  // namespace sandflow
