#include "solids/brute_surface.h"
#include "solids/free_intervals.h"
#include "solids/primitive.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

constexpr double kThin = 1e-6;

Primitive makePlane(const Vec3& point, const Vec3& normal)
{
    Primitive plane;
    plane.point = point;
    plane.axis = normal.normalized();
    return plane;
}

bool isMissed(const SolidInterval& interval)
{
    return interval.lo >= interval.hi;
}

TEST(SolidInterval, LevelTiltedAndDownwardPlanes)
{
    SolidInterval found =
        solidIntervalAt(makePlane(Vec3(9.0, 9.0, 0.3), Vec3::UnitZ()), 1, 2, kThin);
    EXPECT_EQ(found.lo, -1e30);
    EXPECT_DOUBLE_EQ(found.hi, 0.3);

    // z = -x / 2 far from the point that defines it.
    found = solidIntervalAt(makePlane(Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 2.0)), 1e4, -7.0, kThin);
    EXPECT_EQ(found.lo, -1e30);
    EXPECT_NEAR(found.hi, -5e3, 1e-9);

    found = solidIntervalAt(makePlane(Vec3(0.0, 0.0, 2.0), -Vec3::UnitZ()), 1.0, 2.0, kThin);
    EXPECT_DOUBLE_EQ(found.lo, 2.0);
    EXPECT_EQ(found.hi, 1e30);
}

TEST(SolidInterval, AVerticalPlaneFillsWhatLiesBehindIt)
{
    const Primitive wall = makePlane(Vec3(0.5, 0.0, 0.0), -Vec3::UnitX());  // solid is x > 0.5
    EXPECT_TRUE(isMissed(solidIntervalAt(wall, 0.4, 3.0, kThin)));
    const SolidInterval behind = solidIntervalAt(wall, 0.6, 3.0, kThin);
    EXPECT_EQ(behind.lo, -1e30);
    EXPECT_EQ(behind.hi, 1e30);
}

TEST(SolidInterval, BoxPanelAndDisc)
{
    Primitive box;
    box.kind = Primitive::Kind::solidBox;
    box.min = Vec3(0.0, 0.0, 0.1);
    box.max = Vec3(1.0, 2.0, 0.4);
    SolidInterval found = solidIntervalAt(box, 0.5, 1.5, kThin);
    EXPECT_EQ(found.lo, 0.1);
    EXPECT_EQ(found.hi, 0.4);
    EXPECT_FALSE(isMissed(solidIntervalAt(box, 1.0, 2.0, kThin)));  // its edge is still box
    EXPECT_TRUE(isMissed(solidIntervalAt(box, 1.001, 1.0, kThin)));

    Primitive panel = box;
    panel.kind = Primitive::Kind::panel;
    panel.max.z() = 0.1;
    found = solidIntervalAt(panel, 0.5, 1.5, 0.01);
    EXPECT_EQ(found.hi, 0.1);
    EXPECT_DOUBLE_EQ(found.lo, 0.09);
    EXPECT_TRUE(isMissed(solidIntervalAt(panel, -0.1, 1.5, 0.01)));
    panel.max = Vec3(0.0, 2.0, 0.4);  // now on edge, at x = 0
    EXPECT_TRUE(isMissed(solidIntervalAt(panel, 0.0, 1.0, 0.01)));

    Primitive disc;
    disc.kind = Primitive::Kind::disc;
    disc.point = Vec3(1.0, 0.0, 0.5);
    disc.axis = Vec3(0.6, 0.0, 0.8);
    disc.radius = 0.5;
    found = solidIntervalAt(disc, 1.2, 0.0, 0.01);  // slope -3/4 in x
    EXPECT_NEAR(found.hi, 0.35, 1e-15);
    EXPECT_NEAR(found.hi - found.lo, 0.01, 1e-15);
    EXPECT_TRUE(isMissed(solidIntervalAt(disc, 1.41, 0.0, 0.01)));  // it leans: reaches 0.4 in x
    EXPECT_FALSE(isMissed(solidIntervalAt(disc, 1.39, 0.0, 0.01)));
    EXPECT_FALSE(isMissed(solidIntervalAt(disc, 1.0, 0.49, 0.01)));
}

