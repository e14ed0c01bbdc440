#include "measure/crater.h"

#include "core/errors.h"

#include "synthetic_heaps.h"

#include <gtest/gtest.h>

#include <functional>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kTop = 0.1;  // m, of the bed
const Vec2 kMiddle(0.31, 0.27);

Snapshot makeBed()
{
    return makeSlab(0.6, 0.5, kTop);
}

/// The bed with its grains lowered by fall(distance from the middle) [m].
Snapshot sinkBed(const std::function<double(double)>& fall)
{
    Snapshot bed = makeBed();
    for (Vec3& p : bed.position) {
        p.z() -= fall((p.head<2>() - kMiddle).norm());
    }
    return bed;
}

TEST(Crater, OfABowlHasItsDepthAndVolume)
{
    // A paraboloid 2 d deep and 12 d in radius: volume pi R^2 D / 2. So flat that spheres whose
    // centres follow it have it for their hull.
    const double depth = 2.0 * kDiameter, radius = 12.0 * kDiameter;
    const CraterFigures crater = measureCrater(
        makeBed(),
        sinkBed([&](double rho) { return std::max(0.0, depth * (1 - rho * rho / radius / radius)); }),
        levelFloor(0.0));
    EXPECT_LT((crater.centre - kMiddle).norm(), 0.2 * kDiameter);
    // The mean over the middle, out to 2 d, is less than the depth there by (2 / 12)^2 / 2 of it.
    EXPECT_NEAR(crater.depth, depth * (1.0 - 2.0 / 144.0), 0.1 * kDiameter);
    const double volume = kPi * radius * radius * depth / 2.0;
    EXPECT_NEAR(crater.volume, volume, 0.04 * volume);
    EXPECT_NEAR(crater.rim, radius, 1.0 * kDiameter);
}

TEST(Crater, ARaisedRimAndWhatLiesBeyondDoNotCount)
{
    const auto hollow = [](double rho) { return rho < 5.0 * kDiameter ? 2.0 * kDiameter : 0.0; };
    const CraterFigures plain = measureCrater(makeBed(), sinkBed(hollow), levelFloor(0.0));
    const CraterFigures rimmed = measureCrater(
        makeBed(), sinkBed([&](double rho) {
            const bool isRim = rho > 5.0 * kDiameter && rho < 8.0 * kDiameter;
            return isRim ? -0.5 * kDiameter : hollow(rho);
        }),
        levelFloor(0.0));
    // The grains at its edge stand out over it by their radius.
    const double edge = 4.5 * kDiameter;
    EXPECT_NEAR(plain.volume, kPi * edge * edge * 2.0 * kDiameter, 0.05 * plain.volume);
    EXPECT_NEAR(rimmed.volume, plain.volume, 0.1 * plain.volume);
    EXPECT_NEAR(rimmed.depth, 2.0 * kDiameter, 0.05 * kDiameter);
}

TEST(Crater, IsSeenWithoutWhatDugIt)
{
    const auto hollow = [](double rho) { return rho < 5.0 * kDiameter ? 2.0 * kDiameter : 0.0; };
    const Snapshot before = makeBed();
    const CraterFigures empty = measureCrater(before, sinkBed(hollow), levelFloor(0.0));
    Snapshot after = sinkBed(hollow);
    addGrain(after, Vec3(kMiddle.x(), kMiddle.y(), kTop), 4.0 * kRadius, GrainState::asleep);
    const CraterFigures withBall = measureCrater(before, after, levelFloor(0.0));
    EXPECT_EQ(withBall.depth, empty.depth);
    EXPECT_EQ(withBall.volume, empty.volume);
}

TEST(Crater, NoneWhereNothingSank)
{
    const CraterFigures crater = measureCrater(makeBed(), makeBed(), levelFloor(0.0));
    EXPECT_EQ(crater.depth, 0.0);
    EXPECT_EQ(crater.volume, 0.0);
    const CraterFigures hill = measureCrater(
        makeBed(), sinkBed([](double rho) { return rho < 0.03 ? -0.02 : 0.0; }), levelFloor(0.0));
    EXPECT_EQ(hill.volume, 0.0);
}

TEST(Crater, SnapshotsOfOtherSandAreRefused)
{
    const Snapshot bed = makeBed();
    EXPECT_THROW(measureCrater(bed, emptySnapshot(), levelFloor(0.0)), InputError);
}

}  // namespace
}  // namespace sandflow
