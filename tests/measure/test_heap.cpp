#include "measure/heap.h"
#include "measure/radial_profile.h"
#include "measure/robust_line.h"
#include "synthetic_heaps.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

class ConeTest : public ::testing::TestWithParam<double> {};

TEST_P(ConeTest, FiguresAreThoseOfTheConeItWasMadeFrom)
{
    const double angle = GetParam() * kPi / 180.0;
    const double slope = std::tan(angle);
    const double apex = 24.0 * kDiameter;
    const double rim = apex / slope;
    const Vec2 centre{0.3141, -0.2718};
    const HeapFigures heap = measureHeap(makeConeShell(angle, apex, centre));

    ASSERT_TRUE(heap.reposeDeg.has_value());
    EXPECT_NEAR(*heap.reposeDeg, GetParam(), 0.1);
    // The mean of a cone over a disc of radius 3 d lies 2 d of run below its tip.
    EXPECT_NEAR(heap.apex, apex - 2.0 * kDiameter * slope, 0.1 * kDiameter);
    // Same number of grains per area: 90 % of them in 90 % of the area.
    EXPECT_NEAR(heap.r90, rim * std::sqrt(0.9), 0.005 * rim);
    EXPECT_NEAR(heap.foot, rim - kDiameter / slope, 0.2 * kDiameter);
    EXPECT_NEAR(heap.volume, kPi * rim * rim * apex / 3.0, 0.01 * heap.volume);
    EXPECT_NEAR((heap.centroid - centre).norm(), 0.0, 1e-9);
    EXPECT_EQ(heap.airborne, 0u);
}

INSTANTIATE_TEST_SUITE_P(Angles, ConeTest, ::testing::Values(18.0, 25.0, 32.0, 38.0));

TEST(Heap, RoughConeStillHasItsAngleAndRunOut)
{
    const double angle = 27.0 * kPi / 180.0;
    const double apex = 0.2;
    const HeapFigures heap = measureHeap(makeRandomCone(angle, apex, 1));
    ASSERT_TRUE(heap.reposeDeg.has_value());
    EXPECT_NEAR(*heap.reposeDeg, 27.0, 0.3);
    // Solid cone: the share within x rims is 3 x^2 - 2 x^3 = 0.9 at x = 0.8042.
    EXPECT_NEAR(heap.r90, 0.8042 * apex / std::tan(angle), 0.01 * heap.r90);
    // The highest of n grains per volume thrown at random below a level lies deeper than u with
    // probability exp(-n (pi r^2 u + 2/3 pi r^3)), u > 0. With 0.6 of the volume in spheres its cap
    // lies 1.58 r below on average, and H is lower than the cone by that.
    EXPECT_NEAR(heap.solidFraction, 0.6 / (1.0 - 3.0 * 1.58 * kRadius / apex), 0.015);
}

TEST(Heap, FloorLevelShiftsNothingElse)
{
    Snapshot snapshot = makeConeShell(0.5, 0.15);
    const HeapFigures heap = measureHeap(snapshot);
    for (Vec3& p : snapshot.position) {
        p.z() += 0.7;
    }
    const HeapFigures lifted = measureHeap(snapshot, 0.7);
    EXPECT_NEAR(lifted.apex, heap.apex, 1e-9);
    EXPECT_NEAR(*lifted.reposeDeg, *heap.reposeDeg, 1e-6);
    EXPECT_NEAR(lifted.foot, heap.foot, 1e-9);
    EXPECT_NEAR(lifted.volume, heap.volume, 1e-9 * heap.volume);
}

TEST(Heap, GrainsInTheAirChangeNothing)
{
    Snapshot snapshot = makeConeShell(0.5, 0.15);
    const HeapFigures before = measureHeap(snapshot);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> place(-0.05, 0.05);
    for (int n = 0; n < 500; ++n) {  // a jet, dense enough that its grains are neighbours
        addGrain(snapshot, {place(random), place(random), 0.4 + place(random)}, kRadius,
                 GrainState::mobile, Vec3f(0.0f, 0.0f, -2.0f));
    }
    addGrain(snapshot, {0.0, 0.0, 0.25});  // at the top of its jump
    addGrain(snapshot, {5.0, 5.0, kRadius}, kRadius, GrainState::mobile,
             Vec3f(1.0f, 0.0f, 0.0f));  // shot away along the floor
    const HeapFigures after = measureHeap(snapshot);
    EXPECT_EQ(after.airborne, 502u);
    EXPECT_EQ(after.grains, before.grains);
    EXPECT_EQ(after.apex, before.apex);
    EXPECT_EQ(after.reposeDeg, before.reposeDeg);
    EXPECT_EQ(after.r90, before.r90);
    EXPECT_EQ(after.profile, before.profile);
}

TEST(Heap, StrayGrainsOnTheFloorDoNotMoveFootOrAngle)
{
    Snapshot snapshot = makeConeShell(0.5, 0.15);
    const HeapFigures before = measureHeap(snapshot);
    std::mt19937_64 random(8);
    std::normal_distribution<double> far(0.0, 2.0);
    for (int n = 0; n < 40; ++n) {
        const Vec2 p{far(random), far(random)};
        if (p.norm() > 0.5) {  // in opposite pairs, to leave the centroid alone
            addGrain(snapshot, {p.x(), p.y(), kRadius});
            addGrain(snapshot, {-p.x(), -p.y(), kRadius});
        }
    }
    ASSERT_GT(snapshot.size(), before.grains + 50);
    const HeapFigures after = measureHeap(snapshot);
    EXPECT_NEAR(*after.reposeDeg, *before.reposeDeg, 1e-6);
    EXPECT_NEAR(after.foot, before.foot, 1e-9);
}