/// Where [lo, hi] ends, the distance to the filled solid changes its sign; and so only there.
TEST(SolidInterval, AgreesWithTheSignOfTheDistanceForFilledSolids)
{
    std::mt19937_64 random(21);
    int hits = 0;
    for (const Primitive::Kind kind :
         {Primitive::Kind::halfSpace, Primitive::Kind::solidBox, Primitive::Kind::solidCylinder}) {
        for (int trial = 0; trial < 3000; ++trial) {
            Primitive primitive = drawPrimitive(random, kind);
            if (trial % 10 == 0) {
                primitive.axis = Vec3(0.6, -0.8, 0.0);  // lying
            } else if (trial % 10 == 1) {
                primitive.axis = Vec3(1e-9, 0.0, 1.0);  // all but upright
            }
            const double x = drawUniform(random, -1.0, 1.0);
            const double y = drawUniform(random, -1.0, 1.0);
            const SolidInterval found = solidIntervalAt(primitive, x, y, kThin);
            hits += isMissed(found) ? 0 : 1;
            for (int k = 0; k < 40; ++k) {
                const double z = drawUniform(random, -2.0, 2.0);
                const double distance = nearestSurface(primitive, Vec3(x, y, z)).distance;
                if (std::abs(distance) > 1e-9) {
                    EXPECT_EQ(distance<0.0, z> found.lo && z < found.hi)
                        << nameKind(kind) << " at " << x << " " << y << " " << z;
                }
            }
        }
    }
    EXPECT_GT(hits, 3000);  // the comparison must not be about misses alone
}

TEST(BlocksPath, PanelParts)
{
    Primitive panel;
    panel.kind = Primitive::Kind::panel;
    panel.min = Vec3(0.5, 0.0, 0.1);
    panel.max = Vec3(0.5, 1.0, 0.4);
    const Vec2 left(0.45, 0.5);
    const Vec2 right(0.55, 0.5);
    EXPECT_TRUE(blocksPath(panel, left, right, 0.0, 1e30));
    EXPECT_TRUE(blocksPath(panel, right, left, 0.0, 1e30));
    EXPECT_TRUE(blocksPath(panel, left, right, 0.2, 0.3));
    EXPECT_FALSE(blocksPath(panel, left, right, 0.4, 1.0));   // begins at its rim
    EXPECT_FALSE(blocksPath(panel, left, right, -1.0, 0.1));  // passes below
    EXPECT_FALSE(blocksPath(panel, left, Vec2(0.35, 0.5), 0.0, 1.0));
    EXPECT_FALSE(blocksPath(panel, left, Vec2(0.45, 0.6), 0.0, 1.0));  // along the wall

    // Beside the wall, in both directions, and cutting its corner or not.
    EXPECT_FALSE(blocksPath(panel, Vec2(0.45, 1.01), Vec2(0.55, 1.01), 0.0, 1.0));
    EXPECT_FALSE(blocksPath(panel, Vec2(0.45, -0.01), Vec2(0.55, -0.01), 0.0, 1.0));
    EXPECT_TRUE(blocksPath(panel, Vec2(0.45, 0.9), Vec2(0.55, 1.05), 0.0, 1.0));
    EXPECT_FALSE(blocksPath(panel, Vec2(0.45, 0.95), Vec2(0.55, 1.2), 0.0, 1.0));

    // A lying panel is a floor, not a wall.
    panel.min = Vec3(0.0, 0.0, 0.2);
    panel.max = Vec3(1.0, 1.0, 0.2);
    EXPECT_FALSE(blocksPath(panel, left, right, 0.0, 1.0));
}

