#include "measure/compare.h"
#include "synthetic_heaps.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using namespace testing;

TEST(Compare, HeapEqualsItself)
{
    const Snapshot heap = makeRandomCone(0.5, 0.15, 1);
    const HeapComparison result = compareHeaps(heap, heap);
    EXPECT_GT(result.radial.places, 10u);
    EXPECT_GT(result.cells.places, 10u);
    EXPECT_EQ(result.radial.mean, 0.0);
    EXPECT_EQ(result.radial.rms, 0.0);
    EXPECT_EQ(result.cells.mean, 0.0);
    EXPECT_EQ(result.cells.worst, 0.0);
    EXPECT_EQ(result.apexDifference, 0.0);
    EXPECT_EQ(result.reposeDifference, 0.0);
    EXPECT_EQ(result.r90Difference, 0.0);
    EXPECT_EQ(result.footDifference, 0.0);
    EXPECT_EQ(result.countDifference, 0);
}

TEST(Compare, ConeLiftedByHalfADiameterDiffersByThat)
{
    const Snapshot low = makeConeShell(0.5, 0.2);
    const Snapshot high = makeConeShell(0.5, 0.2, Vec2::Zero(), 0.5 * kDiameter);
    const HeapComparison result = compareHeaps(low, high);
    EXPECT_NEAR(result.apexDifference, 0.5, 1e-9);
    EXPECT_NEAR(result.radial.mean, 0.5, 0.02);
    EXPECT_NEAR(result.radial.rms, 0.5, 0.02);
    EXPECT_NEAR(result.radial.bias, 0.5, 0.02);
    EXPECT_NEAR(result.radial.worst, 0.5, 0.02);
    EXPECT_NEAR(*result.reposeDifference, 0.0, 0.1);
    EXPECT_NEAR(result.footDifference, 0.5 / std::tan(0.5), 0.1);
    EXPECT_NEAR(result.r90Difference, 0.0, 1e-9);
    EXPECT_LT(compareHeaps(high, low).radial.bias, 0.0) << "differences are b minus a";
}

TEST(Compare, SlabLiftedByHalfADiameterDiffersByThatInEveryCell)
{
    const Snapshot low = makeSlab(0.4, 0.25, 0.1);  // 8 x 5 cells of 5 d
    Snapshot high = low;
    for (Vec3& p : high.position) {
        p.z() += 0.5 * kDiameter;
    }
    const HeapComparison result = compareHeaps(low, high);
    EXPECT_EQ(result.cells.places, 40u);
    EXPECT_NEAR(result.cells.mean, 0.5, 1e-6);
    EXPECT_NEAR(result.cells.rms, 0.5, 1e-6);
    EXPECT_NEAR(result.cells.bias, 0.5, 1e-6);
}

// Half the slab up, half down: mean |dH| sees it, bias does not; a stronger step in a quarter of
// the cells tells rms from mean.
TEST(Compare, MeanRmsAndBiasAreThoseOfAKnownPattern)
{
    const Snapshot flat = makeSlab(0.4, 0.25, 0.1);
    Snapshot stepped = flat;
    for (Vec3& p : stepped.position) {
        p.z() += (p.x() < 0.2 ? -0.3 : p.x() < 0.3 ? 0.1 : 0.5) * kDiameter;
    }
    const HeapComparison result = compareHeaps(flat, stepped);
    // Caps reach across the steps by less than r: a tenth of a cell's edge.
    EXPECT_NEAR(result.cells.mean, 0.5 * 0.3 + 0.25 * 0.1 + 0.25 * 0.5, 0.02);
    EXPECT_NEAR(result.cells.rms, std::sqrt(0.5 * 0.09 + 0.25 * 0.01 + 0.25 * 0.25), 0.02);
    EXPECT_NEAR(result.cells.bias, 0.0, 0.02);
    EXPECT_NEAR(result.cells.worst, 0.5, 0.01);
}

TEST(Compare, HeapThatStandsElsewhereIsSeenByCellsOnly)
{
    const Snapshot here = makeConeShell(0.5, 0.15);
    const Snapshot there = makeConeShell(0.5, 0.15, {0.05, -0.1});
    const HeapComparison result = compareHeaps(here, there);
    EXPECT_NEAR(result.radial.mean, 0.0, 0.01);
    EXPECT_GT(result.cells.mean, 2.0);
    EXPECT_NEAR(result.centroidShift, std::hypot(5.0, 10.0), 1e-6);
}

TEST(Compare, TwoRandomHeapsDifferByNoiseOnly)
{
    const HeapComparison result =
        compareHeaps(makeRandomCone(0.47, 0.2, 1), makeRandomCone(0.47, 0.2, 2));
    EXPECT_GT(result.cells.mean, 0.0);
    EXPECT_LT(result.radial.mean, 0.1);
    EXPECT_LT(result.cells.mean, 0.2);
    EXPECT_LT(result.radial.mean, result.cells.mean) << "annuli average over more grains";
    EXPECT_LT(std::abs(*result.reposeDifference), 0.3);
    EXPECT_LT(std::abs(result.r90Difference), 1.0);
}

