#include "bcre/test_fields.h"
#include "transfer/bed_height.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using testing::at;
using testing::fill;
using testing::makeFlatBox;

constexpr double kCell = 0.03;

std::int32_t spanOf(const ColumnGrid& columns, int i, int j)
{
    return static_cast<std::int32_t>(at(columns, i, j));
}

TEST(BedHeight, IsTheColumnsOwnAtItsCentre)
{
    ColumnGrid columns = makeFlatBox(8, 8, kCell);
    fill(
        columns, [](double x, double y) { return 0.5 + x * x - 2.0 * y; },
        [](double, double) { return 0.0; });
    for (int i = 0; i < 8; ++i) {
        const std::int32_t s = spanOf(columns, i, 3);
        EXPECT_NEAR(bedHeightAt(columns, s, (i + 0.5) * kCell, 3.5 * kCell), columns.h[s], 1e-15);
    }
}

TEST(BedHeight, FollowsAPlaneExactlyAwayFromTheWalls)
{
    const auto plane = [](double x, double y) { return 0.2 + 0.6 * x - 0.4 * y; };
    ColumnGrid columns = makeFlatBox(10, 10, kCell);
    fill(columns, plane, [](double, double) { return 0.0; });
    for (int n = 0; n < 200; ++n) {
        const double x = kCell * (1.0 + 8.0 * n / 200.0),
                     y = kCell * (1.0 + 8.0 * (n * 37 % 200) / 200.0);
        const std::int32_t s = columns.spanAt(x, y, 0.3);
        ASSERT_NE(s, ColumnGrid::kNone);
        EXPECT_NEAR(bedHeightAt(columns, s, x, y), plane(x, y), 1e-12);
    }
}

TEST(BedHeight, HasNoSlopeAtASummitADipOrAWall)
{
    ColumnGrid columns = makeFlatBox(9, 3, kCell);
    const auto roof = [](double x, double) { return 0.3 - std::abs(x - 4.5 * kCell); };
    for (const double sign : {1.0, -1.0}) {
        fill(
            columns, [&](double x, double y) { return 0.3 + sign * roof(x, y); },
            [](double, double) { return 0.0; });
        for (const int i : {0, 4, 8}) {  // a wall, the ridge, a wall
            const std::int32_t s = spanOf(columns, i, 1);
            for (const double offset : {0.05, 0.5, 0.95}) {
                EXPECT_EQ(bedHeightAt(columns, s, (i + offset) * kCell, 1.5 * kCell), columns.h[s])
                    << "column " << i;
            }
        }
    }
}

TEST(BedHeight, TakesTheGentlerOfTwoSlopes)
{
    ColumnGrid columns = makeFlatBox(3, 1, kCell);
    fill(
        columns, [](double, double) { return 0.0; }, [](double, double) { return 0.0; });
    columns.h[at(columns, 0)] = 0.0;
    columns.h[at(columns, 1)] = 0.02;
    columns.h[at(columns, 2)] = 0.025;
    EXPECT_NEAR(bedHeightAt(columns, spanOf(columns, 1, 0), 2.0 * kCell, 0.5 * kCell), 0.0225,
                1e-12);
    EXPECT_NEAR(bedHeightAt(columns, spanOf(columns, 1, 0), 1.0 * kCell, 0.5 * kCell), 0.0175,
                1e-12);
}

}  // namespace
}  // namespace sandflow
