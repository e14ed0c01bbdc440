#include "transfer/base_slip.h"

#include "bcre/test_fields.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

constexpr double kCell = 0.03;  // m
constexpr int kEdge = 24;       // columns, floor at z = 0

Primitive floorPlane(bool rough)
{
    Primitive plane;
    plane.rough = rough;
    return plane;
}

/// H = height + slope |x - middle|
ColumnGrid makeRidge(double slope)
{
    ColumnGrid columns = makeFlatBox(kEdge, kEdge, kCell);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const double x = (columns.columnI[s] + 0.5 - 0.5 * kEdge) * kCell;
        columns.H[s] = 0.4 - slope * std::abs(x);
    }
    return columns;
}

std::size_t spanOf(const ColumnGrid& columns, int i, int j)
{
    return static_cast<std::size_t>(columns.spansOf(i, j).first);
}

TEST(BaseSlip, ASlopeOverASmoothFloorMaySlip)
{
    const ColumnGrid columns = makeRidge(0.4);
    BaseSlip slip;
    const auto& slips = slip.find(columns, std::vector{floorPlane(false)}, 0.0);
    ASSERT_EQ(slips.size(), columns.spanCount());
    EXPECT_EQ(slips[spanOf(columns, kEdge / 4, 5)], 1);
    EXPECT_EQ(slips[spanOf(columns, 3 * kEdge / 4, 5)], 1);
    EXPECT_EQ(slips[spanOf(columns, kEdge / 2, 5)], 0) << "under the ridge nobody is pressed aside";
}

TEST(BaseSlip, LevelSandHoldsStill)
{
    const ColumnGrid columns = makeRidge(0.1);
    BaseSlip slip;
    for (const std::uint8_t s : slip.find(columns, std::vector{floorPlane(false)}, 0.0)) {
        EXPECT_EQ(s, 0);
    }
}

TEST(BaseSlip, ARoughFloorHolds)
{
    const ColumnGrid columns = makeRidge(0.4);
    BaseSlip slip;
    EXPECT_TRUE(slip.find(columns, std::vector{floorPlane(true)}, 0.0).empty());
}

TEST(BaseSlip, OnlyTheFloorThatTheSandStandsOnCounts)
{
    const ColumnGrid columns = makeRidge(0.4);
    Primitive elsewhere = floorPlane(false);  // a smooth floor below the rough one
    elsewhere.point = Vec3(0.0, 0.0, -0.5);
    Primitive gone = floorPlane(false);
    gone.until = 1.0;
    const std::vector solids{floorPlane(true), elsewhere, gone};
    BaseSlip slip;
    for (const std::uint8_t s : slip.find(columns, solids, 2.0)) {
        EXPECT_EQ(s, 0);
    }
    BaseSlip earlier;
    const auto& slips = earlier.find(columns, solids, 0.5);
    EXPECT_EQ(slips[spanOf(columns, kEdge / 4, 5)], 1);
}

}  // namespace
}  // namespace sandflow::testing