TEST(Compare, SteeperHeapOfTheSameVolumeIsToldApart)
{
    const auto apexOf = [](double angle) {  // V = pi H^3 / (3 tan^2)
        return 0.2 * std::pow(std::tan(angle) / std::tan(0.45), 2.0 / 3.0);
    };
    const HeapComparison result =
        compareHeaps(makeConeShell(0.45, apexOf(0.45)), makeConeShell(0.50, apexOf(0.50)));
    EXPECT_NEAR(*result.reposeDifference, degrees(0.05), 0.1);
    EXPECT_NEAR(result.volumeDifference, 0.0, 0.5);
    const double rise = apexOf(0.50) - apexOf(0.45);
    EXPECT_NEAR(result.apexDifference, rise / kDiameter - 2.0 * (std::tan(0.50) - std::tan(0.45)),
                0.1);
    EXPECT_LT(result.r90Difference, -2.0);
    EXPECT_LT(result.footDifference, -1.0);
    // Compared is only where either is over 1.5 d, and the flatter one is so farther out. The mean
    // of a cone over a disc of radius q inside its rim is H - 2/3 q tan.
    const double reach = (apexOf(0.45) - 1.5 * kDiameter) / std::tan(0.45);
    ASSERT_LT(reach, apexOf(0.50) / std::tan(0.50));
    const double flat = apexOf(0.45) - 2.0 / 3.0 * reach * std::tan(0.45);
    const double steep = apexOf(0.50) - 2.0 / 3.0 * reach * std::tan(0.50);
    EXPECT_NEAR(result.radial.bias, (steep - flat) / kDiameter, 0.03);
}

TEST(Compare, OneEmptyHeapDiffersByTheWholeOther)
{
    const Snapshot slab = makeSlab(0.4, 0.25, 0.1);
    const HeapComparison result = compareHeaps(emptySnapshot(), slab);
    EXPECT_EQ(result.cells.places, 40u);
    // The outermost sub-grid points of the slab see only the shoulders of its outermost spheres.
    EXPECT_NEAR(result.cells.mean, 10.0, 0.1);
    EXPECT_FALSE(result.reposeDifference.has_value());
    EXPECT_EQ(result.r90Difference, 0.0);
    EXPECT_EQ(result.countDifference, static_cast<std::int64_t>(slab.size()));
}

TEST(Compare, TwoEmptyHeapsDoNotDiffer)
{
    const HeapComparison result = compareHeaps(emptySnapshot(), emptySnapshot());
    EXPECT_EQ(result.radial.places, 0u);
    EXPECT_EQ(result.cells.places, 0u);
    EXPECT_EQ(result.cells.mean, 0.0);
    EXPECT_NE(describe(result).find("no cells"), std::string::npos);
}

// Two grains deep on a slope that rises by 10 d: compared to a level floor, the heap would seem up
// to 12 d deep.
TEST(Compare, DepthCountsOnATiltedFloor)
{
    const FloorHeight slope = [](double x, double) { return 0.25 * x; };
    Snapshot sheet = makeSlab(0.4, 0.25, 2.0 * kDiameter);
    for (Vec3& p : sheet.position) {
        p.z() += slope(p.x(), p.y());
    }
    const HeapComparison result = compareHeaps(emptySnapshot(), sheet, slope);
    // Hull of spheres along a slope t: r (1 / cos t - 1) higher than each sphere's own top.
    EXPECT_NEAR(result.cells.mean, 2.0 + 0.5 * (std::hypot(1.0, 0.25) - 1.0), 0.05);
    EXPECT_GT(compareHeaps(emptySnapshot(), sheet, 0.0).cells.mean, 5.0);
}

TEST(Compare, RefusesGrainsOfDifferentMeanSize)
{
    EXPECT_THROW(compareHeaps(emptySnapshot(0.005), emptySnapshot(0.004)), InputError);
}

TEST(Compare, TableShowsTheFiguresWithUnits)
{
    HeapComparison comparison;
    comparison.diameter = kDiameter;
    comparison.a.grains = 107687;
    comparison.a.apex = 0.2401;
    comparison.a.reposeDeg = 28.94;
    comparison.b.apex = 0.2521;
    comparison.apexDifference = 1.2;
    comparison.countDifference = -12;
    comparison.radial = {0.123, 0.2, -0.05, 0.4, 45};
    const std::string text = describe(comparison);
    for (const char* piece : {"107687", "-12", "240.1", "252.1", "+1.20 d", "28.94", "none",
                              "mean 0.123 d", "bias -0.050 d", "45 annuli", "d = 10 mm"}) {
        EXPECT_NE(text.find(piece), std::string::npos) << piece << " missing in\n" << text;
    }
    // Aligned: the units of all rows with two values begin in the same column.
    EXPECT_EQ(text.find("mm", text.find("apex")) - text.find("apex"),
              text.find("deg", text.find("repose")) - text.find("repose"));
}

}  // namespace
}  // namespace sandflow
