#include "bcre/evolve.h"
#include "mesh/shapes.h"
#include "mesh_spans.h"
#include "test_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sandflow::testing {
namespace {

/// Heights may differ from the closed form by this and by what the lattice of the mesh does on
/// slopes, m.
constexpr double kHeightError = 1e-6;
constexpr double kOpen = 1e30;

using Spans = std::vector<std::pair<double, double>>;

/// Compares the spans of every column with those of a closed form at its centre.
template <class ClosedForm>
void expectSpans(const ColumnGrid& columns, const ClosedForm& spansAt)
{
    for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(columns.slotCount()); ++slot) {
        const auto [i, j] = columns.columnOfSlot(slot);
        const auto [first, count] = columns.spansOfSlot(slot);
        const double x = (i + 0.5) * columns.cellSize();
        const double y = (j + 0.5) * columns.cellSize();
        const Spans expected = spansAt(x, y);
        ASSERT_EQ(static_cast<std::size_t>(count), expected.size()) << "at " << x << ", " << y;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const std::size_t span = static_cast<std::size_t>(first) + k;
            ASSERT_NEAR(columns.floor[span], expected[k].first, kHeightError) << x << ", " << y;
            ASSERT_NEAR(columns.ceiling[span], expected[k].second, kHeightError) << x << ", " << y;
        }
    }
}

/// The rule of links: every span is linked to the neighbour with which it shares most free height,
/// and every pair of which one looks at the other is known to both.
void expectLinksByTheRule(const ColumnGrid& columns)
{
    constexpr int stepI[4] = {-1, 1, 0, 0};
    constexpr int stepJ[4] = {0, 0, -1, 1};
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        for (std::size_t direction = 0; direction < 4; ++direction) {
            const auto [first, count] = columns.spansOf(columns.columnI[s] + stepI[direction],
                                                        columns.columnJ[s] + stepJ[direction]);
            double widest = 0.0;
            std::int32_t expected = ColumnGrid::kNone;
            for (std::int32_t other = first; other < first + count; ++other) {
                const auto at = static_cast<std::size_t>(other);
                const double shared = std::min(columns.ceiling[s], columns.ceiling[at]) -
                                      std::max(columns.floor[s], columns.floor[at]);
                if (shared > widest) {
                    widest = shared;
                    expected = other;
                }
            }
            const std::int32_t linked = columns.link[s][direction];
            ASSERT_EQ(linked, expected);
            if (linked == ColumnGrid::kNone) {
                continue;
            }
            const auto back = static_cast<std::int32_t>(direction ^ 1);
            const std::int32_t returned = columns.link[static_cast<std::size_t>(linked)]
                                                      [static_cast<std::size_t>(back)];
            const auto self = static_cast<std::int32_t>(s);
            ASSERT_TRUE(returned == self ||
                        std::any_of(columns.extraLinks.begin(), columns.extraLinks.end(),
                                    [&](const ColumnGrid::ExtraLink& extra) {
                                        return extra.span == linked && extra.direction == back &&
                                               extra.other == self;
                                    }));
        }
    }
}

constexpr double kCell = 0.05;

bool isWithin(double x, double y, double halfX, double halfY)
{
    return std::abs(x) < halfX && std::abs(y) < halfY;
}

TriangleMesh makeTable()
{
    return makeBlocksMesh({-0.5, -0.4, -0.1, 0.1, 0.4, 0.5}, {-0.5, -0.1, 0.1, 0.5},
                          {0.0, 0.4, 0.45}, [](int i, int j, int k) {
                              return k == 0 ? i == 0 || i == 4 : i != 2 || j != 1;
                          });
}

