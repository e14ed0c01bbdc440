#include "solids/brute_surface.h"
#include "solids/free_intervals.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

using Intervals = std::vector<std::pair<double, double>>;

SolidSpec makeBox(const Vec3& min, const Vec3& max)
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.min = min;
    box.max = max;
    return box;
}

std::vector<Primitive> buildAll(const std::vector<SolidSpec>& specs)
{
    std::vector<Primitive> all;
    for (const SolidSpec& spec : specs) {
        for (const Primitive& primitive : buildPrimitives(spec, 0)) {
            all.push_back(primitive);
        }
    }
    return all;
}

Intervals freeAt(const std::vector<Primitive>& primitives, double x, double y, double time = 0.0,
                 double minGap = 0.01)
{
    Intervals out = {{7.0, 8.0}};  // must be replaced
    freeIntervals(primitives, time, x, y, minGap, out);
    return out;
}

void expectIntervals(const Intervals& found, const Intervals& expected)
{
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_NEAR(found[k].first, expected[k].first, 2e-6);
        EXPECT_NEAR(found[k].second, expected[k].second, 2e-6);
    }
}

TEST(FreeIntervals, NothingAtAllIsOpenBothWays)
{
    expectIntervals(freeAt({}, 1.0, 2.0), {{kNoFloor, kOpenAbove}});
}

TEST(FreeIntervals, AFloorIsOneOpenSpan)
{
    const std::vector<Primitive> floor = buildAll({SolidSpec()});
    expectIntervals(freeAt(floor, 1e4, -1e4), {{0.0, kOpenAbove}});
}

/// Floor at 0, table top from 0.30 to 0.34 m made of four boxes about a square hole, one solid leg.
std::vector<Primitive> makeTable()
{
    return buildAll({SolidSpec(), makeBox(Vec3(-0.5, -0.5, 0.30), Vec3(-0.1, 0.5, 0.34)),
                     makeBox(Vec3(0.1, -0.5, 0.30), Vec3(0.5, 0.5, 0.34)),
                     makeBox(Vec3(-0.1, -0.5, 0.30), Vec3(0.1, -0.1, 0.34)),
                     makeBox(Vec3(-0.1, 0.1, 0.30), Vec3(0.1, 0.5, 0.34)),
                     makeBox(Vec3(0.4, 0.4, 0.0), Vec3(0.45, 0.45, 0.30))});
}

TEST(FreeIntervals, TableWithAHole)
{
    const std::vector<Primitive> table = makeTable();
    const Intervals covered = {{0.0, 0.30}, {0.34, kOpenAbove}};
    const Intervals open = {{0.0, kOpenAbove}};
    expectIntervals(freeAt(table, -0.3, 0.0), covered);
    expectIntervals(freeAt(table, 0.0, 0.3), covered);
    expectIntervals(freeAt(table, 0.1, 0.3), covered);  // the seam between two boxes is closed
    expectIntervals(freeAt(table, 0.0, 0.0), open);     // the hole
    expectIntervals(freeAt(table, 0.6, 0.0), open);     // beside the table
    expectIntervals(freeAt(table, 0.42, 0.42), {{0.34, kOpenAbove}});  // the leg
}

TEST(FreeIntervals, LowGapsClose)
{
    const std::vector<Primitive> shelf =
        buildAll({SolidSpec(), makeBox(Vec3(-1, -1, 0.02), Vec3(1, 1, 0.1))});
    expectIntervals(freeAt(shelf, 0.0, 0.0, 0.0, 0.019), {{0.0, 0.02}, {0.1, kOpenAbove}});
    expectIntervals(freeAt(shelf, 0.0, 0.0, 0.0, 0.021), {{0.1, kOpenAbove}});
    // Boxes that touch leave no gap even if every gap counts.
    const std::vector<Primitive> stack = buildAll(
        {makeBox(Vec3(-1, -1, 0.0), Vec3(1, 1, 0.1)), makeBox(Vec3(-1, -1, 0.1), Vec3(1, 1, 0.2))});
    expectIntervals(freeAt(stack, 0.0, 0.0, 0.0, 0.0), {{kNoFloor, 0.0}, {0.2, kOpenAbove}});
}

