#include "core/errors.h"
#include "io/pov_mesh.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace sandflow {
namespace {

/// A sphere of `rows` rows of triangles, poles up and down.
TriangleMesh makeSphereMesh(double radius, std::uint32_t rows)
{
    TriangleMesh mesh;
    const std::uint32_t columns = 2 * rows;
    for (std::uint32_t i = 0; i <= rows; ++i) {
        for (std::uint32_t k = 0; k < columns; ++k) {
            const double theta = kPi * i / rows;
            const double phi = 2.0 * kPi * k / columns;
            const double out = i % rows == 0 ? 0.0 : radius * std::sin(theta);
            mesh.points.push_back(
                Vec3(out * std::cos(phi), out * std::sin(phi), radius * std::cos(theta)));
        }
    }
    for (std::uint32_t i = 0; i < rows; ++i) {
        for (std::uint32_t k = 0; k < columns; ++k) {
            const std::uint32_t next = (k + 1) % columns;
            const std::uint32_t a = i * columns + k;
            const std::uint32_t b = i * columns + next;
            mesh.triangles.push_back({a, a + columns, b + columns});
            mesh.triangles.push_back({a, b + columns, b});
        }
    }
    return mesh;
}

TEST(ShadeMesh, keepsTheEdgesOfABox)
{
    const ShadedMesh shaded = shadeMesh(makeBoxMesh(Vec3::Zero(), Vec3(1.0, 20.0, 3.0)));
    EXPECT_EQ(shaded.points.size(), 24u);
    ASSERT_EQ(shaded.triangles.size(), 12u);
    for (const auto& triangle : shaded.triangles) {
        const Vec3& a = shaded.points[triangle[0]];
        const Vec3 flat = (shaded.points[triangle[1]] - a)
                              .cross(shaded.points[triangle[2]] - a)
                              .normalized();
        for (const std::uint32_t corner : triangle) {
            EXPECT_LT((shaded.normals[corner] - flat).norm(), 1e-12);
        }
    }
}

TEST(ShadeMesh, roundsWhatIsRound)
{
    const TriangleMesh sphere = makeSphereMesh(2.0, 16);
    const ShadedMesh shaded = shadeMesh(sphere);
    // Every point once. In the two rows at the poles half of the triangles have no area.
    EXPECT_EQ(shaded.points.size(), sphere.points.size());
    EXPECT_EQ(shaded.triangles.size(), sphere.triangles.size() - 2 * 32);
    for (std::size_t i = 0; i < shaded.points.size(); ++i) {
        EXPECT_GT(shaded.normals[i].dot(shaded.points[i].normalized()), std::cos(8.0 * kPi / 180.0))
            << i;
    }
    // Where nothing is split they are the area-weighted normals of the mesh.
    const std::vector<Vec3> smooth = smoothNormalsOf(sphere);
    for (std::size_t i = 64; i < 400; ++i) {
        EXPECT_LT((shaded.normals[i] - smooth[i]).norm(), 1e-12) << i;
    }
}

TEST(ShadeMesh, roundsTheCornerThatIsBelowTheCreaseAngle)
{
    // A roof whose halves meet at 40, then at 60 degrees.
    for (const double fold : {40.0, 60.0}) {
        TriangleMesh roof;
        const double slope = std::tan(0.5 * fold * kPi / 180.0);
        roof.points = {Vec3(0.0, -1.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(1.0, 0.0, -slope),
                       Vec3(-1.0, 0.0, -slope)};
        roof.triangles = {{0, 2, 1}, {1, 3, 0}};
        EXPECT_EQ(shadeMesh(roof).points.size(), fold < 50.0 ? 4u : 6u) << fold;
    }
}

TEST(ShadeMesh, survivesWhatHasNoArea)
{
    TriangleMesh mesh = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    mesh.points.push_back(Vec3(1e300, 1e300, 1e300));      // used by nobody
    mesh.triangles.push_back({0, 0, 1});                   // a line
    mesh.points.push_back(Vec3(0.5, 0.0, 0.0));            // on the edge from point 0 to point 1
    mesh.triangles.push_back({0, 1, 9});
    mesh.points.push_back(Vec3(1e-200, 0.0, 0.0));
    mesh.points.push_back(Vec3(0.0, 1e-200, 0.0));
    mesh.triangles.push_back({0, 10, 11});                 // its area underflows
    const ShadedMesh shaded = shadeMesh(mesh);
    EXPECT_EQ(shaded.triangles.size(), 12u);
    EXPECT_EQ(shaded.points.size(), 24u);
    EXPECT_EQ(formatPovMesh("M", mesh, 0.1).find("nan"), std::string::npos);
    // Two sides of a sheet have opposite normals, which cancel; each keeps its own.
    TriangleMesh sheet;
    sheet.points = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
    EXPECT_EQ(shadeMesh(sheet).points.size(), 6u);
}

TEST(ShadeMesh, managesAFanOfManyTriangles)
{
    TriangleMesh cone;  // steep: no triangle is within the crease angle of the hub's mean
    cone.points.push_back(Vec3(0.0, 0.0, 5.0));
    constexpr std::uint32_t n = 50'000;
    for (std::uint32_t k = 0; k < n; ++k) {
        const double phi = 2.0 * kPi * k / n;
        cone.points.push_back(Vec3(std::cos(phi), std::sin(phi), 0.0));
        cone.triangles.push_back({0, k + 1, (k + 1) % n + 1});
    }
    const ShadedMesh shaded = shadeMesh(cone);
    EXPECT_EQ(shaded.triangles.size(), n);
    for (const Vec3& normal : shaded.normals) {
        EXPECT_NEAR(normal.z(), 1.0 / std::sqrt(26.0), 1e-3);
    }
}

TEST(PovMesh, writesPointsInMeanRadiiAndPovRayAxes)
{
    TriangleMesh mesh;
    mesh.points = {Vec3(0.1, 0.2, 0.3), Vec3(1.1, 0.2, 0.3), Vec3(0.1, 1.2, 0.30001234)};
    mesh.triangles = {{0, 1, 2}};
    EXPECT_EQ(formatPovMesh("Solid4", mesh, 0.1),
              "// 1 triangles, lengths in mean grain radii\n"
              "#declare Solid4 = mesh2{\n"
              "vertex_vectors{3,\n<1,3,2>,\n<11,3,2>,\n<1,3.0001,12>}\n"
              "normal_vectors{3,\n<0,1,0>,\n<0,1,0>,\n<0,1,0>}\n"
              "face_indices{1,\n<0,1,2>}\n"
              "}\n");
}

TEST(PovMesh, refusesWhatCannotBeDrawn)
{
    TriangleMesh mesh = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    EXPECT_THROW(formatPovMesh("M", mesh, 1e-13), InternalError);
    mesh.points[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(formatPovMesh("M", mesh, 1.0), InternalError);
    mesh.triangles = {{0, 1, 8}};
    EXPECT_THROW(formatPovMesh("M", mesh, 1.0), InternalError);
    EXPECT_THROW(formatPovMesh("M", TriangleMesh(), 1.0), InternalError);
}

TEST(PovMesh, writesALargeMeshFast)
{
    const TriangleMesh sphere = makeSphereMesh(1.0, 224);  // 200,704 triangles
    ASSERT_GT(sphere.triangles.size(), 200'000u);
    const auto begin = std::chrono::steady_clock::now();
    const std::string text = formatPovMesh("M", sphere, 0.005);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_GT(text.size(), 5'000'000u);
    // 0.2 s in a Release build on an idle core; sanitizers and busy machines are slower.
    EXPECT_LT(seconds, 20.0);
    RecordProperty("milliseconds", static_cast<int>(1e3 * seconds));
}

}  // namespace
}  // namespace sandflow
