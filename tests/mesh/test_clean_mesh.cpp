#include "mesh/drop_faces.h"
#include "mesh/mesh_orientation.h"
#include "mesh/split_polygon.h"
#include "mesh_files.h"

#include <ctime>
#include <limits>
#include <random>

namespace sandflow {
namespace {

using Sentences = std::vector<std::string>;

LoadedMesh clean(TriangleMesh mesh)
{
    LoadedMesh loaded;
    loaded.mesh = std::move(mesh);
    loaded.report = cleanMesh(loaded.mesh, "m.ply");
    return loaded;
}

void turnAll(TriangleMesh& mesh)
{
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
}

void append(TriangleMesh& mesh, const TriangleMesh& more)
{
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
    for (const auto& t : more.triangles) {
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
}

TriangleMesh makeCube(double halfEdge, const Vec3& centre = Vec3::Zero())
{
    return makeBoxMesh(centre - Vec3::Constant(halfEdge), centre + Vec3::Constant(halfEdge));
}

TEST(CleanMesh, ACleanMeshStaysAsItIs)
{
    const LoadedMesh loaded = clean(makeTestBox());
    expectBox(loaded, "box");
    EXPECT_EQ(contentHashOf(loaded.mesh), contentHashOf(makeTestBox()));
    EXPECT_EQ(loaded.report.repairs, Sentences());
}

TEST(CleanMesh, PointsThatLieOnOthersAreWelded)
{
    TriangleMesh box = makeTestBox();
    // One corner of the box a second time, a little off, for some of its triangles.
    box.points.push_back(box.points[0] + Vec3(2e-6, -2e-6, 0.0));
    box.triangles[0][0] = 8;
    box.triangles[4][0] = 8;
    const LoadedMesh loaded = clean(box);
    expectBox(loaded, "welded");
    EXPECT_EQ(loaded.report.repairs, Sentences({"welded 1 points that lie on others"}));
    // Points farther apart than 1e-6 of the size are different points.
    box.points.back() = box.points[0] + Vec3(2e-5, 0.0, 0.0);
    EXPECT_EQ(clean(box).report.points, 9u);
}

/// Against a search among all pairs.
TEST(CleanMesh, WeldingMissesNoPair)
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(0.0, 1.0);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 900; ++i) {
        // Clusters of points about as far apart as the tolerance, at the corners of a box.
        const Vec3 corner(i % 2, i / 2 % 2, i / 4 % 2);
        mesh.points.push_back(corner + 3e-6 * Vec3(place(random), place(random), place(random)));
        if (i % 3 == 2) {
            mesh.triangles.push_back({i - 2, i - 1, i});
        }
    }
    const double tolerance = 1e-6 * boundsOf(mesh).diagonal().norm();
    const std::vector<Vec3> points = clean(mesh).mesh.points;
    EXPECT_GT(points.size(), 20u);  // several are left of every cluster
    EXPECT_LT(points.size(), 800u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_GT((points[i] - points[k]).norm(), tolerance);
        }
    }
}

TEST(CleanMesh, FacesThatAddNothingAreDropped)
{
    TriangleMesh box = makeTestBox();
    box.triangles.push_back({3, 3, 5});
    box.triangles.push_back(box.triangles[2]);
    box.triangles.push_back({box.triangles[4][1], box.triangles[4][2], box.triangles[4][0]});
    box.points.push_back(0.5 * (box.points[0] + box.points[1]));
    box.triangles.push_back({0, 8, 1});
    box.points.push_back(Vec3::Constant(1e6));
    const LoadedMesh loaded = clean(box);
    expectBox(loaded, "cleaned");
    EXPECT_EQ(loaded.report.repairs,
              Sentences({"dropped 1 points that no face uses",
                         "dropped 1 faces with the same point at two corners",
                         "dropped 2 faces that are there twice", "dropped 1 faces without area"}));
}

/// A triangle without area between a long edge and two short ones keeps the surface closed.
TEST(CleanMesh, FlatFacesThatCloseTheSurfaceStay)
{
    TriangleMesh box = makeTestBox();
    const auto [a, b, c] = box.triangles[0];
    box.points.push_back(0.5 * (box.points[a] + box.points[b]));
    // The side a-b is split on one side of the edge only.
    box.triangles[0] = {a, 8, c};
    box.triangles.push_back({8, b, c});
    box.triangles.push_back({a, b, 8});
    const LoadedMesh loaded = clean(box);
    EXPECT_EQ(loaded.report.triangles, 14u);
    EXPECT_EQ(loaded.report.unbalancedEdges, 0u);
    EXPECT_NEAR(loaded.report.signedVolume, kBoxVolume, 1e-9);
    EXPECT_EQ(loaded.report.repairs, Sentences());
}