TEST(FreeIntervals, SolidsComeAndGo)
{
    SolidSpec trapdoor;
    trapdoor.shape = SolidShape::disc;
    trapdoor.point = Vec3(0.0, 0.0, 0.5);
    trapdoor.radius = 0.2;
    trapdoor.from = 1.0;
    trapdoor.until = 2.0;
    const std::vector<Primitive> scene = buildAll({SolidSpec(), trapdoor});
    const Intervals shut = {{0.0, 0.5}, {0.5, kOpenAbove}};
    const Intervals open = {{0.0, kOpenAbove}};
    expectIntervals(freeAt(scene, 0.1, 0.0, 0.5), open);
    expectIntervals(freeAt(scene, 0.1, 0.0, 1.0), shut);
    EXPECT_EQ(freeAt(scene, 0.1, 0.0, 1.0)[1].first, 0.5);  // sand rests on its true height
    expectIntervals(freeAt(scene, 0.1, 0.0, 2.0), open);
    expectIntervals(freeAt(scene, 0.3, 0.0, 1.5), open);
}

TEST(FreeIntervals, HollowContainersAreOpenInside)
{
    SolidSpec box = makeBox(Vec3(-0.2, -0.2, 0.1), Vec3(0.2, 0.2, 0.6));
    box.hollow = true;
    box.floor = true;
    std::vector<Primitive> scene = buildAll({SolidSpec(), box});
    expectIntervals(freeAt(scene, 0.0, 0.0), {{0.0, 0.1}, {0.1, kOpenAbove}});
    expectIntervals(freeAt(scene, 0.3, 0.0), {{0.0, kOpenAbove}});

    SolidSpec beaker;
    beaker.shape = SolidShape::cylinder;
    beaker.hollow = true;
    beaker.floor = true;
    beaker.point = Vec3(0.0, 0.0, 0.0);  // stands on the floor: nothing fits below
    beaker.radius = 0.3;
    beaker.height = 0.5;
    scene = buildAll({SolidSpec(), beaker});
    expectIntervals(freeAt(scene, 0.1, 0.1), {{0.0, kOpenAbove}});
    beaker.floor = false;
    expectIntervals(freeAt(buildAll({beaker}), 0.1, 0.1), {{kNoFloor, kOpenAbove}});
}

TEST(FreeIntervals, LidsAndWalls)
{
    SolidSpec lid;
    lid.point = Vec3(0.0, 0.0, 2.0);
    lid.normal = -Vec3::UnitZ();
    SolidSpec wall;
    wall.point = Vec3(1.0, 0.0, 0.0);
    wall.normal = -Vec3::UnitX();
    const std::vector<Primitive> room = buildAll({wall, lid, SolidSpec()});
    expectIntervals(freeAt(room, 0.0, 0.0), {{0.0, 2.0}});
    EXPECT_TRUE(freeAt(room, 1.5, 0.0).empty());
}

/// Many random solids at once: a height is free exactly if it is inside none of them.
TEST(FreeIntervals, AreTheComplementOfRandomSolids)
{
    std::mt19937_64 random(31);
    std::size_t spans = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::vector<Primitive> scene;
        for (int k = 0; k < 6; ++k) {
            Primitive primitive = drawPrimitive(
                random, k % 2 == 0 ? Primitive::Kind::solidBox : Primitive::Kind::solidCylinder);
            primitive.point.z() += drawUniform(random, -3.0, 3.0);
            const double shift = drawUniform(random, -3.0, 3.0);
            primitive.min.z() += shift;
            primitive.max.z() += shift;
            scene.push_back(primitive);
        }
        const double x = drawUniform(random, -0.7, 0.7);
        const double y = drawUniform(random, -0.7, 0.7);
        const Intervals found = freeAt(scene, x, y, 0.0, 0.0);
        spans += found.size();
        EXPECT_EQ(found.front().first, kNoFloor);
        EXPECT_EQ(found.back().second, kOpenAbove);
        for (int k = 0; k < 100; ++k) {
            const double z = drawUniform(random, -5.0, 5.0);
            bool inSolid = false;
            for (const Primitive& primitive : scene) {
                inSolid = inSolid || isInside(primitive, Vec3(x, y, z));
            }
            bool inGap = false;
            for (const auto& [floor, ceiling] : found) {
                inGap = inGap || (z > floor && z < ceiling);
            }
            EXPECT_NE(inSolid, inGap) << x << " " << y << " " << z;
        }
    }
    EXPECT_GT(spans, 2000u);  // one span a column would say little
}

}  // namespace
}  // namespace sandflow::testing