TEST(BlocksPath, AColumnOnTheWallIsCutOffOnOneSideOnly)
{
    Primitive panel;
    panel.kind = Primitive::Kind::panel;
    panel.min = Vec3(0.0, 0.5, 0.0);
    panel.max = Vec3(1.0, 0.5, 1.0);
    const Vec2 before(0.5, 0.4);
    const Vec2 on(0.5, 0.5);
    const Vec2 after(0.5, 0.6);
    EXPECT_TRUE(blocksPath(panel, before, on, 0.0, 1.0));
    EXPECT_FALSE(blocksPath(panel, on, after, 0.0, 1.0));
    EXPECT_TRUE(blocksPath(panel, before, after, 0.0, 1.0));
}

TEST(BlocksPath, TubePartsInsideFromOutside)
{
    Primitive tube;
    tube.kind = Primitive::Kind::tube;
    tube.point = Vec3(1.0, 1.0, 0.2);
    tube.radius = 0.5;
    tube.height = 0.6;
    const Vec2 centre(1.0, 1.0);
    for (int k = 0; k < 16; ++k) {
        const Vec2 out(std::cos(k * kPi / 8.0), std::sin(k * kPi / 8.0));
        EXPECT_TRUE(blocksPath(tube, centre + 0.49 * out, centre + 0.51 * out, 0.0, 1e30));
        EXPECT_TRUE(blocksPath(tube, centre + 0.51 * out, centre + 0.49 * out, 0.0, 1e30));
        EXPECT_FALSE(blocksPath(tube, centre + 0.3 * out, centre + 0.49 * out, 0.0, 1e30));
        EXPECT_FALSE(blocksPath(tube, centre + 0.51 * out, centre + 0.6 * out, 0.0, 1e30));
        EXPECT_FALSE(blocksPath(tube, centre + 0.49 * out, centre + 0.51 * out, 0.8, 1e30));
        EXPECT_FALSE(blocksPath(tube, centre + 0.49 * out, centre + 0.51 * out, 0.0, 0.2));
        // Through both walls: the ends are on one side.
        EXPECT_FALSE(blocksPath(tube, centre - 0.6 * out, centre + 0.6 * out, 0.0, 1e30));
    }
    // Upside down it is the same wall between 0.2 and 0.8.
    tube.point.z() = 0.8;
    tube.axis = -Vec3::UnitZ();
    EXPECT_TRUE(blocksPath(tube, centre, Vec2(2.0, 1.0), 0.25, 0.3));
    EXPECT_FALSE(blocksPath(tube, centre, Vec2(2.0, 1.0), 0.85, 0.9));
}

TEST(BlocksPath, ALyingPipePartsOnlyAtItsWall)
{
    Primitive pipe;
    pipe.kind = Primitive::Kind::tube;
    pipe.axis = Vec3::UnitX();
    pipe.radius = 0.5;
    pipe.height = 2.0;
    EXPECT_TRUE(blocksPath(pipe, Vec2(1.0, 0.45), Vec2(1.0, 0.55), -0.1, 0.1));
    EXPECT_FALSE(blocksPath(pipe, Vec2(1.9, 0.0), Vec2(2.1, 0.0), -0.1, 0.1));  // its open end
    EXPECT_FALSE(blocksPath(pipe, Vec2(2.1, 0.45), Vec2(2.1, 0.55), -0.1, 0.1));
    EXPECT_FALSE(blocksPath(pipe, Vec2(1.0, 0.45), Vec2(1.0, 0.55), 0.6, 0.8));  // above it
}

