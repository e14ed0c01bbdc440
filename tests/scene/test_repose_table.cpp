#include "scene/repose_table.h"
#include "scene_support.h"

#include <cmath>
#include <random>

namespace sandflow {
namespace {

/// Bilinear in the two coefficients, so that a bilinear table of it is exact; rises with both.
double slopeOf(double friction, double rolling)
{
    return 11.0 + 7.0 * friction + 20.0 * rolling + 30.0 * friction * rolling;
}

std::vector<ReposeMeasurement> makeRows(double scatter = 0.5, int heaps = 3)
{
    std::vector<ReposeMeasurement> rows;
    for (const double friction : {0.1, 0.25, 0.9}) {
        for (const double rolling : {0.0, 0.05, 0.1, 0.4}) {
            rows.push_back({friction, rolling, slopeOf(friction, rolling), scatter, heaps});
        }
    }
    return rows;
}

/// The measured curve along one axis may dip by chance; by so much at most: three standard
/// deviations of a difference of two means.
double mostByChance(const ReposeMeasurement& a, const ReposeMeasurement& b)
{
    return 3.0 * measuredRepose().scatter() * std::sqrt(1.0 / a.heaps + 1.0 / b.heaps);
}

TEST(ReposeTable, IsExactAtItsNodesAndLinearBetween)
{
    const auto rows = makeRows();
    const ReposeTable table(rows);
    for (const ReposeMeasurement& row : rows) {
        EXPECT_NEAR(table.angle(row.friction, row.rollingFriction), row.angle, 1e-12);
    }
    std::mt19937 bits(3);
    std::uniform_real_distribution<double> friction(0.1, 0.9), rolling(0.0, 0.4);
    for (int n = 0; n < 200; ++n) {
        const double mu = friction(bits), mur = rolling(bits);
        EXPECT_NEAR(table.angle(mu, mur), slopeOf(mu, mur), 1e-12) << mu << ' ' << mur;
    }
}

TEST(ReposeTable, TheWayBackIsTheInverse)
{
    const ReposeTable table(makeRows());
    std::mt19937 bits(4);
    std::uniform_real_distribution<double> friction(0.1, 0.9), rolling(0.0, 0.4);
    for (int n = 0; n < 200; ++n) {
        const double mu = friction(bits), mur = rolling(bits);
        const double angle = table.angle(mu, mur);
        EXPECT_NEAR(table.rollingFrictionFor(angle, mu).value(), mur, 1e-10);
        EXPECT_NEAR(table.frictionFor(angle, mur).value(), mu, 1e-10);
    }
}

TEST(ReposeTable, KnowsItsReach)
{
    const ReposeTable table(makeRows());
    const Interval byRolling = table.reachByRolling(0.5);
    EXPECT_NEAR(byRolling.low, slopeOf(0.5, 0.0), 1e-12);
    EXPECT_NEAR(byRolling.high, slopeOf(0.5, 0.4), 1e-12);
    EXPECT_NEAR(table.rollingFrictionFor(byRolling.low, 0.5).value(), 0.0, 1e-12);
    EXPECT_NEAR(table.rollingFrictionFor(byRolling.high, 0.5).value(), 0.4, 1e-12);
    EXPECT_FALSE(table.rollingFrictionFor(byRolling.low - 1e-9, 0.5).has_value());
    EXPECT_FALSE(table.rollingFrictionFor(byRolling.high + 1e-9, 0.5).has_value());
    const Interval byFriction = table.reachByFriction(0.1);
    EXPECT_NEAR(byFriction.low, slopeOf(0.1, 0.1), 1e-12);
    EXPECT_NEAR(byFriction.high, slopeOf(0.9, 0.1), 1e-12);
    EXPECT_FALSE(table.frictionFor(byFriction.high + 1e-9, 0.1).has_value());
}

TEST(ReposeTable, TakesTheSmallestCoefficientWhereACurveHasLevelledOut)
{
    const std::vector<ReposeMeasurement> rows = {
        {0.1, 0.0, 10.0, 0.0, 1}, {0.1, 0.1, 12.0, 0.0, 1}, {0.5, 0.0, 20.0, 0.0, 1},
        {0.5, 0.1, 22.0, 0.0, 1}, {1.0, 0.0, 18.0, 0.0, 1}, {1.0, 0.1, 26.0, 0.0, 1}};
    const ReposeTable table(rows);
    EXPECT_NEAR(table.frictionFor(19.0, 0.0).value(), 0.46, 1e-12);
    EXPECT_EQ(table.frictionFor(20.0, 0.0).value(), 0.5);
    EXPECT_EQ(table.reachByFriction(0.0).high, 20.0);
}

TEST(ReposeTable, BeyondItTheNearestPairCounts)
{
    const ReposeTable table(makeRows());
    EXPECT_TRUE(table.covers(0.1, 0.4));
    EXPECT_FALSE(table.covers(0.0999, 0.4));
    EXPECT_FALSE(table.covers(0.1, 0.4001));
    EXPECT_EQ(table.angle(7.0, 0.05), table.angle(0.9, 0.05));
    EXPECT_EQ(table.angle(0.0, 3.0), table.angle(0.1, 0.4));
}

TEST(ReposeTable, ScatterIsThatOfAllPairsTogether)
{
    EXPECT_NEAR(ReposeTable(makeRows(0.5)).scatter(), 0.5, 1e-12);
    EXPECT_EQ(ReposeTable(makeRows(0.0, 1)).scatter(), 0.0);
    auto rows = makeRows(0.0);
    rows[0].scatter = 3.0;
    EXPECT_NEAR(ReposeTable(rows).scatter(), 3.0 / std::sqrt(12.0), 1e-12);
}

TEST(ReposeTable, RefusesWhatIsNoGrid)
{
    auto rows = makeRows();
    rows.pop_back();
    EXPECT_THROW(ReposeTable{rows}, InternalError);
    rows = makeRows();
    rows[5].rollingFriction = 0.06;
    EXPECT_THROW(ReposeTable{rows}, InternalError);
    rows = makeRows();
    rows.resize(4);
    EXPECT_THROW(ReposeTable{rows}, InternalError) << "one friction is no table";
}

TEST(MeasuredRepose, RisesWithBothCoefficientsWithinTheScatter)
{
    const auto rows = reposeMeasurements();
    const auto columns =
        static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const auto& row) {
            return row.friction == rows.front().friction;
        }));
    ASSERT_EQ(rows.size() % columns, 0U);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        SCOPED_TRACE(
            fmt::format("friction {}, rolling {}", rows[k].friction, rows[k].rollingFriction));
        EXPECT_GE(rows[k].heaps, 2);
        if ((k + 1) % columns != 0) {
            EXPECT_GT(rows[k + 1].angle, rows[k].angle - mostByChance(rows[k + 1], rows[k]));
        }
        if (k + columns < rows.size()) {
            EXPECT_GT(rows[k + columns].angle,
                      rows[k].angle - mostByChance(rows[k + columns], rows[k]));
        }
    }
}

