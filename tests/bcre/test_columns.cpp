#include "bcre/columns.h"
#include "bcre/evolve.h"
#include "core/errors.h"
#include "test_fields.h"

#include <gtest/gtest.h>

#include <limits>

namespace sandflow {
namespace {

using Intervals = std::vector<ColumnGrid::FreeInterval>;

void flatFloor(double, double, Intervals& out)
{
    out.push_back({0.0, 1e30});
}

/// Ground at 0 and a table top from 0.5 to 0.55 m over 0 <= x < 4, with a hole where
/// 1 <= x < 2, 1 <= y < 2 (cells of 1 m).
void tableWithHole(double x, double y, Intervals& out)
{
    const bool overTable = x > 0.0 && x < 4.0 && y > 0.0 && y < 4.0;
    const bool inHole = x > 1.0 && x < 2.0 && y > 1.0 && y < 2.0;
    if (overTable && !inHole) {
        out.push_back({0.0, 0.5});
        out.push_back({0.55, 1e30});
    } else {
        out.push_back({0.0, 1e30});
    }
}

TEST(Columns, CellIndexRoundsDownAndNeverOverflows)
{
    const ColumnGrid columns(0.5, flatFloor, {});
    EXPECT_EQ(columns.cellIndex(0.0), 0);
    EXPECT_EQ(columns.cellIndex(0.49), 0);
    EXPECT_EQ(columns.cellIndex(0.5), 1);
    EXPECT_EQ(columns.cellIndex(-1e-9), -1);
    EXPECT_EQ(columns.cellIndex(-8.0), -16);
    EXPECT_EQ(columns.cellIndex(1e300), 1000000000);
    EXPECT_EQ(columns.cellIndex(-1e300), -1000000000);
    EXPECT_EQ(columns.cellIndex(std::numeric_limits<double>::quiet_NaN()), -1000000000);
}

TEST(Columns, RefusesACellOfNoSize)
{
    EXPECT_THROW(ColumnGrid(0.0, flatFloor, {}), InternalError);
}

TEST(Columns, RefusesSpansThatDoNotAscend)
{
    ColumnGrid columns(
        1.0,
        [](double, double, Intervals& out) {
            out.push_back({1.0, 2.0});
            out.push_back({0.0, 0.5});
        },
        {});
    EXPECT_THROW(columns.ensureColumn(0, 0), InternalError);
}

TEST(Columns, TilesAreMadeOnDemandAndLinkedAcrossTheirRims)
{
    ColumnGrid columns(1.0, flatFloor, {});
    EXPECT_EQ(columns.spansOf(0, 0), (std::pair<std::int32_t, std::int32_t>(-1, 0)));
    columns.ensureColumn(-1, 5);
    EXPECT_EQ(columns.spanCount(), 256u);
    EXPECT_EQ(columns.spansOf(0, 5).first, ColumnGrid::kNone);
    const auto rim = columns.spansOf(-1, 5).first;
    EXPECT_EQ(columns.link[rim][1], ColumnGrid::kNone);

    columns.ensureColumn(0, 0);
    columns.ensureColumn(0, -1);
    columns.ensureColumn(3, 7);   // exists already
    EXPECT_EQ(columns.spanCount(), 768u);
    EXPECT_EQ(columns.spansOf(-1, 5).first, rim) << "spans keep their index";

    // Every link leads to the column next door, and back; nothing is missing within the field.
    constexpr int stepI[4] = {-1, 1, 0, 0};
    constexpr int stepJ[4] = {0, 0, -1, 1};
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        for (int direction = 0; direction < 4; ++direction) {
            const int i = columns.columnI[s] + stepI[direction];
            const int j = columns.columnJ[s] + stepJ[direction];
            const std::int32_t other = columns.link[s][direction];
            ASSERT_EQ(other, columns.spansOf(i, j).first);
            if (other != ColumnGrid::kNone) {
                ASSERT_EQ(columns.link[other][direction ^ 1], static_cast<std::int32_t>(s));
            }
        }
    }
    EXPECT_TRUE(columns.extraLinks.empty());
}

TEST(Columns, SlotsAndColumnsAreEachOthersInverse)
{
    ColumnGrid columns(1.0, flatFloor, {});
    columns.ensureColumn(-20, 3);
    columns.ensureColumn(40, -33);
    EXPECT_EQ(columns.slotCount(), 512u);
    for (std::int32_t slot = 0; slot < 512; ++slot) {
        const auto [i, j] = columns.columnOfSlot(slot);
        ASSERT_EQ(columns.slotOf(i, j), slot);
        ASSERT_EQ(columns.spansOfSlot(slot), columns.spansOf(i, j));
    }
    EXPECT_EQ(columns.slotOf(0, 0), ColumnGrid::kNone);
}

TEST(Columns, SpanAtFindsTheSpanThatHoldsTheHeight)
{
    ColumnGrid columns(1.0, tableWithHole, {});
    columns.ensureColumn(0, 0);
    const auto [first, count] = columns.spansOf(2, 2);
    ASSERT_EQ(count, 2);
    EXPECT_EQ(columns.spanAt(2.5, 2.5, 0.2), first);
    EXPECT_EQ(columns.spanAt(2.5, 2.5, 0.7), first + 1);
    EXPECT_EQ(columns.spanAt(2.5, 2.5, 0.51), first) << "inside the table top, nearer below";
    EXPECT_EQ(columns.spanAt(2.5, 2.5, 0.54), first + 1);
    EXPECT_EQ(columns.spanAt(2.5, 2.5, -3.0), first);
    EXPECT_EQ(columns.spanAt(200.0, 2.5, 0.2), ColumnGrid::kNone);
}

TEST(Columns, TableWithAHoleLinksEachLevelToItsOwn)
{
    ColumnGrid columns(1.0, tableWithHole, {});
    columns.ensureColumn(0, 0);
    const auto below = columns.spansOf(2, 2).first;
    const auto above = below + 1;
    // Within the table the two levels do not know of each other.
    EXPECT_EQ(columns.link[below][1], columns.spansOf(3, 2).first);
    EXPECT_EQ(columns.link[above][1], columns.spansOf(3, 2).first + 1);
    // Beside the hole both levels open into its one span, and the hole looks back at both.
    const auto hole = columns.spansOf(1, 1).first;
    const auto belowBeside = columns.spansOf(2, 1).first;
    EXPECT_EQ(columns.spansOf(1, 1).second, 1);
    EXPECT_EQ(columns.link[belowBeside][0], hole);
    EXPECT_EQ(columns.link[belowBeside + 1][0], hole);
    EXPECT_EQ(columns.link[hole][1], belowBeside + 1) << "the largest overlap is above";
    int extras = 0;
    for (const ColumnGrid::ExtraLink& extra : columns.extraLinks) {
        if (extra.span == hole && extra.direction == 1) {
            EXPECT_EQ(extra.other, belowBeside);
            ++extras;
        }
    }
    EXPECT_EQ(extras, 1);
}

TEST(Columns, SandOnATableFallsThroughItsHoleAndNoneIsLost)
{
    ColumnGrid columns(1.0, tableWithHole, {});
    columns.ensureColumn(0, 0);
    const auto above = columns.spansOf(2, 1).first + 1;
    const auto hole = columns.spansOf(1, 1).first;
    columns.R[above] = 0.1;
    columns.R[hole] = 0.02;
    columns.h[hole] = 0.3;
    BcreParams params;
    params.exchangeRate = 0.0;
    params.transport = true;
    params.transportSpeed = 1.0;
    const double before = testing::totalDepth(columns);
    for (int step = 0; step < 20; ++step) {
        evolveBcre(params, 0.05, columns);
    }
    EXPECT_NEAR(testing::totalDepth(columns), before, 1e-12 * before);
    EXPECT_LT(columns.R[above], 0.05) << "sand above the hole's rim must run into it";
    double underTable = 0.0;
    for (const int i : {0, 2}) {
        underTable += columns.R[columns.spansOf(i, 1).first];
    }
    EXPECT_GT(underTable, 0.01) << "and from there on below the table";
}

TEST(Columns, SpansWithoutCommonHeightAreNotLinked)
{
    ColumnGrid columns(
        1.0,
        [](double x, double, Intervals& out) {
            if (x < 1.0) {
                out.push_back({0.0, 0.2});
            } else {
                out.push_back({0.3, 1e30});
            }
        },
        {});
    columns.ensureColumn(0, 0);
    EXPECT_EQ(columns.link[columns.spansOf(0, 0).first][1], ColumnGrid::kNone);
    EXPECT_EQ(columns.link[columns.spansOf(1, 0).first][0], ColumnGrid::kNone);
    EXPECT_NE(columns.link[columns.spansOf(1, 0).first][1], ColumnGrid::kNone);
}

TEST(Columns, WallsCutLinksAtTheirHeightOnly)
{
    // A pane at x = 2 stands on the table top: it parts what lies above, not what lies below.
    ColumnGrid columns(1.0, tableWithHole, [](const Vec2& a, const Vec2& b, double lo, double) {
        return lo > 0.5 && (a.x() - 2.0) * (b.x() - 2.0) < 0.0;
    });
    columns.ensureColumn(0, 0);
    const auto left = columns.spansOf(1, 2).first;
    const auto right = columns.spansOf(2, 2).first;
    EXPECT_EQ(columns.link[left][1], right);
    EXPECT_EQ(columns.link[left + 1][1], ColumnGrid::kNone);
    EXPECT_EQ(columns.link[right + 1][0], ColumnGrid::kNone);
    EXPECT_NE(columns.link[right + 1][1], ColumnGrid::kNone);
    // The hole keeps the link below the table top; above it the pane stands in between.
    EXPECT_EQ(columns.link[columns.spansOf(1, 1).first][1], columns.spansOf(2, 1).first);
}

TEST(Columns, ColumnsWithoutAFloorSwallowSand)
{
    ColumnGrid columns(
        1.0,
        [](double x, double, Intervals& out) { out.push_back({x < 8.0 ? 0.0 : -1e30, 1e30}); }, {});
    columns.ensureColumn(0, 0);
    const auto edge = columns.spansOf(7, 3).first;
    EXPECT_EQ(columns.sink[edge], 0);
    EXPECT_EQ(columns.sink[columns.spansOf(8, 3).first], 1);
    columns.R[edge] = 0.2;
    BcreParams params;
    params.exchangeRate = 0.0;
    params.transport = true;
    params.transportSpeed = 1.0;
    const BcreReport report = evolveBcre(params, 10.0, columns);
    // What is left leaves at v/dx = 1/s.
    EXPECT_NEAR(report.outflowVolume, 0.2, 1e-4);
    EXPECT_NEAR(columns.R[edge], 0.0, 1e-4);
}

TEST(Columns, RebuildKeepsWhatDidNotChange)
{
    bool table = true;
    ColumnGrid columns(
        1.0,
        [&](double x, double y, Intervals& out) {
            if (table) {
                tableWithHole(x, y, out);
            } else {
                flatFloor(x, y, out);
            }
        },
        {});
    columns.ensureColumn(0, 0);
    columns.ensureColumn(-1, 0);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        columns.h[s] = columns.floor[s] + 0.01 * (columns.columnI[s] + 20);
        columns.R[s] = 0.05;
        columns.H[s] = columns.h[s] + 0.05;
    }
    columns.sink[columns.spansOf(10, 10).first] = 1;

