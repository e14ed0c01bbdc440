#include "mesh/crossing_grid.h"

#include "core/errors.h"
#include "mesh/line_checks.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace sandflow::testing {
namespace {

int sumOfTurns(const CrossingGrid& grid, double x, double y, std::vector<Crossing>& crossings)
{
    grid.crossingsAt(x, y, crossings);
    int sum = 0;
    for (const Crossing& crossing : crossings) {
        sum += crossing.turn;
    }
    return sum;
}

/// A closed surface without any shape: corners thrown at random onto a coarse lattice, where many
/// coincide, many triangles are degenerate and many edges overlap; triangles in random order, each
/// with corners of its own.
TriangleMesh makeSoup(std::mt19937_64& random, const TriangleMesh& closed)
{
    std::vector<Vec3> moved;
    for (std::size_t k = 0; k < closed.points.size(); ++k) {
        const auto draw = [&] { return static_cast<double>(random() % 17) / 16.0; };
        moved.emplace_back(draw(), draw(), draw());
    }
    auto triangles = closed.triangles;
    std::shuffle(triangles.begin(), triangles.end(), random);
    TriangleMesh soup;
    for (const auto& triangle : triangles) {
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        for (const std::uint32_t corner : triangle) {
            soup.points.push_back(moved[corner]);
        }
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

/// The heart of it: whatever a closed surface looks like, every line leaves it as often as it
/// enters, also lines through its corners and along its edges.
TEST(CrossingGrid, EveryLineThroughAClosedSoupBalances)
{
    std::mt19937_64 random(3);
    std::vector<Crossing> crossings;
    std::size_t crossed = 0;
    for (int soupNumber = 0; soupNumber < 20; ++soupNumber) {
        const TriangleMesh closed = soupNumber % 2 == 0
                                        ? makeIcosphereMesh(Vec3::Zero(), 1.0, soupNumber % 3)
                                        : makeTorusMesh(2.0, 1.0, 5 + soupNumber, 7);
        const TriangleMesh soup = makeSoup(random, closed);
        const CrossingGrid grid(soup);
        ASSERT_TRUE(grid.isClosed());
        for (int k = 0; k < 5000; ++k) {
            const double x = uniformIn(random, 0.0, 1.0);
            const double y = uniformIn(random, 0.0, 1.0);
            ASSERT_EQ(sumOfTurns(grid, x, y, crossings), 0) << x << ", " << y;
            crossed += crossings.size();
        }
        // All corners have multiples of 1/16; halves and quarters of edges those of 1/64.
        for (int k = 0; k < 500; ++k) {
            const Vec3& a = soup.points[random() % soup.points.size()];
            const Vec3& b = soup.points[random() % soup.points.size()];
            const double share = 0.25 * static_cast<double>(random() % 5);
            const Vec3 p = a + share * (b - a);
            ASSERT_EQ(sumOfTurns(grid, p.x(), p.y(), crossings), 0) << p.transpose();
            crossed += crossings.size();
        }
    }
    EXPECT_GT(crossed, 1000000u) << "most lines must have met triangles";
}

TEST(CrossingGrid, LinesThroughTheCornersAndEdgesOfASphereCrossItTwice)
{
    const TriangleMesh sphere = makeIcosphereMesh({0.1, 0.2, 0.3}, 0.7, 3);
    const CrossingGrid grid(sphere);
    std::vector<Crossing> crossings;
    for (const auto& [i, j, k] : sphere.triangles) {
        const Vec3& a = sphere.points[i];
        const Vec3& b = sphere.points[j];
        for (const Vec3& p : {a, Vec3(0.5 * (a + b))}) {
            if ((p - Vec3(0.1, 0.2, 0.3)).head<2>().norm() > 0.68) {
                continue;  // the outline seen from above
            }
            EXPECT_EQ(sumOfTurns(grid, p.x(), p.y(), crossings), 0);
            ASSERT_EQ(crossings.size(), 2u);
            EXPECT_TRUE(std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
                return std::abs(c.height - p.z()) < 1e-8;
            })) << p.transpose();
        }
    }
}

TEST(CrossingGrid, SeesThatAMeshIsOpen)
{
    TriangleMesh sphere = makeIcosphereMesh(Vec3::Zero(), 1.0, 2);
    EXPECT_TRUE(CrossingGrid(sphere).isClosed());
    EXPECT_TRUE(CrossingGrid(turnedInsideOut(sphere)).isClosed());
    TriangleMesh holed = sphere;
    holed.triangles.erase(holed.triangles.begin() + 100);
    EXPECT_FALSE(CrossingGrid(holed).isClosed());
    TriangleMesh twice = sphere;
    twice.triangles.push_back(twice.triangles[100]);
    EXPECT_FALSE(CrossingGrid(twice).isClosed());
    TriangleMesh turned = sphere;
    std::swap(turned.triangles[100][0], turned.triangles[100][1]);
    EXPECT_FALSE(CrossingGrid(turned).isClosed());
}

TEST(CrossingGrid, WithoutAWallIsStillClosedSeenFromAbove)
{
    TriangleMesh box = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    box.triangles.resize(10);  // the wall at x = 1
    EXPECT_TRUE(CrossingGrid(box).isClosed());
}

TEST(CrossingGrid, NothingIsCrossedBesideTheMeshOrNowhere)
{
    const CrossingGrid grid(makeBoxMesh(Vec3::Zero(), Vec3::Ones()));
    std::vector<Crossing> crossings;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec2& line : {Vec2(-1e-300, 0.5), Vec2(1.1, 0.5), Vec2(0.5, -0.1), Vec2(0.5, 1e300),
                             Vec2(nan, 0.5), Vec2(0.5, nan), Vec2(1e30, -1e30)}) {
        grid.crossingsAt(line.x(), line.y(), crossings);
        EXPECT_TRUE(crossings.empty()) << line.transpose();
    }
    const CrossingGrid nothing{TriangleMesh{}};
    nothing.crossingsAt(0.0, 0.0, crossings);
    EXPECT_TRUE(crossings.empty());
    EXPECT_TRUE(nothing.isClosed());
    // A wall seen edge-on, and a mesh without width.
    TriangleMesh wall;
    wall.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    CrossingGrid(wall).crossingsAt(0.5, 0.0, crossings);
    EXPECT_TRUE(crossings.empty());
    wall.triangles = {{0, 2, 3}};
    CrossingGrid(wall).crossingsAt(0.0, 0.0, crossings);
    EXPECT_TRUE(crossings.empty());
}

