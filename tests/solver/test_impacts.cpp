#include "scenes.h"

#include "measure/crater.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kShotTime = 0.5;  // s

/// Settled sand that is left alone until something strikes its top.
Scene makeTarget(Mode mode)
{
    Scene scene = makeEmptyScene();
    scene.mode = mode;
    EmitterSpec pile;
    pile.kind = EmitterKind::pile;
    pile.name = "pile";
    pile.count = 2000;
    pile.slopeAngle = 22.0;
    scene.emitters.push_back(pile);
    scene.time.duration = 1.0;
    return scene;
}

/// A grain as heavy as 27 others, at 3.0 m/s.
Scene makeShot(Mode mode)
{
    Scene scene = makeTarget(mode);
    scene.contact.maxOverlap = 0.6;  // of the heavy one's contacts; longer steps
    EmitterSpec shot = makeSingle(Vec3(0.0, 0.0, 0.2), Vec3(0.0, 0.0, -2.6));
    shot.grainRadius = 0.015;
    shot.start = kShotTime;
    scene.emitters.push_back(shot);
    return scene;
}

/// 60 grains at once, at 5.1 m/s.
Scene makeBurst(Mode mode)
{
    Scene scene = makeTarget(mode);
    EmitterSpec burst;
    burst.kind = EmitterKind::block;
    burst.name = "burst";
    burst.start = kShotTime;
    burst.count = 60;
    burst.min = Vec3(-0.025, -0.025, 0.15);
    burst.max = Vec3(0.025, 0.025, 0.21);
    burst.velocity = Vec3(0.0, 0.0, -5.0);
    scene.emitters.push_back(burst);
    return scene;
}

struct Dug {
    CraterFigures crater;
    std::uint64_t frozenBefore = 0, freed = 0;
    double diameter = 0.0;
};

Dug dig(const Scene& scene)
{
    Dug dug;
    dug.diameter = scene.diameter();
    Snapshot before;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        EXPECT_TRUE(report.ledger.balances());
        EXPECT_EQ(sim.countLeaks(), 0u);
        if (report.time < kShotTime + 1e-9) {
            sim.takeSnapshot(before);
            dug.frozenBefore =
                report.ledger.asleep + report.ledger.interface + report.ledger.buried;
        } else {
            dug.freed += report.transfer.dislodged + report.transfer.woken;
        }
    });
    dug.crater = measureCrater(before, snapshotOf(*simulation), levelFloor(0.0));
    return dug;
}

class Impacts : public ::testing::TestWithParam<Scene (*)(Mode)> {};

TEST_P(Impacts, DigIntoFrozenSandAsIntoFullDem)
{
    const Dug flow = dig(GetParam()(Mode::surfaceFlow)), dem = dig(GetParam()(Mode::dem));
    EXPECT_GT(flow.frozenBefore, 1000u) << "there is a frozen bed to dig into";
    EXPECT_GT(flow.freed, 100u);
    EXPECT_GT(dem.crater.depth, 1.0 * dem.diameter) << "there is something to compare";
    EXPECT_NEAR(flow.crater.depth, dem.crater.depth, 1.0 * dem.diameter);
    // Volumes are another matter: a pile that is put there settles a little when it can, which full
    // DEM has done before the shot. scenes/crater.toml compares them on a poured heap.
}

INSTANTIATE_TEST_SUITE_P(ShotAndBurst, Impacts, ::testing::Values(makeShot, makeBurst));

/// Of the sand on the floor far from the shot, the share that it moves by more than 0.1 d.
double shareMovedFarAway(Mode mode)
{
    Snapshot before;
    const Scene scene = makeShot(mode);
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        if (report.time < kShotTime + 1e-9) {
            sim.takeSnapshot(before);
        }
    });
    const Snapshot after = snapshotOf(*simulation);
    double far = 0, moved = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
        const Vec3& p = before.position[k];
        if (p.z() < 0.02 && p.head<2>().norm() > 0.13) {
            far += 1;
            moved += (after.position[k] - p).norm() > 0.1 * scene.diameter() ? 1 : 0;
        }
    }
    EXPECT_GT(far, 100);
    return moved / far;
}

TEST(Shot, FarFromTheShotSandMovesAsLittleAsInFullDem)
{
    EXPECT_LT(shareMovedFarAway(Mode::surfaceFlow), shareMovedFarAway(Mode::dem) + 0.1);
}

}  // namespace
}  // namespace sandflow
