#include "solids/brute_surface.h"
#include "solids/primitive.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

class EveryKind : public ::testing::TestWithParam<Primitive::Kind> {};

INSTANTIATE_TEST_SUITE_P(NearestSurface, EveryKind, ::testing::ValuesIn(allKinds()),
                         [](const auto& instance) { return nameKind(instance.param); });

TEST_P(EveryKind, AgreesWithSearchOverTheSurface)
{
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 40; ++trial) {
        const Primitive primitive = drawPrimitive(random, GetParam());
        for (int k = 0; k < 10; ++k) {
            const Vec3 q = drawPoint(random, 1.5);
            const SurfacePoint found = nearestSurface(primitive, q);
            const double sign = isInside(primitive, q) ? -1.0 : 1.0;
            EXPECT_NEAR(found.distance, sign * searchDistance(primitive, q), 1e-5);
        }
    }
}

TEST_P(EveryKind, NormalIsUnitAndLeadsToTheSurface)
{
    std::mt19937_64 random(12);
    for (int trial = 0; trial < 40; ++trial) {
        const Primitive primitive = drawPrimitive(random, GetParam());
        for (int k = 0; k < 10; ++k) {
            const Vec3 q = drawPoint(random, 1.5);
            const SurfacePoint found = nearestSurface(primitive, q);
            EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
            const Vec3 foot = q - found.distance * found.normal;
            // Exactly on the surface by the function itself, and by the search as well as it can.
            EXPECT_NEAR(nearestSurface(primitive, foot).distance, 0.0, 1e-14);
            EXPECT_LT(searchDistance(primitive, foot), 1e-5);
        }
    }
}

TEST_P(EveryKind, DistanceNeverChangesFasterThanTheWayGone)
{
    std::mt19937_64 random(13);
    for (int trial = 0; trial < 200; ++trial) {
        const Primitive primitive = drawPrimitive(random, GetParam());
        for (int k = 0; k < 100; ++k) {
            const Vec3 a = drawPoint(random, 1.5);
            const double step = std::pow(10.0, drawUniform(random, -9.0, 0.0));
            const Vec3 b = a + step * drawDirection(random);
            const double change =
                nearestSurface(primitive, b).distance - nearestSurface(primitive, a).distance;
            EXPECT_LE(std::abs(change), (b - a).norm() + 1e-14);
        }
    }
}

TEST_P(EveryKind, PointsOnTheSurfaceHaveAFiniteUnitNormal)
{
    std::mt19937_64 random(14);
    for (int trial = 0; trial < 200; ++trial) {
        const Primitive primitive = drawPrimitive(random, GetParam());
        for (const SurfacePatch& patch : surfacePatches(primitive)) {
            // Corners and edges of the patches are corners, edges, rims and plate centres.
            for (const double s : {0.0, 0.5, 1.0}) {
                for (const double t : {0.0, 0.25, 0.6, 1.0}) {
                    const SurfacePoint found = nearestSurface(primitive, patch(s, t));
                    EXPECT_NEAR(found.distance, 0.0, 1e-13);
                    EXPECT_NEAR(found.normal.norm(), 1.0, 1e-13);
                }
            }
        }
    }
}

Primitive makeBox()
{
    Primitive box;
    box.kind = Primitive::Kind::solidBox;
    box.min = Vec3(0.0, 0.0, 0.0);
    box.max = Vec3(1.0, 2.0, 3.0);
    return box;
}

Primitive makeUpright(Primitive::Kind kind)
{
    Primitive primitive;
    primitive.kind = kind;
    primitive.point = Vec3(0.1, 0.2, 0.3);
    primitive.radius = 0.5;
    primitive.height = 2.0;
    return primitive;
}

void expectVector(const Vec3& found, const Vec3& expected)
{
    EXPECT_LT((found - expected).norm(), 1e-14)
        << found.transpose() << " instead of " << expected.transpose();
}

TEST(NearestSurface, BoxFacesEdgesCornersAndInside)
{
    const Primitive box = makeBox();
    SurfacePoint found = nearestSurface(box, Vec3(0.4, 1.0, 3.25));
    EXPECT_DOUBLE_EQ(found.distance, 0.25);
    expectVector(found.normal, Vec3::UnitZ());

    found = nearestSurface(box, Vec3(1.3, 1.0, 3.4));
    EXPECT_DOUBLE_EQ(found.distance, 0.5);
    expectVector(found.normal, Vec3(0.6, 0.0, 0.8));

    found = nearestSurface(box, Vec3(-1.0, -2.0, -2.0));
    EXPECT_DOUBLE_EQ(found.distance, 3.0);
    expectVector(found.normal, Vec3(-1.0, -2.0, -2.0) / 3.0);

    found = nearestSurface(box, Vec3(0.5, 1.9, 1.0));
    EXPECT_NEAR(found.distance, -0.1, 1e-15);
    expectVector(found.normal, Vec3::UnitY());

    found = nearestSurface(box, Vec3(0.0, 1.0, 1.0));
    EXPECT_EQ(found.distance, 0.0);
    expectVector(found.normal, -Vec3::UnitX());
}