/// Two-sided exports hold every face once each way round: the winding number is 0 everywhere.
TEST(CleanMesh, BackFacesAreDropped)
{
    TriangleMesh box = makeTestBox();
    TriangleMesh back = box;
    turnAll(back);
    box.triangles.insert(box.triangles.begin() + 5, back.triangles.begin(), back.triangles.end());
    const LoadedMesh loaded = clean(box);
    expectBox(loaded, "two-sided");
    ASSERT_FALSE(loaded.report.repairs.empty());
    EXPECT_EQ(loaded.report.repairs[0],
              "dropped 12 back faces: every face is there once each way round, so nothing would be "
              "inside");
}

TEST(CleanMesh, FacesThatLookTheOtherWayAreTurned)
{
    TriangleMesh box = makeTestBox();
    for (const std::size_t t : {1u, 4u, 7u}) {
        std::swap(box.triangles[t][0], box.triangles[t][1]);
    }
    const LoadedMesh loaded = clean(box);
    expectBox(loaded, "aligned");
    EXPECT_EQ(loaded.report.repairs,
              Sentences({"turned round 3 faces that look the other way than their neighbours"}));
}

TEST(CleanMesh, AMoebiusStripIsLeftAndReported)
{
    TriangleMesh strip;
    constexpr std::uint32_t kCount = 24;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double angle = 2.0 * kPi * i / kCount;
        const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 across = std::cos(angle / 2) * out + std::sin(angle / 2) * Vec3::UnitZ();
        strip.points.push_back(3.0 * out - across);
        strip.points.push_back(3.0 * out + across);
        const std::uint32_t a = 2 * i;
        const bool last = i + 1 == kCount;
        const std::uint32_t c = last ? 1 : a + 2;  // half a turn: the sides change places
        const std::uint32_t d = last ? 0 : a + 3;
        strip.triangles.push_back({a, c, a + 1});
        strip.triangles.push_back({a + 1, c, d});
    }
    const LoadedMesh loaded = clean(strip);
    EXPECT_EQ(loaded.report.boundaryEdges, 2 * kCount);
    EXPECT_EQ(loaded.report.unbalancedEdges, 2 * kCount + 1);
    EXPECT_EQ(loaded.report.repairs, Sentences());
}

TEST(CleanMesh, AnInsideOutComponentIsTurned)
{
    TriangleMesh two = makeCube(1.0);
    TriangleMesh other = makeCube(1.0, Vec3(5.0, 0.0, 0.0));
    turnAll(other);
    append(two, other);
    const LoadedMesh loaded = clean(two);
    EXPECT_NEAR(loaded.report.signedVolume, 16.0, 1e-9);
    EXPECT_EQ(loaded.report.components, 2u);
    EXPECT_EQ(loaded.report.repairs, Sentences({"turned round 1 components that were inside out"}));
}

TEST(CleanMesh, ACavityStaysACavity)
{
    TriangleMesh hollow = makeCube(2.0);
    TriangleMesh cavity = makeCube(1.0);
    turnAll(cavity);
    append(hollow, cavity);
    append(hollow, makeCube(0.5));  // a clapper in it
    const LoadedMesh loaded = clean(hollow);
    EXPECT_NEAR(loaded.report.signedVolume, 64.0 - 8.0 + 1.0, 1e-9);
    EXPECT_EQ(loaded.report.repairs, Sentences());

    // The same, mirrored as a whole: all three are turned.
    turnAll(hollow);
    const LoadedMesh mirrored = clean(hollow);
    EXPECT_NEAR(mirrored.report.signedVolume, 64.0 - 8.0 + 1.0, 1e-9);
    EXPECT_EQ(mirrored.report.repairs,
              Sentences({"turned round 3 components that were inside out"}));
}

TEST(CleanMesh, HolesAreMeasured)
{
    TriangleMesh box = makeBoxMesh(Vec3::Zero(), Vec3(3.0, 4.0, 12.0));
    box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 4);  // its top
    const LoadedMesh open = clean(box);
    EXPECT_EQ(open.report.boundaryEdges, 4u);
    EXPECT_EQ(open.report.unbalancedEdges, 4u);
    EXPECT_EQ(open.report.nonManifoldEdges, 0u);
    EXPECT_NEAR(open.report.largestHole, 5.0, 1e-12);

    // A fin on an edge makes that edge non-manifold, and has a rim of its own.
    TriangleMesh fin = makeTestBox();
    fin.points.push_back(fin.points[0] - Vec3(1.0, 1.0, 0.0));
    fin.triangles.push_back({0, 1, 8});
    const LoadedMesh finned = clean(fin);
    EXPECT_EQ(finned.report.nonManifoldEdges, 1u);
    EXPECT_EQ(finned.report.boundaryEdges, 2u);
    EXPECT_EQ(finned.report.unbalancedEdges, 3u);
}

/// Nothing may be lost because a file is in other units or far from the origin.
TEST(CleanMesh, SizeAndPlaceDoNotMatter)
{
    for (const double size : {1e-20, 1e-6, 1.0, 1e6, 1e20}) {
        const LoadedMesh loaded = clean(makeCube(size, Vec3(100.0 * size, 0.0, 0.0)));
        EXPECT_EQ(loaded.report.triangles, 12u) << size;
        EXPECT_NEAR(loaded.report.signedVolume / (size * size * size), 8.0, 1e-9) << size;
    }
}

