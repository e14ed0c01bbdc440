#include "measure/height_map.h"
#include "measure/settled.h"
#include "synthetic_heaps.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <numeric>

namespace sandflow {
namespace {

using namespace testing;

TEST(HeightMap, OneLargeSphereGivesItsCapAtEveryPoint)
{
    Snapshot snapshot = emptySnapshot();
    const Vec3 centre{0.013, -0.021, 0.04};
    const double radius = static_cast<double>(0.04f);
    addGrain(snapshot, centre, radius);
    const HeightMap map(snapshot);
    EXPECT_DOUBLE_EQ(map.spacing(), kRadius);
    int covered = 0;
    for (std::int32_t j = -30; j < 30; ++j) {
        for (std::int32_t i = -30; i < 30; ++i) {
            const double dx = (i + 0.5) * kRadius - centre.x();
            const double dy = (j + 0.5) * kRadius - centre.y();
            const double rest = radius * radius - dx * dx - dy * dy;
            covered += rest > 0.0;
            EXPECT_NEAR(map.depthAt(i, j), rest > 0.0 ? centre.z() + std::sqrt(rest) : 0.0, 1e-12);
        }
    }
    EXPECT_GT(covered, 190);  // the test looked at the whole sphere: pi (r / spacing)^2 = 201
}

TEST(HeightMap, AgreesWithTryingEveryGrainAtEveryPoint)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-0.12, 0.12);
    std::uniform_real_distribution<double> size(0.3, 5.0);  // sizes a good 10x apart
    Snapshot snapshot = emptySnapshot();
    for (int n = 0; n < 300; ++n) {
        addGrain(snapshot, {place(random), place(random), std::abs(place(random))},
                 kRadius * size(random), GrainState::buried);
    }
    const double floorZ = 0.03;
    const HeightMap map(snapshot, floorZ);
    for (std::int32_t j = -40; j < 40; ++j) {
        for (std::int32_t i = -40; i < 40; ++i) {
            double expected = 0.0;
            for (std::size_t n = 0; n < snapshot.size(); ++n) {
                const Vec3& p = snapshot.position[n];
                const double r = snapshot.radius[n];
                const double rest = r * r - std::pow((i + 0.5) * kRadius - p.x(), 2) -
                                    std::pow((j + 0.5) * kRadius - p.y(), 2);
                if (rest > 0.0) {
                    expected = std::max(expected, p.z() + std::sqrt(rest) - floorZ);
                }
            }
            ASSERT_NEAR(map.depthAt(i, j), expected, 1e-9) << i << ", " << j;
        }
    }
}

void expectSameMap(const HeightMap& a, const HeightMap& b)
{
    ASSERT_EQ(a.tiles().size(), b.tiles().size());
    for (std::size_t t = 0; t < a.tiles().size(); ++t) {
        EXPECT_EQ(a.tiles()[t].i, b.tiles()[t].i);
        EXPECT_EQ(a.tiles()[t].j, b.tiles()[t].j);
        EXPECT_EQ(a.tiles()[t].height, b.tiles()[t].height);
    }
}

TEST(HeightMap, SameBitsForAnyOrderOfGrainsAndAnyNumberOfThreads)
{
    const Snapshot heap = makeRandomCone(0.5, 0.12, 11);
    std::vector<std::size_t> order(heap.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937_64(5));
    Snapshot shuffled = emptySnapshot();
    for (const std::size_t n : order) {
        addGrain(shuffled, heap.position[n], heap.radius[n], heap.state[n]);
    }
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const HeightMap serial(heap);
    omp_set_num_threads(4);
    const HeightMap parallel(shuffled);
    omp_set_num_threads(threads);
    ASSERT_GT(serial.tiles().size(), 20u);
    expectSameMap(serial, parallel);
}

// A grain that rolled off for kilometres must not cost the plane in between.
TEST(HeightMap, StrayGrainsFarAwayCostNothing)
{
    Snapshot snapshot = emptySnapshot();
    addGrain(snapshot, {0.0, 0.0, kRadius});
    addGrain(snapshot, {-9000.0, 8000.0, kRadius});
    const HeightMap map(snapshot);
    EXPECT_EQ(map.settled().size(), 2u);
    EXPECT_LE(map.tiles().size(), 8u);
    EXPECT_GT(map.depthAt(map.pointIndex(-9000.0), map.pointIndex(8000.0)), kRadius);
}