TEST(MultiValued, TableWithAHole)
{
    const ColumnGrid columns = makeMeshField(kCell, 0.8, makeTable(), 0.0);
    expectSpans(columns, [](double x, double y) -> Spans {
        if (!isWithin(x, y, 0.5, 0.5) || isWithin(x, y, 0.1, 0.1)) {
            return {{0.0, kOpen}};
        }
        if (std::abs(x) > 0.4) {
            return {{0.45, kOpen}};
        }
        return {{0.0, 0.4}, {0.45, kOpen}};
    });
    expectLinksByTheRule(columns);

    const std::int32_t onTable = columns.spanAt(0.225, 0.225, 0.5);
    const std::int32_t underTable = columns.spanAt(0.225, 0.225, 0.2);
    const auto isUnderTable = [&](std::size_t span) { return columns.ceiling[span] < 1.0; };
    const auto inHole = [&](std::size_t span) {
        const Vec2 centre = centreOf(columns, span);
        return isWithin(centre.x(), centre.y(), 0.1, 0.1);
    };
    const auto beside = [&](std::size_t span) {
        const Vec2 centre = centreOf(columns, span);
        return !isWithin(centre.x(), centre.y(), 0.5, 0.5);
    };
    // Shut the hole and the outside: the sand on the table and that under it are worlds apart.
    const std::vector<bool> shut = spansReachedFrom(columns, onTable, [&](std::size_t span) {
        return !inHole(span) && !beside(span);
    });
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        if (!inHole(s) && !beside(s)) {
            ASSERT_EQ(shut[s], !isUnderTable(s));
        }
    }
    // Either way of the two is enough to get there.
    EXPECT_TRUE(spansReachedFrom(columns, onTable, [&](std::size_t span) { return !inHole(span); })
                    [static_cast<std::size_t>(underTable)]);
    EXPECT_TRUE(spansReachedFrom(columns, onTable, [&](std::size_t span) { return !beside(span); })
                    [static_cast<std::size_t>(underTable)]);
    // A leg is a wall for what lies under the table and ground for what lies on it.
    const std::int32_t atLeg = columns.spanAt(0.375, 0.225, 0.2);
    EXPECT_EQ(columns.link[static_cast<std::size_t>(atLeg)][1], ColumnGrid::kNone);
    EXPECT_EQ(columns.link[static_cast<std::size_t>(columns.spanAt(0.375, 0.225, 0.5))][1],
              columns.spanAt(0.425, 0.225, 0.5));
}

TEST(MultiValued, BridgeIsPassedAboveAndBelow)
{
    const TriangleMesh bridge =
        makeBlocksMesh({-0.6, -0.5, 0.5, 0.6}, {-0.15, 0.15}, {0.0, 0.3, 0.4},
                       [](int i, int, int k) { return k == 1 || i != 1; });
    const ColumnGrid columns = makeMeshField(kCell, 0.8, bridge, 0.0);
    expectSpans(columns, [](double x, double y) -> Spans {
        if (!isWithin(x, y, 0.6, 0.15)) {
            return {{0.0, kOpen}};
        }
        return std::abs(x) < 0.5 ? Spans{{0.0, 0.3}, {0.4, kOpen}} : Spans{{0.4, kOpen}};
    });
    expectLinksByTheRule(columns);
    // From end to end without leaving the width of the bridge: over it, not under it.
    const auto ahead = [&](std::size_t span) {
        return std::abs(centreOf(columns, span).y()) < 0.15 &&
               std::abs(centreOf(columns, span).x()) < 0.6;
    };
    const std::vector<bool> over =
        spansReachedFrom(columns, columns.spanAt(-0.575, 0.025, 0.5), ahead);
    EXPECT_TRUE(over[static_cast<std::size_t>(columns.spanAt(0.575, 0.025, 0.5))]);
    EXPECT_FALSE(over[static_cast<std::size_t>(columns.spanAt(0.025, 0.025, 0.1))]);
    // From side to side: under it as well.
    const auto across = [&](std::size_t span) {
        return std::abs(centreOf(columns, span).x()) < 0.5 && columns.floor[span] < 0.1;
    };
    const std::vector<bool> under =
        spansReachedFrom(columns, columns.spanAt(0.025, -0.325, 0.0), across);
    EXPECT_TRUE(under[static_cast<std::size_t>(columns.spanAt(0.025, 0.325, 0.0))]);
    EXPECT_TRUE(under[static_cast<std::size_t>(columns.spanAt(0.025, 0.025, 0.1))]);
}

TEST(MultiValued, ArchHasTheHeightsOfItsRings)
{
    constexpr double inner = 0.4;
    constexpr double outer = 0.6;
    constexpr int sides = 64;
    std::vector<Vec2> upper, lower;
    for (int k = 0; k <= sides; ++k) {
        const double angle = kPi * k / sides;
        const Vec2 along(-std::cos(angle), std::sin(angle));
        upper.push_back(outer * along);
        lower.push_back(inner * along);
    }
    // Height of a ring of straight sides over x.
    const auto heightOf = [](const std::vector<Vec2>& ring, double x) {
        std::size_t k = 1;
        while (ring[k].x() < x) {
            ++k;
        }
        const double share = (x - ring[k - 1].x()) / (ring[k].x() - ring[k - 1].x());
        return ring[k - 1].y() + share * (ring[k].y() - ring[k - 1].y());
    };
    const ColumnGrid columns =
        makeMeshField(kCell, 0.8, makeDrawnMesh(upper, lower, -0.2, 0.3), 0.0);
    expectSpans(columns, [&](double x, double y) -> Spans {
        if (std::abs(x) > outer || y < -0.2 || y > 0.3) {
            return {{0.0, kOpen}};
        }
        const double top = heightOf(upper, x);
        if (std::abs(x) > inner) {
            return {{top, kOpen}};
        }
        return {{0.0, heightOf(lower, x)}, {top, kOpen}};
    });
    expectLinksByTheRule(columns);
    // Its ends are open: whoever walks through does not have to climb.
    const auto straight = [&](std::size_t span) {
        return std::abs(centreOf(columns, span).x()) < inner && columns.floor[span] == 0.0;
    };
    const std::vector<bool> reached =
        spansReachedFrom(columns, columns.spanAt(0.025, -0.625, 0.0), straight);
    EXPECT_TRUE(reached[static_cast<std::size_t>(columns.spanAt(0.025, 0.625, 0.0))]);
}