TEST(CrossingGrid, RefusesCornersThatAreNowhereOrMissing)
{
    TriangleMesh box = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
        box.points[3].x() = bad;
        EXPECT_THROW(CrossingGrid{box}, InternalError);
    }
    box = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    box.triangles[5][1] = 8;
    EXPECT_THROW(CrossingGrid{box}, InternalError);
}

TEST(CrossingGrid, LevelFacesHaveTheirOwnHeightToTheBit)
{
    std::mt19937_64 random(5);
    const CrossingGrid grid(makeBoxMesh({-0.3, -0.7, 0.1}, {0.9, 0.35, 0.3}));
    std::vector<Crossing> crossings;
    for (int k = 0; k < 1000; ++k) {
        grid.crossingsAt(uniformIn(random, -0.3, 0.9), uniformIn(random, -0.7, 0.35), crossings);
        ASSERT_EQ(crossings.size(), 2u);
        EXPECT_EQ(std::min(crossings[0].height, crossings[1].height), 0.1);
        EXPECT_EQ(std::max(crossings[0].height, crossings[1].height), 0.3);
    }
}

/// Any size, anywhere: the lattice follows.
TEST(CrossingGrid, SlopesAreRightAtAnyScale)
{
    std::mt19937_64 random(6);
    std::vector<Crossing> crossings;
    for (const double scale : {1e-7, 1e-3, 1.0, 1e3, 1e7}) {
        for (const double away : {0.0, 100.0}) {
            const TriangleMesh sheet =
                makeSheetMesh(scale * away, scale * (away + 1.0), 3,
                              [](double x, double y) { return x + 0.5 * y; });
            const CrossingGrid grid(sheet);
            EXPECT_LT(grid.latticeSpacing(), 2e-9 * scale);
            for (int k = 0; k < 100; ++k) {
                const double x = scale * (away + uniformIn(random, 0.01, 0.99));
                const double y = scale * (away + uniformIn(random, 0.01, 0.99));
                grid.crossingsAt(x, y, crossings);
                ASSERT_EQ(crossings.size(), 1u);
                EXPECT_EQ(crossings[0].turn, -1);
                EXPECT_NEAR(crossings[0].height, x + 0.5 * y, 3.0 * grid.latticeSpacing());
            }
        }
    }
}

/// A cone of needles that all lie across most buckets: neither memory nor time may run away.
TEST(CrossingGrid, AFanOfNeedlesStaysCheap)
{
    constexpr int count = 100000;
    const TriangleMesh cone = makeTurnedMesh({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}, count);
    const auto before = std::chrono::steady_clock::now();
    const CrossingGrid grid(cone);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
    EXPECT_LT(took.count(), 10.0);
    RecordProperty("seconds", std::to_string(took.count()));
    std::mt19937_64 random(8);
    std::vector<Crossing> crossings;
    for (int k = 0; k < 1000; ++k) {
        const double angle = uniformIn(random, 0.0, 2.0 * kPi);
        const double radius = uniformIn(random, 0.001, 0.999);
        const Vec2 line(radius * std::cos(angle), radius * std::sin(angle));
        EXPECT_EQ(sumOfTurns(grid, line.x(), line.y(), crossings), 0);
        ASSERT_EQ(crossings.size(), 2u);
        EXPECT_NEAR(std::max(crossings[0].height, crossings[1].height), 1.0 - radius, 1e-8);
    }
}

}  // namespace
}  // namespace sandflow::testing