TEST(CleanMesh, RefusesWhatHasNoSurface)
{
    const auto refusal = [](TriangleMesh mesh) {
        try {
            cleanMesh(mesh, "m.ply");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    TriangleMesh point;
    point.points = {Vec3::Ones(), Vec3::Ones(), Vec3::Ones()};
    point.triangles = {{0, 1, 2}};
    EXPECT_EQ(refusal(point), "m.ply: all its 1 triangles together span 0 units; export a surface");
    TriangleMesh line;
    line.points = {Vec3::Zero(), Vec3::UnitX(), 2.0 * Vec3::UnitX()};
    line.triangles = {{0, 1, 2}};
    EXPECT_EQ(refusal(line), "m.ply: no face with an area is left of it; export a surface");
    TriangleMesh box = makeTestBox();
    box.points[3].y() = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(box), "m.ply: vertex 3 is not finite; repair the file");
}

double secondsToClean(const TriangleMesh& mesh, LoadedMesh& loaded)
{
    const std::clock_t start = std::clock();
    loaded = clean(mesh);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(CleanMesh, ThousandsOfComponentsTakeNoLongerThanOthers)
{
    TriangleMesh nested;
    TriangleMesh heap;
    for (int i = 0; i < 16000; ++i) {
        TriangleMesh box = makeCube(1.0 + 0.001 * i);
        turnAll(box);
        append(nested, box);
        box = makeCube(1.0, Vec3(3.0 * (i % 100), 3.0 * i, 0.0));
        turnAll(box);
        append(heap, box);
    }
    LoadedMesh loaded;
    EXPECT_LT(secondsToClean(nested, loaded), kLongestLoad);
    EXPECT_EQ(loaded.report.repairs,
              Sentences({"turned round 16000 components that were inside out"}));
    // Here each would have to be compared with each, twice.
    EXPECT_LT(secondsToClean(heap, loaded), kLongestLoad);
    EXPECT_EQ(loaded.report.components, 16000u);
    EXPECT_EQ(loaded.report.repairs,
              Sentences({"did not look for components that are inside out, because there are too "
                         "many"}));
}

double areaOfSplit(const std::vector<Vec3>& corners,
                   const std::vector<std::array<std::uint32_t, 3>>& triangles)
{
    return areaOf({corners, triangles});
}

/// Star-shaped polygons with random radii: concave, never crossing themselves.
TEST(SplitPolygon, CoversConcavePolygonsOnce)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int trial = 0; trial < 2000; ++trial) {
        const std::size_t count = 4 + random() % 40;
        const Eigen::Quaterniond turn(
            Eigen::Vector4d(unit(random), unit(random), unit(random), unit(random) + 0.1)
                .normalized());
        std::vector<Vec3> corners;
        double area = 0.0;
        double last = 0.0;
        std::vector<double> radii;
        for (std::size_t k = 0; k < count; ++k) {
            radii.push_back(0.2 + unit(random));
            const double angle = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(count);
            corners.push_back(turn * (radii.back() * Vec3(std::cos(angle), std::sin(angle), 0.0)));
        }
        for (std::size_t k = 0; k < count; ++k) {
            last = radii[(k + 1) % count];
            area += 0.5 * radii[k] * last * std::sin(2.0 * kPi / static_cast<double>(count));
        }
        std::vector<std::array<std::uint32_t, 3>> triangles;
        ASSERT_TRUE(splitPolygon(corners, triangles)) << trial;
        ASSERT_EQ(triangles.size(), count - 2);
        ASSERT_NEAR(areaOfSplit(corners, triangles), area, 1e-9) << trial;
    }
}

TEST(SplitPolygon, CopesWithCornersOnEdgesAndBridges)
{
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // A corner in the middle of an edge.
    const std::vector<Vec3> midpoint = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
    ASSERT_TRUE(splitPolygon(midpoint, triangles));
    EXPECT_NEAR(areaOfSplit(midpoint, triangles), 2.0, 1e-12);
    // A square with a square hole, joined by a bridge that is passed both ways.
    const std::vector<Vec3> bridged = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 4, 0), Vec3(0, 4, 0),
                                       Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 3, 0), Vec3(3, 3, 0),
                                       Vec3(3, 1, 0), Vec3(1, 1, 0)};
    ASSERT_TRUE(splitPolygon(bridged, triangles));
    EXPECT_NEAR(areaOfSplit(bridged, triangles), 12.0, 1e-12);
    // All corners on a line: no area, but no defect either.
    const std::vector<Vec3> line = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)};
    EXPECT_TRUE(splitPolygon(line, triangles));
    EXPECT_EQ(triangles.size(), 2u);
    // Bows cross themselves, with equal lobes or not.
    EXPECT_FALSE(splitPolygon(
        std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, triangles));
    EXPECT_FALSE(splitPolygon(
        std::vector<Vec3>{Vec3(0, 0, 0), Vec3(3, 1, 0), Vec3(3, 0, 0), Vec3(0, 4, 0)}, triangles));
}

}  // namespace
}  // namespace sandflow
