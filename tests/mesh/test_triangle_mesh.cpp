#include "mesh/shapes.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

TEST(TriangleMesh, BoxHasItsAreaVolumeAndNormals)
{
    const TriangleMesh box = makeBoxMesh({1000.0, 2.0, -3.0}, {1001.0, 4.0, 0.0});
    EXPECT_NEAR(areaOf(box), 2.0 * (1 * 2 + 2 * 3 + 3 * 1), 1e-9);
    EXPECT_NEAR(signedVolumeOf(box), 6.0, 1e-9);
    EXPECT_EQ(boundsOf(box).min(), Vec3(1000.0, 2.0, -3.0));
    EXPECT_EQ(boundsOf(box).max(), Vec3(1001.0, 4.0, 0.0));
    const Vec3 middle = boundsOf(box).center();
    const std::vector<Vec3> normals = smoothNormalsOf(box);
    for (std::size_t p = 0; p < box.points.size(); ++p) {
        EXPECT_NEAR(normals[p].norm(), 1.0, 1e-12);
        EXPECT_GT(normals[p].dot(box.points[p] - middle), 0.0) << "inwards at corner " << p;
    }
}

TEST(TriangleMesh, InsideOutHasNegativeVolumeAndAnotherHash)
{
    TriangleMesh box = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    const std::uint64_t hash = contentHashOf(box);
    EXPECT_EQ(hash, contentHashOf(makeBoxMesh(Vec3::Zero(), Vec3::Ones())));
    for (auto& triangle : box.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    EXPECT_NEAR(signedVolumeOf(box), -1.0, 1e-12);
    EXPECT_NE(hash, contentHashOf(box));
}

TEST(TriangleMesh, UnusedPointsDoNotSpoilTheBounds)
{
    TriangleMesh box = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    box.points.push_back(Vec3::Constant(1e6));
    EXPECT_EQ(boundsOf(box).max(), Vec3(Vec3::Ones()));
    EXPECT_TRUE(boundsOf(TriangleMesh{}).isEmpty());
}

}  // namespace
}  // namespace sandflow
