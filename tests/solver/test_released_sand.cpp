#include "scenes.h"

#include "measure/heap.h"
#include "measure/release.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kRadius = 0.005;

struct Release {
    ReleaseFigures figures;
    double deepest = 0.0;  ///< m, overlap
    Ledger before, after;
};

/// Pours a heap, lets it come to rest, sets it free and watches it for 0.3 s.
Release releaseHeap(std::int64_t count, Mode mode)
{
    Scene scene = makePour(count, mode);
    scene.time.settle = 1.5;  // when its flow ends the bed is set free once more
    const auto simulation = run(scene);
    Release release;
    release.before = simulation->ledger();
    ReleaseWatch watch(snapshotOf(*simulation), levelFloor(0.0), kGravity);
    simulation->releaseAll();
    for (int n = 0; n < 9; ++n) {
        const FrameReport report = simulation->advanceFrame();
        EXPECT_TRUE(report.ledger.balances());
        EXPECT_EQ(report.ledger.mobile, static_cast<std::uint64_t>(count));
        EXPECT_EQ(report.ledger.asleep, 0u);
        EXPECT_EQ(simulation->countLeaks(), 0u);
        release.deepest = std::max(release.deepest, report.deepestOverlap);
        release.after = report.ledger;
        watch.look(snapshotOf(*simulation));
    }
    release.figures = watch.figures(snapshotOf(*simulation));
    return release;
}

TEST(ReleaseAll, AFrozenHeapIsARealState)
{
    const Release frozen = releaseHeap(1500, Mode::surfaceFlow);
    const Release control = releaseHeap(1500, Mode::dem);
    EXPECT_GT(frozen.before.interface + frozen.before.buried + frozen.before.asleep, 1000u);
    EXPECT_EQ(control.before.mobile, 1500u);
    for (const Release& release : {frozen, control}) {
        EXPECT_NEAR(release.figures.seconds, 0.3, 1e-9);
        EXPECT_LT(std::abs(release.figures.apexMoved), 0.5);
        EXPECT_LT(release.figures.fastest, release.figures.couldFall);
        EXPECT_LT(release.deepest, 0.15 * kRadius);
    }
    EXPECT_LT(frozen.figures.meanHeightChange, control.figures.meanHeightChange + 0.2);
}

TEST(ReleaseAll, WipesTheSpringsOfFullDem)
{
    // The springs that held the heap are gone: it gives way a little, which it does not by itself.
    const Scene scene = makePour(400, Mode::dem);
    const auto left = run(scene), wiped = run(scene);
    const Snapshot before = snapshotOf(*left);
    EXPECT_EQ(largestMove(before, snapshotOf(*wiped)), 0.0);
    wiped->releaseAll();
    left->advanceFrame();
    wiped->advanceFrame();
    EXPECT_GT(largestMove(before, snapshotOf(*wiped)), 3.0 * largestMove(before, snapshotOf(*left)));
}

TEST(ReleaseAll, EndsThePour)
{
    const Scene scene = makePour(800, Mode::surfaceFlow);
    const auto simulation = run(scene, [](const Simulation&, const FrameReport&) {}, 20);
    const std::uint64_t poured = simulation->ledger().emitted;
    EXPECT_GT(poured, 300u);
    EXPECT_LT(poured, 500u);
    simulation->releaseAll();
    for (int n = 0; n < 6; ++n) {
        const FrameReport report = simulation->advanceFrame();
        EXPECT_EQ(report.ledger.emitted, poured);
        EXPECT_EQ(report.ledger.mobile, poured);
        EXPECT_EQ(report.transfer.trapped + report.transfer.fellAsleep, 0u);
    }
}

class HundredThousandSteps : public ::testing::TestWithParam<Mode> {};

TEST_P(HundredThousandSteps, LeaveAHeapAsItWas)
{
    const std::int64_t count = 800;  // fewer make no flank to fit an angle to
    Scene scene = makePour(count, GetParam());
    scene.time.settle = 1e3;
    const auto simulation = makeSimulation(scene);
    double time = 0.0;
    while (time < static_cast<double>(count) / 600.0 + 1.0) {
        time = simulation->advanceFrame().time;
    }
    const Snapshot early = snapshotOf(*simulation);
    std::uint64_t steps = 0;
    while (steps < 100'000) {
        const std::uint64_t frame = simulation->advanceFrame().steps;
        // Where every grain sleeps no step is needed: the time they would have taken counts.
        steps += std::max(frame, static_cast<std::uint64_t>(simulation->plan().framePeriod /
                                                            simulation->plan().step.step));
    }
    const Snapshot late = snapshotOf(*simulation);
    EXPECT_GT(late.time - early.time, 5.0);
    const HeapFigures before = measureHeap(early), after = measureHeap(late);
    ASSERT_TRUE(before.reposeDeg && after.reposeDeg);
    EXPECT_NEAR(*after.reposeDeg, *before.reposeDeg, 0.5);
    EXPECT_NEAR(after.apex, before.apex, 0.1 * scene.diameter());
}

INSTANTIATE_TEST_SUITE_P(Modes, HundredThousandSteps,
                         ::testing::Values(Mode::surfaceFlow, Mode::dem));

}  // namespace
}  // namespace sandflow