TEST(MeasuredRepose, AnglesAreThoseOfSand)
{
    for (const ReposeMeasurement& row : reposeMeasurements()) {
        // No heap stands steeper than a cohesive one would, none was flat.
        EXPECT_GT(row.angle, 10.0) << row.friction << ' ' << row.rollingFriction;
        EXPECT_LT(row.angle, 45.0) << row.friction << ' ' << row.rollingFriction;
    }
    // A table that scattered by a degree could tell neighbouring materials no more apart.
    EXPECT_GT(measuredRepose().scatter(), 0.0);
    EXPECT_LT(measuredRepose().scatter(), 1.0);
}

/// The table as scenes/README.md shows it: a row for each friction.
std::string writeMarkdown()
{
    std::string head = "| friction |", rule = "|---|", body;
    double friction = -1.0;
    for (const ReposeMeasurement& row : reposeMeasurements()) {
        if (row.friction == reposeMeasurements().front().friction) {
            head += fmt::format(" {} |", row.rollingFriction);
            rule += "---|";
        }
        if (row.friction != friction) {
            friction = row.friction;
            body += fmt::format("{}| {} |", body.empty() ? "" : "\n", friction);
        }
        body += fmt::format(" {:.1f} |", row.angle);
    }
    return head + '\n' + rule + '\n' + body + '\n';
}

TEST(MeasuredRepose, TheReadmeShowsIt)
{
    const std::string expected = writeMarkdown();
    const std::string path = testing::TempDir() + "repose_table.md";
    if (readText(kSceneDir + "README.md").find(expected) == std::string::npos) {
        std::ofstream(path) << expected;
        ADD_FAILURE() << "scenes/README.md differs from the measured table; the right text is in "
                      << path;
    }
}

TEST(MeasuredRepose, WhatIsSolvedGivesTheAngleBack)
{
    const ReposeTable& table = measuredRepose();
    for (double friction = table.frictions().low; friction <= table.frictions().high;
         friction += 0.045) {
        const Interval reach = table.reachByRolling(friction);
        for (double angle = reach.low; angle <= reach.high; angle += 0.7) {
            const double rolling = table.rollingFrictionFor(angle, friction).value();
            EXPECT_NEAR(table.angle(friction, rolling), angle, 1e-9);
        }
    }
    for (const double rolling : {0.0, 0.03, 0.1, 0.15, 0.4}) {
        const Interval reach = table.reachByFriction(rolling);
        for (double angle = reach.low; angle <= reach.high; angle += 0.7) {
            const double friction = table.frictionFor(angle, rolling).value();
            EXPECT_NEAR(table.angle(friction, rolling), angle, 1e-9);
        }
    }
}

}  // namespace
}  // namespace sandflow
