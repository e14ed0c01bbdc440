#include "core/errors.h"
#include "mesh/check_mesh.h"
#include "mesh/place_mesh.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

/// 2 x 3 x 4, its middle at (0, 3.5, 2.5).
TriangleMesh makeBrick()
{
    return makeBoxMesh({-1.0, 2.0, 0.5}, {1.0, 5.0, 4.5});
}

void expectBounds(const TriangleMesh& mesh, const Vec3& min, const Vec3& max)
{
    EXPECT_NEAR((boundsOf(mesh).min() - min).norm(), 0.0, 1e-12) << boundsOf(mesh).min();
    EXPECT_NEAR((boundsOf(mesh).max() - max).norm(), 0.0, 1e-12) << boundsOf(mesh).max();
}

TEST(PlaceMesh, StandsOnItsPoint)
{
    MeshPlacement placement;
    placement.point = Vec3(10.0, 20.0, 30.0);
    expectBounds(placeMesh(makeBrick(), placement), {9.0, 18.5, 30.0}, {11.0, 21.5, 34.0});
    placement.stand = false;
    expectBounds(placeMesh(makeBrick(), placement), {9.0, 22.0, 30.5}, {11.0, 25.0, 34.5});
}

TEST(PlaceMesh, YUpIsAQuarterTurnAboutX)
{
    MeshPlacement placement;
    placement.yUp = true;
    placement.stand = false;
    // (x, y, z) -> (x, -z, y)
    const TriangleMesh placed = placeMesh(makeBrick(), placement);
    expectBounds(placed, {-1.0, -4.5, 2.0}, {1.0, -0.5, 5.0});
    EXPECT_NEAR(signedVolumeOf(placed), 24.0, 1e-9);
    EXPECT_EQ(placed.points[0], Vec3(-1.0, -0.5, 2.0));
}

TEST(PlaceMesh, FitsHeightOrTheLongerHorizontalExtent)
{
    MeshPlacement placement;
    placement.fitHeight = 1.0;
    placement.scale = 77.0;  // replaced
    EXPECT_DOUBLE_EQ(scaleOf(makeBrick(), placement), 0.25);
    expectBounds(placeMesh(makeBrick(), placement), {-0.25, -0.375, 0.0}, {0.25, 0.375, 1.0});
    placement.yUp = true;
    EXPECT_DOUBLE_EQ(scaleOf(makeBrick(), placement), 1.0 / 3.0);

    placement.fitHeight.reset();
    placement.fitLength = 1.0;
    EXPECT_DOUBLE_EQ(scaleOf(makeBrick(), placement), 0.25);  // x 2, z 4, up y
    placement.yUp = false;
    placement.turnDegrees = 45.0;  // does not change the length
    EXPECT_DOUBLE_EQ(scaleOf(makeBrick(), placement), 1.0 / 3.0);
}

TEST(PlaceMesh, TurnsCounterClockwiseSeenFromAbove)
{
    MeshPlacement placement;
    placement.stand = false;
    for (const double degrees : {90.0, 450.0, -270.0}) {
        placement.turnDegrees = degrees;
        const TriangleMesh placed = placeMesh(makeBrick(), placement);
        // (x, y) -> (-y, x), to the bit
        EXPECT_EQ(boundsOf(placed).min(), Vec3(-5.0, -1.0, 0.5)) << degrees;
        EXPECT_EQ(boundsOf(placed).max(), Vec3(-2.0, 1.0, 4.5)) << degrees;
    }
    placement.turnDegrees = 180.0;
    EXPECT_EQ(boundsOf(placeMesh(makeBrick(), placement)).min(), Vec3(-1.0, -5.0, 0.5));
    placement.turnDegrees = 270.0;
    EXPECT_EQ(boundsOf(placeMesh(makeBrick(), placement)).min(), Vec3(2.0, -1.0, 0.5));
    placement.turnDegrees = 30.0;
    const Vec3 corner = placeMesh(makeBrick(), placement).points[1];  // (1, 2, 0.5)
    EXPECT_NEAR(corner.x(), std::sqrt(0.75) - 1.0, 1e-12);
    EXPECT_NEAR(corner.y(), 0.5 + 2.0 * std::sqrt(0.75), 1e-12);
    EXPECT_EQ(corner.z(), 0.5);
}

