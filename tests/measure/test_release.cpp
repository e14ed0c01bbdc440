#include "measure/release.h"

#include "synthetic_heaps.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

Snapshot makeHeap()
{
    return makeConeShell(26.0 * kPi / 180.0, 0.12);
}

TEST(Release, SandThatStaysHasMovedByNothing)
{
    const Snapshot before = makeHeap();
    Snapshot after = before;
    after.time = 0.3;
    ReleaseWatch watch(before, levelFloor(0.0), kGravity);
    watch.look(after);
    const ReleaseFigures figures = watch.figures(after);
    EXPECT_NEAR(figures.seconds, 0.3, 1e-12);
    EXPECT_EQ(figures.apexMoved, 0.0);
    EXPECT_EQ(figures.meanHeightChange, 0.0);
    ASSERT_TRUE(figures.reposeMoved);
    EXPECT_EQ(*figures.reposeMoved, 0.0);
    EXPECT_EQ(figures.fastest, 0.0);
}

TEST(Release, AHeapThatSankHasMovedByThat)
{
    const Snapshot before = makeHeap();
    Snapshot after = before;
    after.time = 0.3;
    const double sunk = 0.3 * kDiameter;
    for (Vec3& p : after.position) {
        p.z() -= sunk;
    }
    const ReleaseFigures figures =
        ReleaseWatch(before, levelFloor(0.0), kGravity).figures(after);
    EXPECT_NEAR(figures.apexMoved, -0.3, 1e-9);
    // Cells at the rim, where there is no sand to sink, are part of the mean.
    EXPECT_GT(figures.meanHeightChange, 0.2);
    EXPECT_LT(figures.meanHeightChange, 0.3 + 1e-9);
}

TEST(Release, NamesTheGrainThatIsFasterThanAFall)
{
    Snapshot before = makeHeap();
    before.velocity[5] = Vec3f(0.1f, 0.0f, 0.0f);
    ReleaseWatch watch(before, levelFloor(0.0), kGravity);
    Snapshot now = before;
    now.time = 0.02;
    now.velocity[7] = Vec3f(0.0f, 0.6f, 0.0f);
    watch.look(now);
    ReleaseFigures figures = watch.figures(now);
    EXPECT_NEAR(figures.fastest, 0.6, 1e-6);
    EXPECT_NEAR(figures.couldFall, 0.1 + kGravity * 0.02, 1e-6);
    // Later and slower: the moment that was worst is the one reported.
    now.time = 0.1;
    watch.look(now);
    figures = watch.figures(now);
    EXPECT_NEAR(figures.couldFall, 0.1 + kGravity * 0.02, 1e-6);
    // In the long run the height of the heap is what limits a fall.
    now.time = 10.0;
    now.velocity[7] = Vec3f(0.0f, 9.0f, 0.0f);
    watch.look(now);
    figures = watch.figures(now);
    EXPECT_NEAR(figures.fastest, 9.0, 1e-6);
    EXPECT_LT(figures.couldFall, std::sqrt(0.01 + 2.0 * kGravity * 0.12) + 1e-6);
    EXPECT_GT(figures.couldFall, std::sqrt(2.0 * kGravity * 0.10));
}

}  // namespace
}  // namespace sandflow