/// Lower half of a spherical shell about (0, 0, centre), its rim level.
TriangleMesh makeBowl(double inner, double outer, double centre, int quarter, int steps)
{
    std::vector<Vec2> outline;
    for (int k = 0; k <= quarter; ++k) {
        const double angle = 0.5 * kPi * k / quarter;
        outline.emplace_back(outer * std::sin(angle), centre - outer * std::cos(angle));
    }
    for (int k = quarter; k >= 0; --k) {
        const double angle = 0.5 * kPi * k / quarter;
        outline.emplace_back(inner * std::sin(angle), centre - inner * std::cos(angle));
    }
    return makeTurnedMesh(outline, steps);
}

TEST(MultiValued, NestedBowlsAreAsManySpansAsThereAreHollows)
{
    constexpr int quarter = 100;
    constexpr int steps = 400;
    constexpr double cell = 0.04;
    constexpr double centre = 0.6;
    const TriangleMesh bowls = joined(makeBowl(0.45, 0.5, centre, quarter, steps),
                                      makeBowl(0.25, 0.3, centre, quarter, steps));
    const ColumnGrid columns = makeMeshField(cell, 0.7, bowls, 0.0);
    // The sides of the bowls lie inside the spheres by no more than this.
    const double facet = 0.5 * (1.0 - std::cos(kPi / steps)) +
                         0.5 * (1.0 - std::cos(0.25 * kPi / quarter));
    const auto expectOnSphere = [&](double z, double rho, double radius) {
        const auto drop = [&](double r) { return std::sqrt(std::max(r * r - rho * rho, 0.0)); };
        EXPECT_LT(z, centre - drop(radius - facet) + kHeightError);
        EXPECT_GT(z, centre - drop(radius) - kHeightError);
    };
    for (std::int32_t slot = 0; slot < static_cast<std::int32_t>(columns.slotCount()); ++slot) {
        const auto [i, j] = columns.columnOfSlot(slot);
        const auto [first, count] = columns.spansOfSlot(slot);
        const double rho = std::hypot(i + 0.5, j + 0.5) * cell;
        bool onRim = false;
        for (const double rim : {0.25, 0.3, 0.45, 0.5}) {
            onRim = onRim || std::abs(rho - rim) < 2.0 * facet;
        }
        ASSERT_FALSE(onRim) << "choose other bowls: this column may belong to either side";
        const int shells = (rho < 0.5 ? 1 : 0) + (rho < 0.3 ? 1 : 0);
        ASSERT_EQ(count, 1 + shells);
        const auto span = static_cast<std::size_t>(first);
        EXPECT_EQ(columns.floor[span], 0.0);
        EXPECT_EQ(columns.ceiling[span + static_cast<std::size_t>(shells)], kOpen);
        if (shells == 0) {
            continue;
        }
        expectOnSphere(columns.ceiling[span], rho, 0.5);
        if (rho > 0.45) {
            EXPECT_NEAR(columns.floor[span + 1], centre, kHeightError);
            continue;
        }
        expectOnSphere(columns.floor[span + 1], rho, 0.45);
        if (shells == 2) {
            expectOnSphere(columns.ceiling[span + 1], rho, 0.3);
            if (rho > 0.25) {
                EXPECT_NEAR(columns.floor[span + 2], centre, kHeightError);
            } else {
                expectOnSphere(columns.floor[span + 2], rho, 0.25);
            }
        }
    }
    expectLinksByTheRule(columns);
    // Between the shells and under the outer one: not the same place, but for the way over the rim.
    const std::int32_t between = columns.spanAt(0.02, 0.02, 0.2);
    const std::vector<bool> inOuter = spansReachedFrom(columns, between, [&](std::size_t span) {
        return centreOf(columns, span).norm() < 0.5;
    });
    EXPECT_TRUE(inOuter[static_cast<std::size_t>(columns.spanAt(0.02, 0.02, 0.5))])
        << "over the rim of the inner bowl";
    EXPECT_FALSE(inOuter[static_cast<std::size_t>(columns.spanAt(0.02, 0.02, 0.05))]);
    const std::vector<bool> inGap = spansReachedFrom(columns, between, [&](std::size_t span) {
        return centreOf(columns, span).norm() < 0.3;
    });
    EXPECT_FALSE(inGap[static_cast<std::size_t>(columns.spanAt(0.02, 0.02, 0.5))]);
}