TEST(PlaceMesh, OutwardsStaysOutwards)
{
    for (const bool yUp : {false, true}) {
        for (const double turn : {0.0, 33.0, 90.0, 200.0, -71.0}) {
            MeshPlacement placement;
            placement.yUp = yUp;
            placement.turnDegrees = turn;
            placement.scale = 0.1;
            placement.point = Vec3(3.0, -2.0, 1.0);
            const TriangleMesh placed = placeMesh(makeBrick(), placement);
            EXPECT_NEAR(signedVolumeOf(placed), 0.024, 1e-12);
            // The middle of the bottom of its box is at the point, also after turning.
            EXPECT_NEAR(boundsOf(placed).min().z(), 1.0, 1e-12);
            EXPECT_NEAR((boundsOf(placed).center() - placement.point).head<2>().norm(), 0.0, 1e-12);
        }
    }
}

TEST(PlaceMesh, AFlatMeshHasNoHeightToFit)
{
    TriangleMesh flat;
    flat.points = {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
    flat.triangles = {{0, 1, 2}};
    MeshPlacement placement;
    placement.fitHeight = 2.0;
    EXPECT_THROW(scaleOf(flat, placement), InputError);
    placement.fitHeight.reset();
    placement.fitLength = 2.0;
    EXPECT_DOUBLE_EQ(scaleOf(flat, placement), 2.0);
}

TEST(CheckMesh, AGoodMeshRaisesNoDoubt)
{
    TriangleMesh brick = makeBrick();
    const MeshReport report = cleanMesh(brick, "m.ply");
    EXPECT_EQ(checkMeshAgainstGrains(report, 0.1, 0.005), std::vector<std::string>());
}

TEST(CheckMesh, HolesSizesAndDistancesAreNamed)
{
    TriangleMesh brick = makeBrick();
    brick.triangles.erase(brick.triangles.begin());  // half its bottom: 2 x 3
    const MeshReport open = cleanMesh(brick, "m.ply");
    using Doubts = std::vector<std::string>;
    EXPECT_EQ(checkMeshAgainstGrains(open, 0.1, 0.005),
              Doubts({"its surface is open at 3 edges, and the widest hole is 0.361 m across, 72.1 "
                      "grain radii: grains may get in; close it in a modelling program"}));
    // No grain passes a hole narrower than a radius, and 4 units are then 1.1 radii.
    EXPECT_EQ(checkMeshAgainstGrains(open, 0.1, 0.365), Doubts());
    EXPECT_EQ(checkMeshAgainstGrains(open, 0.1, 0.5),
              Doubts({"it is 0.4 m long, 0.8 grain radii: check its scale; files are often in "
                      "millimetres"}));

    TriangleMesh whole = makeBrick();
    const MeshReport closed = cleanMesh(whole, "m.ply");
    EXPECT_EQ(checkMeshAgainstGrains(closed, 1000.0, 0.005),
              Doubts({"it is 4e+03 m long, 8e+05 grain radii: check its scale; files are often in "
                      "millimetres"}));

    TriangleMesh far = makeBoxMesh({1e6, 0.0, 0.0}, {1e6 + 10.0, 10.0, 10.0});
    const MeshReport distant = cleanMesh(far, "m.ply");
    EXPECT_EQ(checkMeshAgainstGrains(distant, 0.1, 0.005),
              Doubts({"in its file it lies 1e+05 times its size from the origin, where single "
                      "precision blurs its shape; move it to the origin in a modelling program"}));
}

TEST(CheckMesh, FacesThatLookOppositeWaysAreNamed)
{
    MeshReport report;
    report.bounds = Eigen::AlignedBox3d(Vec3::Zero(), Vec3::Ones());
    report.boundaryEdges = 4;
    report.unbalancedEdges = 6;
    EXPECT_EQ(checkMeshAgainstGrains(report, 1.0, 0.01),
              std::vector<std::string>(
                  {"2 edges inside its surface have faces that look opposite ways: what is inside "
                   "is uncertain there; repair it in a modelling program"}));
}

}  // namespace
}  // namespace sandflow