TEST(Heap, CraterDoesNotCountAsFoot)
{
    Snapshot ring = emptySnapshot();
    const Snapshot cone = makeConeShell(0.5, 0.15);
    for (std::size_t n = 0; n < cone.size(); ++n) {
        if (cone.position[n].head<2>().norm() > 0.06) {
            addGrain(ring, cone.position[n]);
        }
    }
    EXPECT_NEAR(measureHeap(ring).foot, measureHeap(cone).foot, 1e-9);
}

TEST(Heap, EmptySnapshotHasNoFigures)
{
    const HeapFigures heap = measureHeap(emptySnapshot());
    EXPECT_EQ(heap.grains, 0u);
    EXPECT_EQ(heap.apex, 0.0);
    EXPECT_EQ(heap.r90, 0.0);
    EXPECT_EQ(heap.volume, 0.0);
    EXPECT_FALSE(heap.reposeDeg.has_value());
    EXPECT_TRUE(heap.profile.empty());
}

TEST(Heap, OneGrainIsAHeapWithoutAngle)
{
    // d is a twentieth of this grain, so that the sub-grid resolves it. Under its cap, down to the
    // floor, lie pi r^2 r + 2/3 pi r^3: the sphere fills 4/5 of that.
    Snapshot snapshot = emptySnapshot(0.0005);
    addGrain(snapshot, {0.1, 0.2, 0.01}, 0.01);
    const HeapFigures heap = measureHeap(snapshot);
    EXPECT_EQ(heap.grains, 1u);
    EXPECT_EQ(heap.r90, 0.0);
    EXPECT_NEAR(heap.solidFraction, 0.8, 0.01);
    // Mean of sqrt(r^2 - rho^2) over rho < 3 d = 0.3 r.
    EXPECT_NEAR(heap.apex, 0.01 + 0.01 * 2.0 / 3.0 * (1 - std::pow(0.91, 1.5)) / 0.09, 2e-5);

    Snapshot lone = emptySnapshot();
    addGrain(lone, {0.1, 0.2, kRadius});
    EXPECT_FALSE(measureHeap(lone).reposeDeg.has_value());
    EXPECT_EQ(measureHeap(lone).foot, 0.0) << "its annulus is nowhere 1 d high on average";
}

TEST(RadialProfile, LevelSheetIsLevelDownToTheCentre)
{
    // Wherever the centre falls among the sub-grid points.
    const Snapshot slab = makeSlab(0.6, 0.6, 0.1);
    const HeightMap map(slab);
    for (const Vec2& centre : {Vec2{0.3, 0.3}, Vec2{0.3017, 0.2961}, Vec2{0.2988, 0.3042}}) {
        const std::vector<double> profile = averageOverAnnuli(map, centre);
        for (std::size_t k = 0; k < 28; ++k) {
            EXPECT_NEAR(profile[k], 0.1, 0.05 * kDiameter) << "annulus " << k;
        }
        EXPECT_NEAR(averageOverDisc(map, centre, 0.05), 0.1, 0.05 * kDiameter);
    }
}

TEST(RadialProfile, AnnuliAddUpToTheVolume)
{
    const Snapshot cone = makeConeShell(0.5, 0.15, {0.0123, 0.0456});
    const HeapFigures heap = measureHeap(cone);
    double volume = 0.0;
    for (std::size_t k = 0; k < heap.profile.size(); ++k) {
        volume += heap.profile[k] * annulusArea(k) * kDiameter * kDiameter;
    }
    EXPECT_NEAR(volume, heap.volume, 0.01 * heap.volume);
}

TEST(RobustLine, FindsAnExactLine)
{
    const std::optional<Line> line = fitRobustLine({0, 1, 2, 3, 4}, {5, 3, 1, -1, -3});
    ASSERT_TRUE(line.has_value());
    EXPECT_NEAR(line->slope, -2.0, 1e-9);
    EXPECT_NEAR(line->intercept, 5.0, 1e-9);
}

TEST(RobustLine, PaysNoHeedToOutliers)
{
    std::mt19937_64 random(2);
    std::normal_distribution<double> noise(0.0, 0.1);
    std::vector<double> x, y;
    for (int n = 0; n < 60; ++n) {
        x.push_back(n);
        y.push_back(40.0 - std::tan(32.0 * kPi / 180.0) * n + noise(random));
        if (n % 10 == 9) {
            y.back() += 8.0;
        }
    }
    const std::optional<Line> line = fitRobustLine(x, y);
    ASSERT_TRUE(line.has_value());
    EXPECT_NEAR(degrees(std::atan(-line->slope)), 32.0, 0.1);
}

TEST(RobustLine, RefusesTooFewPoints)
{
    EXPECT_FALSE(fitRobustLine({}, {}).has_value());
    EXPECT_FALSE(fitRobustLine({0, 1, 2}, {0, 1, 2}).has_value());
    EXPECT_FALSE(fitRobustLine({1, 1, 1, 1, 1}, {0, 1, 2, 3, 4}).has_value());
}

}  // namespace
}  // namespace sandflow
