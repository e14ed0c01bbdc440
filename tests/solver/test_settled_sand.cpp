#include "scenes.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kRadius = 0.005;

Scene makePile(std::int64_t count)
{
    Scene scene = makeEmptyScene();
    EmitterSpec pile;
    pile.kind = EmitterKind::pile;
    pile.name = "pile";
    pile.count = count;
    pile.slopeAngle = 22.0;
    scene.emitters.push_back(pile);
    return scene;
}

/// A box of twice `half` across, full of settled sand, open at the top.
Scene makeBoxOfSand(double half, double depth)
{
    Scene scene = makeEmptyScene();
    SolidSpec box;
    box.shape = SolidShape::box;
    box.name = "box";
    box.min = Vec3(-half, -half, 0.0);
    box.max = Vec3(half, half, 0.3);
    box.hollow = true;
    scene.solids.push_back(box);
    EmitterSpec fill;
    fill.kind = EmitterKind::fill;
    fill.name = "sand";
    fill.min = Vec3(-half, -half, 0.0);
    fill.max = Vec3(half, half, depth);
    scene.emitters.push_back(fill);
    return scene;
}

/// A small plate far away that vanishes at `time`: all frozen sand is set free then.
void releaseAllAt(double time, Scene& scene)
{
    SolidSpec plate = makeDisc(0.5, 0.02, time);
    plate.point.x() = 5.0;
    scene.solids.push_back(plate);
}

TEST(SettledSand, APileIsFrozenFromTheStart)
{
    Scene scene = makePile(1500);
    scene.time.duration = 0.3;
    run(scene, [](const Simulation& sim, const FrameReport& report) {
        EXPECT_EQ(report.ledger.emitted, 1500u);
        EXPECT_TRUE(report.ledger.balances());
        EXPECT_EQ(sim.countLeaks(), 0u);
        // The flowing layer, two diameters deep, may be awake; the rest is frozen.
        EXPECT_GT(report.ledger.interface + report.ledger.buried, 300u);
    });
}

TEST(SettledSand, AFilledBoxIsMostlyBuried)
{
    Scene scene = makeBoxOfSand(0.09, 0.13);
    scene.time.duration = 0.7;
    FrameReport last;
    double fastest = 0.0;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        last = report;
        EXPECT_EQ(sim.countLeaks(), 0u);
        for (const Vec3f& v : snapshotOf(sim).velocity) {
            fastest = std::max(fastest, static_cast<double>(v.norm()));
        }
    });
    const std::uint64_t all = last.ledger.emitted;
    EXPECT_GT(all, 2000u);
    EXPECT_GT(last.ledger.buried, all / 2);
    EXPECT_GT(last.ledger.interface + last.ledger.buried, all * 3 / 4);
    EXPECT_LT(fastest, 0.3) << "settled sand must not jump";
    EXPECT_LT(deepestPair(snapshotOf(*simulation)), 0.1);
}

TEST(SettledSand, InDemModeItIsMobileAndStaysWhereItWasPut)
{
    Scene scene = makePile(800);
    scene.mode = Mode::dem;
    scene.time.duration = 0.5;
    Snapshot first;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        EXPECT_EQ(report.ledger.mobile, 800u);
        if (first.size() == 0) {
            sim.takeSnapshot(first);
        }
    });
    const Snapshot last = snapshotOf(*simulation);
    EXPECT_NEAR(apexOf(last), apexOf(first), 2.0 * scene.diameter());
    EXPECT_LT(deepestPair(last), 0.1);
}

TEST(ReleasedSand, DoesNotExplode)
{
    // A heap that was poured, frozen, buried and then set free all at once.
    Scene scene = makePour(1500, Mode::surfaceFlow);
    scene.time.settle = 2.0;
    const double release = 1500.0 / 600.0 + 1.5;
    releaseAllAt(release, scene);
    Ledger before;
    double apexBefore = 0.0, deepest = 0.0, fastest = 0.0;
    bool wasReleased = false;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        const Snapshot s = snapshotOf(sim);
        if (report.time < release + 1e-9) {
            before = report.ledger;
            apexBefore = apexOf(s);
            return;
        }
        wasReleased = wasReleased || report.ledger.interface < before.interface / 2;
        deepest = std::max(deepest, report.deepestOverlap);
        for (const Vec3f& v : s.velocity) {
            fastest = std::max(fastest, static_cast<double>(v.norm()));
        }
        EXPECT_EQ(sim.countLeaks(), 0u);
        EXPECT_TRUE(report.ledger.balances());
    });
    EXPECT_GT(before.interface + before.buried + before.asleep, 1000u);
    EXPECT_TRUE(wasReleased);
    EXPECT_LT(deepest, 0.15 * kRadius);
    EXPECT_LT(fastest, 0.5);
    EXPECT_NEAR(apexOf(snapshotOf(*simulation)), apexBefore, 1.0 * scene.diameter());
}

TEST(ReleasedSand, ABoxOfBuriedSandDoesNotExplode)
{
    Scene scene = makeBoxOfSand(0.08, 0.1);
    scene.time.duration = 0.6;
    releaseAllAt(0.3, scene);
    double deepest = 0.0, fastest = 0.0, kinetic = 0.0;
    std::uint64_t buried = 0;
    run(scene, [&](const Simulation& sim, const FrameReport& report) {
        EXPECT_EQ(sim.countLeaks(), 0u);
        if (report.time < 0.3 + 1e-9) {
            buried = report.ledger.buried;
            return;
        }
        deepest = std::max(deepest, report.deepestOverlap);
        kinetic = report.kineticEnergy;
        for (const Vec3f& v : snapshotOf(sim).velocity) {
            fastest = std::max(fastest, static_cast<double>(v.norm()));
        }
    });
    EXPECT_GT(buried, 500u);
    EXPECT_LT(deepest, 0.3 * kRadius) << "what the stiffness was chosen for";
    EXPECT_LT(fastest, 0.5);
    EXPECT_LT(kinetic, 1e-4);
}

class VanishingPlate : public ::testing::TestWithParam<Mode> {};

TEST_P(VanishingPlate, LetsTheSandOnItFall)
{
    Scene scene = makePour(400, GetParam());
    scene.emitters[0].position.z() = 0.32;
    const double until = 1.6;
    scene.solids.push_back(makeDisc(0.2, 0.1, until));
    scene.time.duration = 2.4;
    std::size_t onPlate = 0, frozen = 0;
    std::uint64_t leaks = 0;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        leaks += sim.countLeaks();
        if (report.time < until + 1e-9) {
            const Snapshot s = snapshotOf(sim);
            onPlate = static_cast<std::size_t>(std::count_if(
                s.position.begin(), s.position.end(), [](const Vec3& p) { return p.z() > 0.2; }));
            frozen = report.ledger.asleep + report.ledger.interface + report.ledger.buried;
        }
    });
    EXPECT_GT(onPlate, 300u);
    if (GetParam() == Mode::surfaceFlow) {
        EXPECT_GT(frozen, 100u) << "some of it must have been held fixed";
    }
    EXPECT_EQ(leaks, 0u);
    const Snapshot s = snapshotOf(*simulation);
    ASSERT_EQ(s.size(), 400u);
    for (const Vec3& p : s.position) {
        EXPECT_LT(p.z(), 0.12) << "nothing hangs where the plate was";
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, VanishingPlate, ::testing::Values(Mode::surfaceFlow, Mode::dem));

}  // namespace
}  // namespace sandflow