TEST(BlocksPath, ADiscOnEdgeIsAWall)
{
    Primitive gate;
    gate.kind = Primitive::Kind::disc;
    gate.axis = Vec3::UnitX();
    gate.point = Vec3(0.0, 0.0, 1.0);
    gate.radius = 0.5;
    EXPECT_TRUE(blocksPath(gate, Vec2(-0.1, 0.3), Vec2(0.1, 0.3), 0.0, 0.61));  // chord from 0.6
    EXPECT_FALSE(blocksPath(gate, Vec2(-0.1, 0.3), Vec2(0.1, 0.3), 0.0, 0.59));
    EXPECT_FALSE(blocksPath(gate, Vec2(-0.1, 0.6), Vec2(0.1, 0.6), 0.0, 2.0));
    EXPECT_FALSE(blocksPath(gate, Vec2(0.1, 0.3), Vec2(0.2, 0.3), 0.0, 2.0));
    gate.axis = Vec3::UnitZ();
    EXPECT_FALSE(blocksPath(gate, Vec2(-0.1, 0.3), Vec2(0.1, 0.3), 0.0, 2.0));
}

TEST(BlocksPath, FilledSolidsBlockByTheirSpansAlone)
{
    Primitive box;
    box.kind = Primitive::Kind::solidBox;
    box.min = Vec3(0.4, 0.0, 0.0);
    box.max = Vec3(0.6, 1.0, 1.0);
    EXPECT_FALSE(blocksPath(box, Vec2(0.3, 0.5), Vec2(0.5, 0.5), 0.0, 1.0));
}

/// A random walk over columns inside a closed ring of walls never gets out by unblocked links.
TEST(BlocksPath, ContainersAreTight)
{
    SolidSpec spec;
    spec.shape = SolidShape::box;
    spec.hollow = true;
    spec.min = Vec3(-0.2, -0.15, 0.0);
    spec.max = Vec3(0.25, 0.2, 0.3);
    std::vector<Primitive> box = buildPrimitives(spec, 0);
    spec.shape = SolidShape::cylinder;
    spec.radius = 0.2;
    spec.height = 0.3;
    const std::vector<Primitive> tube = buildPrimitives(spec, 0);

    const auto countReached = [](const std::vector<Primitive>& walls, double cell) {
        // Flood from the column at the origin over links on a field far larger than the walls.
        constexpr int kReach = 60;
        constexpr int kEdge = 2 * kReach + 1;
        std::vector<bool> reached(kEdge * kEdge, false);
        std::vector<std::pair<int, int>> open = {{0, 0}};
        reached[kReach * kEdge + kReach] = true;
        std::size_t count = 0;
        while (!open.empty()) {
            const auto [i, j] = open.back();
            open.pop_back();
            ++count;
            const Vec2 from((i + 0.5) * cell, (j + 0.5) * cell);
            for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                const int ni = i + di;
                const int nj = j + dj;
                if (std::abs(ni) > kReach || std::abs(nj) > kReach ||
                    reached[(ni + kReach) * kEdge + nj + kReach]) {
                    continue;
                }
                const Vec2 to((ni + 0.5) * cell, (nj + 0.5) * cell);
                bool blocked = false;
                for (const Primitive& wall : walls) {
                    blocked = blocked || blocksPath(wall, from, to, 0.0, 0.3);
                }
                if (!blocked) {
                    reached[(ni + kReach) * kEdge + nj + kReach] = true;
                    open.emplace_back(ni, nj);
                }
            }
        }
        return count;
    };
    // cell 0.02 puts centres off the walls; 0.1 / 7 and 0.1 / 3 put them anywhere, also on walls.
    for (const double cell : {0.02, 0.1 / 7.0, 0.1 / 3.0}) {
        EXPECT_NEAR(static_cast<double>(countReached(box, cell)) * cell * cell, 0.45 * 0.35,
                    1.6 * cell);
        EXPECT_NEAR(static_cast<double>(countReached(tube, cell)) * cell * cell, kPi * 0.04,
                    1.3 * cell);
    }
    box.pop_back();  // one wall open: the flood gets out
    EXPECT_GT(static_cast<double>(countReached(box, 0.02)) * 4e-4, 1.0);
}

}  // namespace
}  // namespace sandflow::testing