    std::vector<std::pair<std::int32_t, std::int32_t>> changed{{99, 99}};
    columns.rebuildSpans(changed);
    EXPECT_TRUE(changed.empty()) << "nothing came or went";
    EXPECT_EQ(columns.spanCount(), 512u + 15u);

    table = false;
    columns.rebuildSpans(changed);
    EXPECT_EQ(changed.size(), 15u) << "4 x 4 columns of the table without its hole";
    EXPECT_EQ(columns.spanCount(), 512u);
    EXPECT_TRUE(columns.extraLinks.empty());
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const int i = columns.columnI[s];
        const int j = columns.columnJ[s];
        const bool wasTable = i >= 0 && i < 4 && j >= 0 && j < 4 && !(i == 1 && j == 1);
        ASSERT_DOUBLE_EQ(columns.h[s], wasTable ? 0.0 : 0.01 * (i + 20));
        ASSERT_DOUBLE_EQ(columns.R[s], wasTable ? 0.0 : 0.05);
        ASSERT_DOUBLE_EQ(columns.H[s], columns.h[s] + columns.R[s]);
        ASSERT_EQ(columns.sink[s], i == 10 && j == 10 ? 1 : 0);
    }
    EXPECT_EQ(columns.link[columns.spansOf(-1, 3).first][1], columns.spansOf(0, 3).first);

    // The table comes back: the ground keeps nothing there, and the links split again.
    table = true;
    columns.rebuildSpans(changed);
    EXPECT_EQ(changed.size(), 15u);
    EXPECT_EQ(columns.spanCount(), 512u + 15u);
    EXPECT_FALSE(columns.extraLinks.empty());
}

}  // namespace
}  // namespace sandflow