TEST(HeightMap, RefusesASnapshotWithoutMeanRadius)
{
    EXPECT_THROW(HeightMap(emptySnapshot(0.0)), InternalError);
}

class SettledTest : public ::testing::Test {
protected:
    bool lastIsSettled(double floorZ = 0.0) const
    {
        return findSettled(snapshot, levelFloor(floorZ)).back() != 0;
    }

    Snapshot snapshot = emptySnapshot();
};

TEST_F(SettledTest, SlowGrainInTheAirIsNot)
{
    addGrain(snapshot, {0, 0, 0.2});
    EXPECT_FALSE(lastIsSettled());
}

TEST_F(SettledTest, GrainOnTheFloorIs)
{
    addGrain(snapshot, {0, 0, kRadius});
    EXPECT_TRUE(lastIsSettled());
    EXPECT_FALSE(lastIsSettled(-0.1));
    EXPECT_TRUE(lastIsSettled(0.1)) << "below the floor counts as on it";
}

TEST_F(SettledTest, GrainOnTheCoverOfARoughFloorIs)
{
    addGrain(snapshot, {0, 0, 2 * kRadius});  // straight above a cover particle of its own size
    EXPECT_TRUE(lastIsSettled());
}

TEST_F(SettledTest, FastGrainOnTheFloorIsNot)
{
    addGrain(snapshot, {0, 0, kRadius}, kRadius, GrainState::mobile, Vec3f(0.5f, 0.0f, 0.4f));
    EXPECT_FALSE(lastIsSettled());
}

TEST_F(SettledTest, FlowingGrainOnOthersIs)
{
    addGrain(snapshot, {0, 0, 0.1}, kRadius, GrainState::interface);
    addGrain(snapshot, {0.003, 0, 0.1 + 1.9 * kRadius}, kRadius, GrainState::mobile,
             Vec3f(0.3f, 0.0f, 0.0f));
    EXPECT_TRUE(lastIsSettled());
}

TEST_F(SettledTest, GrainTooFarAboveOthersIsNot)
{
    addGrain(snapshot, {0, 0, 0.1}, kRadius, GrainState::interface);
    addGrain(snapshot, {0, 0, 0.1 + 3.1 * kRadius});
    EXPECT_TRUE(lastIsSettled()) << "the gap is 1.1 r";
    snapshot.position.back().z() = 0.1 + 3.3 * kRadius;
    EXPECT_FALSE(lastIsSettled()) << "the gap is 1.3 r";
}

TEST_F(SettledTest, NobodyIsCarriedByAGrainAboveOrByAJet)
{
    addGrain(snapshot, {0, 0, 0.1 + 2 * kRadius}, kRadius, GrainState::interface);
    addGrain(snapshot, {0, 0, 0.1});
    EXPECT_FALSE(lastIsSettled());
    addGrain(snapshot, {1, 0, 0.1}, kRadius, GrainState::mobile, Vec3f(0, 0, -2.0f));
    addGrain(snapshot, {1, 0, 0.1 + 2 * kRadius});
    EXPECT_FALSE(lastIsSettled());
}

TEST_F(SettledTest, WhatTheSolverHoldsAlwaysIs)
{
    for (const GrainState state : {GrainState::asleep, GrainState::interface, GrainState::buried}) {
        addGrain(snapshot, {0, 0, 10.0 * static_cast<double>(snapshot.size() + 1)}, kRadius, state);
        EXPECT_TRUE(lastIsSettled());
    }
}

TEST_F(SettledTest, GapIsMeasuredInRadiiOfTheUpperGrain)
{
    addGrain(snapshot, {0, 0, 0.1}, 5 * kRadius, GrainState::interface);
    addGrain(snapshot, {0, 0, 0.1 + 7.1 * kRadius});
    EXPECT_TRUE(lastIsSettled());
    snapshot.position.back().z() = 0.1 + 7.3 * kRadius;
    EXPECT_FALSE(lastIsSettled());
}

}  // namespace
}  // namespace sandflow
