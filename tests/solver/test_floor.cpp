#include "dem/dem.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace sandflow {
namespace {

using namespace testing;

/// Grains thrown at a rough floor at different places, far enough apart never to meet.
Scene makeThrow(double speed, Mode mode)
{
    Scene scene = makeEmptyScene();
    scene.mode = mode;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(-0.01, 0.01);
    for (int n = 0; n < 36; ++n) {
        const double dx = offset(random), dy = offset(random);
        scene.emitters.push_back(
            makeSingle(Vec3(0.2 * (n % 6) + dx, 0.2 * (n / 6) + dy, 0.05), Vec3(0.0, 0.0, -speed)));
    }
    scene.time.duration = 2.0;
    return scene;
}

/// Heights [in radii] at which a grain can rest on the particles of a rough floor: between three of
/// them that are as far apart as they may be, and on top of one.
double lowestRest()
{
    const double gap = DemSetup().roughGap;
    return std::sqrt(4.0 - gap * gap) - kRoughCoverDepth;
}
constexpr double kHighestRest = 2.0 - kRoughCoverDepth;

class RoughFloor : public ::testing::TestWithParam<double> {};

TEST_P(RoughFloor, StopsEveryGrainOnItsSurface)
{
    const double r = 0.005;
    double deepest = 0.0;
    const auto simulation = run(makeThrow(GetParam(), Mode::dem),
                                [&](const Simulation& sim, const FrameReport& report) {
                                    EXPECT_EQ(sim.countLeaks(), 0u);
                                    deepest = std::max(deepest, report.deepestOverlap);
                                });
    const Snapshot s = snapshotOf(*simulation);
    ASSERT_EQ(s.size(), 36u);
    for (std::size_t k = 0; k < s.size(); ++k) {
        EXPECT_GT(s.position[k].z(), (lowestRest() - 0.02) * r) << "grain " << k;
        EXPECT_LT(s.position[k].z(), (kHighestRest + 0.02) * r) << "grain " << k;
        EXPECT_LT(s.velocity[k].norm(), 1e-3f) << "grain " << k;
    }
    EXPECT_LT(deepest, 0.36 * r) << "0.3 r is what the stiffness is chosen for";
}

INSTANTIATE_TEST_SUITE_P(Speeds, RoughFloor, ::testing::Values(0.0, 2.0, 5.0));

TEST(RoughFloorPlate, GrainsAreCaughtFarOutAndBelowZero)
{
    Scene scene = makeEmptyScene();
    scene.solids[0].point = Vec3(0.0, 0.0, -30.0);
    for (const double far : {-2000.0, 2000.0}) {
        scene.emitters.push_back(makeSingle(Vec3(far, -far, -29.95)));
    }
    scene.time.duration = 1.0;
    const Snapshot s = snapshotOf(*run(scene));
    ASSERT_EQ(s.size(), 2u);
    for (const Vec3& p : s.position) {
        EXPECT_GT(p.z() + 30.0, (lowestRest() - 0.02) * 0.005);
        EXPECT_LT(p.z() + 30.0, (kHighestRest + 0.02) * 0.005);
    }
}

TEST(SmoothFloor, AGrainRestsExactlyOnIt)
{
    Scene scene = makeEmptyScene();
    scene.solids[0].rough = false;
    scene.emitters.push_back(makeSingle(Vec3(0.3, 0.2, 0.03)));
    scene.time.duration = 1.0;
    const auto simulation = run(scene);
    const Snapshot s = snapshotOf(*simulation);
    ASSERT_EQ(s.size(), 1u);
    const double sink =
        2600.0 * 4.0 / 3.0 * kPi * std::pow(0.005, 3) * kGravity / simulation->plan().law.stiffness;
    EXPECT_NEAR(s.position[0].z(), 0.005 - sink, 1e-7);
}

/// Small grains among large ones, thrown at many places: of the smallest that a scene may hold, none
/// slips through between the particles of the floor, which are as large as the mean grain.
TEST(RoughFloorUnderSmallGrains, LetsNoneThrough)
{
    for (const double ratio : {2.0, 3.0, 5.0}) {
        Scene scene = makeThrow(1.0, Mode::dem);
        for (EmitterSpec& grain : scene.emitters) {
            grain.grainRadius = 2.0 * scene.grains.radius / (1.0 + ratio);
        }
        scene.grains.sizeSpread = (ratio - 1.0) / (ratio + 1.0);
        std::uint64_t leaks = 0;
        const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport&) {
            leaks += sim.countLeaks();
        });
        EXPECT_EQ(leaks, 0u) << "sizes " << ratio << " apart";
        for (const Vec3& p : snapshotOf(*simulation).position) {
            EXPECT_GT(p.z(), 0.0) << "sizes " << ratio << " apart";
        }
    }
}

}  // namespace
}  // namespace sandflow