TEST(MultiValued, ClosedBoxIsAWorldOfItsOwn)
{
    const TriangleMesh box =
        makeBlocksMesh({-0.4, -0.3, 0.3, 0.4}, {-0.4, -0.3, 0.3, 0.4}, {0.0, 0.1, 0.5, 0.6},
                       [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
    ColumnGrid columns = makeMeshField(kCell, 0.6, box, 0.0);
    expectSpans(columns, [](double x, double y) -> Spans {
        if (!isWithin(x, y, 0.4, 0.4)) {
            return {{0.0, kOpen}};
        }
        return isWithin(x, y, 0.3, 0.3) ? Spans{{0.1, 0.5}, {0.6, kOpen}} : Spans{{0.6, kOpen}};
    });
    expectLinksByTheRule(columns);
    const std::int32_t inside = columns.spanAt(0.025, 0.025, 0.3);
    const std::vector<bool> reached =
        spansReachedFrom(columns, inside, [](std::size_t) { return true; });
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        EXPECT_EQ(reached[s], columns.ceiling[s] == 0.5);
    }

    // Sand in it stays in it, and none of that on its lid gets in.
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const Vec2 centre = centreOf(columns, s);
        columns.R[s] = centre.norm() < 0.15 && columns.floor[s] > 0.05 ? 0.1 : 0.0;
    }
    const auto depthWithin = [&](bool wanted) {
        double sum = 0.0;
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            sum += reached[s] == wanted ? columns.h[s] + columns.R[s] - columns.floor[s] : 0.0;
        }
        return sum;
    };
    const double poured[2] = {depthWithin(false), depthWithin(true)};
    ASSERT_GT(poured[0], 1.0);
    BcreParams params;
    params.transport = true;
    for (int step = 0; step < 200; ++step) {
        evolveBcre(params, 0.02, columns);
    }
    EXPECT_NEAR(depthWithin(false), poured[0], 1e-12);
    EXPECT_NEAR(depthWithin(true), poured[1], 1e-12);
}

/// Poured into a tray that stands in another one, until it runs over.
TEST(MultiValued, AnInnerBowlOverflowsIntoTheOuterAndNothingFallsBelow)
{
    const auto makeTray = [](double inner, double outer, double bottom, double rim) {
        return makeBlocksMesh({-outer, -inner, inner, outer}, {-outer, -inner, inner, outer},
                              {bottom, bottom + 0.05, rim},
                              [](int i, int j, int k) { return k == 0 || i != 1 || j != 1; });
    };
    const TriangleMesh trays = joined(makeTray(0.6, 0.7, 0.1, 0.5), makeTray(0.2, 0.25, 0.15, 0.3));
    ColumnGrid columns = makeMeshField(kCell, 0.79, trays, 0.0);
    expectSpans(columns, [](double x, double y) -> Spans {
        const double rho = std::max(std::abs(x), std::abs(y));
        if (rho > 0.7) {
            return {{0.0, kOpen}};
        }
        if (rho > 0.6) {
            return {{0.0, 0.1}, {0.5, kOpen}};
        }
        if (rho > 0.25) {
            return {{0.0, 0.1}, {0.15, kOpen}};
        }
        return {{0.0, 0.1}, {rho > 0.2 ? 0.3 : 0.2, kOpen}};
    });
    expectLinksByTheRule(columns);

    BcreParams params;
    params.transport = true;
    const double dt = 0.02;
    double poured = 0.0;  // m, over columns
    for (int step = 0; step < 1500; ++step) {
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            if (columns.floor[s] == 0.2 && centreOf(columns, s).norm() < 0.1) {
                columns.R[s] += 0.05 * dt;
                poured += 0.05 * dt;
            }
        }
        evolveBcre(params, dt, columns);
    }
    double inInner = 0.0;
    double inOuter = 0.0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const double depth = columns.h[s] + columns.R[s] - columns.floor[s];
        const Vec2 centre = centreOf(columns, s);
        const bool isInTrays = isWithin(centre.x(), centre.y(), 0.6, 0.6) && columns.floor[s] > 0.1;
        if (!isInTrays) {
            ASSERT_EQ(depth, 0.0) << "at " << centre.transpose() << ", floor " << columns.floor[s];
        }
        (columns.floor[s] > 0.18 ? inInner : inOuter) += depth;
    }
    EXPECT_NEAR(inInner + inOuter, poured, 1e-9);
    // To the rim, 64 columns of the inner tray take 0.1 m each, and a heap above it.
    EXPECT_GT(inInner, 64 * 0.1);
    EXPECT_GT(inOuter, 1.0);
}

}  // namespace
}  // namespace sandflow::testing
