#include "transfer_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

/// Floors that are not flat, and more than one free interval over a place.
namespace sandflow {
namespace {

using namespace testing;

TEST(MatterTransfer, NothingStaysBuriedOnASlopingFloor)
{
    // The floor falls by a column's height from column to column: sand at the lower side of a
    // column lies below the floor at its centre.
    State s;
    s.columns = makeBox(kEdge, kEdge, kCell, [](double x, double) { return 0.5 * kWidth - x; });
    std::map<std::uint32_t, Vec3> where;
    std::uint32_t id = 1;
    for (double x = 0.001; x < kWidth; x += 0.007) {
        for (double depth = 0.005; depth < 0.08; depth += 0.01) {
            where[id] = Vec3(x, 0.1, 0.5 * kWidth - x + depth);
            addFrozen(s.dem, where[id], id);
            ++id;
        }
    }
    fill(
        s.columns, [](double x, double) { return 0.5 * kWidth - x + 0.1; },
        [](double, double) { return 0.02; });
    s.run();
    ASSERT_GT(s.buried.size(), 50u);
    fill(
        s.columns, [](double x, double) { return 0.5 * kWidth - x; },
        [](double, double) { return 0.0; });
    s.run();
    EXPECT_EQ(s.buried.size(), 0u);
    for (const auto& [which, g] : collectAll(s)) {
        EXPECT_LE((g.position - where.at(which)).cwiseAbs().maxCoeff(), kHalfUnit);
    }
}

TEST(MatterTransfer, SandOnATableAndUnderItGoTheirOwnWays)
{
    // A table top from 0.3 to 0.32 m over all columns.
    State s;
    s.columns = ColumnGrid(kCell,
                           [](double, double, std::vector<ColumnGrid::FreeInterval>& out) {
                               out.push_back({0.0, 0.3});
                               out.push_back({0.32, 1e30});
                           },
                           {});
    s.columns.ensureColumn(0, 0);
    const auto setBeds = [&](double lower, double upper) {
        for (std::size_t k = 0; k < s.columns.spanCount(); ++k) {
            s.columns.h[k] = s.columns.floor[k] + (s.columns.floor[k] < 0.1 ? lower : upper);
        }
    };
    std::uint32_t id = 1;
    for (double z = 0.005; z < 0.1; z += 0.01, id += 2) {
        addFrozen(s.dem, overColumn(2, 2, z), id);
        addFrozen(s.dem, overColumn(2, 2, 0.32 + z), 1000 + id);
    }
    const auto countBuried = [&](bool upper) {
        std::size_t count = 0;
        s.buried.forEach(
            [&](const Vec3&, double, std::uint32_t which) { count += upper == (which >= 1000); });
        return count;
    };
    setBeds(0.12, 0.12);
    s.run();
    const std::size_t each = countBuried(true);
    EXPECT_GT(each, 5u);
    EXPECT_EQ(countBuried(false), each);
    setBeds(0.12, 0.0);
    s.run();
    EXPECT_EQ(countBuried(true), 0u);
    EXPECT_EQ(countBuried(false), each) << "the table's sand is none of the floor's business";
    setBeds(0.0, 0.0);
    s.run();
    EXPECT_EQ(s.buried.size(), 0u);
}

}  // namespace
}  // namespace sandflow