TEST(NearestSurface, OnAThinPlateTheNormalIsItsAxis)
{
    Primitive panel;
    panel.kind = Primitive::Kind::panel;
    panel.min = Vec3(0.0, 0.5, 0.0);
    panel.max = Vec3(1.0, 0.5, 1.0);
    SurfacePoint found = nearestSurface(panel, Vec3(0.3, 0.5, 0.4));
    EXPECT_EQ(found.distance, 0.0);
    expectVector(found.normal, Vec3::UnitY());

    Primitive disc = makeUpright(Primitive::Kind::disc);
    found = nearestSurface(disc, disc.point + Vec3(0.1, 0.1, 0.0));
    EXPECT_EQ(found.distance, 0.0);
    expectVector(found.normal, Vec3::UnitZ());
    found = nearestSurface(disc, disc.point + Vec3(0.1, 0.1, -0.2));
    EXPECT_NEAR(found.distance, 0.2, 1e-15);
    expectVector(found.normal, -Vec3::UnitZ());
}

TEST(NearestSurface, ThinPlatesPushBackOnBothSidesHoweverNear)
{
    Primitive panel;
    panel.kind = Primitive::Kind::panel;
    panel.min = Vec3(-1.0, -1.0, 0.0);
    panel.max = Vec3(1.0, 1.0, 0.0);
    Primitive disc;
    disc.kind = Primitive::Kind::disc;
    disc.radius = 1.0;
    // 1e-200 squared underflows: still no NaN.
    for (const double z : {1e-3, 1e-12, 1e-100, 1e-200}) {
        for (const Primitive& plate : {panel, disc}) {
            const SurfacePoint above = nearestSurface(plate, Vec3(0.2, 0.3, z));
            const SurfacePoint below = nearestSurface(plate, Vec3(0.2, 0.3, -z));
            expectVector(above.normal, Vec3::UnitZ());
            EXPECT_NEAR(below.normal.norm(), 1.0, 1e-14);
            EXPECT_NEAR(below.distance, z, 1e-15);
            if (z > 1e-150) {
                expectVector(below.normal, -Vec3::UnitZ());
            }
        }
    }
}

TEST(NearestSurface, RimsOfDiscAndTube)
{
    const Primitive disc = makeUpright(Primitive::Kind::disc);
    SurfacePoint found = nearestSurface(disc, disc.point + Vec3(0.8, 0.0, 0.4));
    EXPECT_NEAR(found.distance, 0.5, 1e-15);
    expectVector(found.normal, Vec3(0.6, 0.0, 0.8));

    const Primitive tube = makeUpright(Primitive::Kind::tube);
    found = nearestSurface(tube, tube.point + Vec3(0.0, 0.2, 2.4));  // inside, above the rim
    EXPECT_NEAR(found.distance, 0.5, 1e-15);
    expectVector(found.normal, Vec3(0.0, -0.6, 0.8));
    found = nearestSurface(tube, tube.point + Vec3(0.0, 0.2, 1.0));
    EXPECT_NEAR(found.distance, 0.3, 1e-15);
    expectVector(found.normal, -Vec3::UnitY());
    found = nearestSurface(tube, tube.point + Vec3(-0.75, 0.0, 1.0));
    EXPECT_NEAR(found.distance, 0.25, 1e-15);
    expectVector(found.normal, -Vec3::UnitX());
}

TEST(NearestSurface, OnTheAxisAnyNormalWillDoButOneThatIsRight)
{
    std::mt19937_64 random(15);
    for (int trial = 0; trial < 500; ++trial) {
        Primitive tube = drawPrimitive(random, Primitive::Kind::tube);
        const Vec3 q = tube.point + drawUniform(random, 0.0, 1.0) * tube.height * tube.axis;
        SurfacePoint found = nearestSurface(tube, q);
        EXPECT_NEAR(found.distance, tube.radius, 1e-14);
        EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
        EXPECT_NEAR(found.normal.dot(tube.axis), 0.0, 1e-12);

        Primitive cylinder = tube;
        cylinder.kind = Primitive::Kind::solidCylinder;
        found = nearestSurface(cylinder, q);
        EXPECT_LE(found.distance, 1e-14);
        EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
        EXPECT_LT(searchDistance(cylinder, q - found.distance * found.normal), 1e-5);
    }
}

TEST(NearestSurface, CylinderInsideLeavesByTheNearestOfSideAndCaps)
{
    const Primitive cylinder = makeUpright(Primitive::Kind::solidCylinder);
    SurfacePoint found = nearestSurface(cylinder, cylinder.point + Vec3(0.0, 0.4, 1.0));
    EXPECT_NEAR(found.distance, -0.1, 1e-15);
    expectVector(found.normal, Vec3::UnitY());
    found = nearestSurface(cylinder, cylinder.point + Vec3(0.0, 0.1, 1.95));
    EXPECT_NEAR(found.distance, -0.05, 1e-14);
    expectVector(found.normal, Vec3::UnitZ());
    found = nearestSurface(cylinder, cylinder.point + Vec3(0.0, 0.1, 0.05));
    EXPECT_NEAR(found.distance, -0.05, 1e-14);
    expectVector(found.normal, -Vec3::UnitZ());
}

TEST(NearestSurface, FarPlaneKeepsItsPrecision)
{
    Primitive plane;
    plane.axis = Vec3(0.6, 0.0, 0.8);
    plane.point = Vec3(1e4, -1e4, 2e3);
    // A foot point 50 km along the plane, 5 mm above it.
    const Vec3 q = plane.point + 5e4 * Vec3(0.8, 0.0, -0.6) + 0.005 * plane.axis;
    const SurfacePoint found = nearestSurface(plane, q);
    EXPECT_NEAR(found.distance, 0.005, 1e-10);
    expectVector(found.normal, plane.axis);
}

}  // namespace
}  // namespace sandflow::testing
