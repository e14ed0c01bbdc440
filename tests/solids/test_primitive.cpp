#include "core/errors.h"
#include "solids/brute_surface.h"
#include "solids/primitive.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

SolidSpec makeBoxSpec()
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.min = Vec3(-0.5, -0.25, 0.0);
    box.max = Vec3(0.5, 0.25, 1.0);
    return box;
}

SolidSpec makeCylinderSpec()
{
    SolidSpec cylinder;
    cylinder.shape = SolidShape::cylinder;
    cylinder.point = Vec3(1.0, 2.0, 3.0);
    cylinder.normal = Vec3(0.0, 0.6, 0.8);
    cylinder.radius = 0.3;
    cylinder.height = 0.7;
    return cylinder;
}

std::string messageOf(const SolidSpec& solid)
{
    try {
        buildPrimitives(solid, 4);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(BuildPrimitives, PlaneIsARoughOrSmoothHalfSpace)
{
    SolidSpec plane;
    plane.rough = true;
    plane.point = Vec3(0.0, 0.0, 0.2);
    plane.normal = Vec3(3.0, 0.0, 4.0);  // the reader gives unit normals; any length will do
    plane.from = 1.0;
    plane.until = 2.0;
    const std::vector<Primitive> built = buildPrimitives(plane, 7);
    ASSERT_EQ(built.size(), 1u);
    EXPECT_EQ(built[0].kind, Primitive::Kind::halfSpace);
    EXPECT_EQ(built[0].solid, 7);
    EXPECT_TRUE(built[0].rough);
    EXPECT_LT((built[0].axis - Vec3(0.6, 0.0, 0.8)).norm(), 1e-15);
    EXPECT_EQ(built[0].point, plane.point);
    EXPECT_FALSE(built[0].existsAt(0.999));
    EXPECT_TRUE(built[0].existsAt(1.0));
    EXPECT_FALSE(built[0].existsAt(2.0));
}

TEST(BuildPrimitives, FilledBoxIsOneSolid)
{
    const std::vector<Primitive> built = buildPrimitives(makeBoxSpec(), 0);
    ASSERT_EQ(built.size(), 1u);
    EXPECT_EQ(built[0].kind, Primitive::Kind::solidBox);
    EXPECT_NEAR(nearestSurface(built[0], Vec3(0.0, 0.0, 1.2)).distance, 0.2, 1e-15);
    EXPECT_NEAR(nearestSurface(built[0], Vec3(0.0, 0.0, 0.5)).distance, -0.25, 1e-15);
}

TEST(BuildPrimitives, HollowBoxIsFourWallsAndPerhapsABottom)
{
    SolidSpec box = makeBoxSpec();
    box.hollow = true;
    box.until = 5.0;
    const std::vector<Primitive> walls = buildPrimitives(box, 2);
    ASSERT_EQ(walls.size(), 4u);
    box.floor = true;
    const std::vector<Primitive> all = buildPrimitives(box, 2);
    ASSERT_EQ(all.size(), 5u);
    for (const Primitive& panel : all) {
        EXPECT_EQ(panel.kind, Primitive::Kind::panel);
        EXPECT_EQ(panel.solid, 2);
        EXPECT_EQ(panel.until, 5.0);
    }

    // From the middle: walls at 0.5 in x, 0.25 in y; bottom at 0.5; nothing above.
    const Vec3 middle(0.0, 0.0, 0.5);
    const auto nearestIn = [](const std::vector<Primitive>& panels, const Vec3& q) {
        double nearest = 1e30;
        for (const Primitive& panel : panels) {
            nearest = std::min(nearest, nearestSurface(panel, q).distance);
        }
        return nearest;
    };
    EXPECT_DOUBLE_EQ(nearestIn(all, middle), 0.25);
    EXPECT_DOUBLE_EQ(nearestIn(all, Vec3(0.45, 0.0, 0.5)), 0.5 - 0.45);
    EXPECT_DOUBLE_EQ(nearestIn(all, Vec3(-0.45, 0.0, 0.5)), 0.5 - 0.45);
    EXPECT_DOUBLE_EQ(nearestIn(all, Vec3(0.0, -0.35, 0.5)), 0.35 - 0.25);
    EXPECT_DOUBLE_EQ(nearestIn(all, Vec3(0.0, 0.0, 0.0625)), 0.0625);
    EXPECT_DOUBLE_EQ(nearestIn(walls, Vec3(0.0, 0.0, 0.0625)), 0.25);
    EXPECT_DOUBLE_EQ(nearestIn(all, Vec3(0.0, 0.0, 1.0)), 0.25);  // open at the top
}

TEST(BuildPrimitives, CylinderFilledHollowAndClosedBelow)
{
    SolidSpec cylinder = makeCylinderSpec();
    std::vector<Primitive> built = buildPrimitives(cylinder, 0);
    ASSERT_EQ(built.size(), 1u);
    EXPECT_EQ(built[0].kind, Primitive::Kind::solidCylinder);

    cylinder.hollow = true;
    built = buildPrimitives(cylinder, 0);
    ASSERT_EQ(built.size(), 1u);
    EXPECT_EQ(built[0].kind, Primitive::Kind::tube);
    EXPECT_EQ(built[0].height, 0.7);

    cylinder.floor = true;
    built = buildPrimitives(cylinder, 0);
    ASSERT_EQ(built.size(), 2u);
    EXPECT_EQ(built[1].kind, Primitive::Kind::disc);
    EXPECT_EQ(built[1].radius, 0.3);
    // The floor closes the tube: from a point on the axis it is `along` away.
    const Vec3 q = cylinder.point + 0.2 * cylinder.normal;
    EXPECT_NEAR(nearestSurface(built[1], q).distance, 0.2, 1e-15);
    EXPECT_NEAR(nearestSurface(built[0], q).distance, 0.3, 1e-15);
}

TEST(BuildPrimitives, DiscIsADisc)
{
    SolidSpec disc = makeCylinderSpec();
    disc.shape = SolidShape::disc;
    const std::vector<Primitive> built = buildPrimitives(disc, 0);
    ASSERT_EQ(built.size(), 1u);
    EXPECT_EQ(built[0].kind, Primitive::Kind::disc);
    EXPECT_EQ(built[0].axis, disc.normal);
}

TEST(BuildPrimitives, MessagesNameTheSolidAndTheFault)
{
    SolidSpec named = makeBoxSpec();
    named.name = "table";
    named.max.x() = named.min.x();
    EXPECT_NE(messageOf(named).find("solids[4] (\"table\")"), std::string::npos)
        << messageOf(named);

    SolidSpec box = makeBoxSpec();
    box.max.y() = box.min.y();
    EXPECT_NE(messageOf(box).find("min.y"), std::string::npos) << messageOf(box);
    box = makeBoxSpec();
    box.rough = true;
    EXPECT_NE(messageOf(box).find("rough"), std::string::npos) << messageOf(box);

    SolidSpec cylinder = makeCylinderSpec();
    cylinder.radius = 0.0;
    EXPECT_NE(messageOf(cylinder).find("radius"), std::string::npos) << messageOf(cylinder);
    cylinder = makeCylinderSpec();
    cylinder.height = std::nan("");
    EXPECT_NE(messageOf(cylinder).find("height"), std::string::npos) << messageOf(cylinder);
    cylinder = makeCylinderSpec();
    cylinder.normal.setZero();
    EXPECT_NE(messageOf(cylinder).find("axis"), std::string::npos) << messageOf(cylinder);

    SolidSpec plane;
    plane.point.x() = std::numeric_limits<double>::infinity();
    EXPECT_NE(messageOf(plane).find("point"), std::string::npos) << messageOf(plane);
    plane = SolidSpec();
    plane.until = plane.from;
    EXPECT_NE(messageOf(plane).find("until"), std::string::npos) << messageOf(plane);
}

}  // namespace
}  // namespace sandflow::testing
