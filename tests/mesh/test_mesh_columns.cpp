#include "mesh/mesh_columns.h"

#include "core/errors.h"
#include "mesh/line_checks.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace sandflow::testing {
namespace {

constexpr double kThin = 0.0025;  // half of a grain of 5 mm

/// Whether a point is in the true solid; none within the width of a facet of its surface.
using InsideTest = std::function<std::optional<bool>(const Vec3&)>;

struct NamedSolid {
    const char* name;
    TriangleMesh mesh;
    double volume;  ///< m3, of the solid: what shells share counts once
    InsideTest isInside;
};

/// By a distance from the surface, positive inside, known to `facet`.
InsideTest byDepth(const std::function<double(const Vec3&)>& depth, double facet)
{
    return [=](const Vec3& p) -> std::optional<bool> {
        const double d = depth(p);
        return std::abs(d) <= facet ? std::nullopt : std::optional(d > 0.0);
    };
}

bool isInBox(const Vec3& p, const Vec3& min, const Vec3& max)
{
    return (p - min).minCoeff() >= 0.0 && (max - p).minCoeff() >= 0.0;
}

/// How far the facets of a mesh inscribed in a sphere about the origin lie below it, m.
double facetDepth(const TriangleMesh& mesh, double radius)
{
    double nearest = radius;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3& a = mesh.points[i];
        const Vec3 normal = (mesh.points[j] - a).cross(mesh.points[k] - a).normalized();
        nearest = std::min(nearest, normal.dot(a));
    }
    return radius - nearest;
}

constexpr double kRing = 0.3;
constexpr double kTube = 0.1;
constexpr int kSteps = 256;
constexpr int kSides = 128;

/// Facets of the torus below: those along the ring and those around the tube.
double torusFacet()
{
    return (kRing + kTube) * (1.0 - std::cos(kPi / kSteps)) +
           kTube * (1.0 - std::cos(kPi / kSides));
}

Vec3 standUp(const Vec3& p)
{
    return {p.x(), -p.z(), p.y()};
}

Vec3 layDown(const Vec3& p)
{
    return {p.x(), p.z(), -p.y()};
}

double torusDepth(const Vec3& p)
{
    return kTube - std::hypot(std::hypot(p.x(), p.y()) - kRing, p.z());
}

constexpr double kArchInner = 0.3;
constexpr double kArchOuter = 0.45;
constexpr int kArchSides = 400;

TriangleMesh makeArch()
{
    std::vector<Vec2> upper, lower;
    for (int k = 0; k <= kArchSides; ++k) {
        const double angle = kPi * k / kArchSides;
        const Vec2 along(-std::cos(angle), std::sin(angle));
        upper.push_back(kArchOuter * along);
        lower.push_back(kArchInner * along);
    }
    return makeDrawnMesh(upper, lower, -0.2, 0.3);
}

const Vec3 kTableMin(-0.4, -0.4, 0.0);
const Vec3 kTableMax(0.4, 0.4, 0.45);

/// Top 0.4..0.45 m high with a hole of 0.2 m, on a leg at either end.
bool isInTable(const Vec3& p)
{
    const bool inHole = std::abs(p.x()) < 0.1 && std::abs(p.y()) < 0.1;
    const bool inTop = isInBox(p, {-0.4, -0.4, 0.4}, kTableMax) && !inHole;
    return inTop || (isInBox(p, kTableMin, {0.4, 0.4, 0.4}) && std::abs(p.x()) > 0.3);
}

TriangleMesh makeTable()
{
    return makeBlocksMesh({-0.4, -0.3, -0.1, 0.1, 0.3, 0.4}, {-0.4, -0.1, 0.1, 0.4},
                          {0.0, 0.4, 0.45}, [](int i, int j, int k) {
                              return k == 0 ? i == 0 || i == 4 : i != 2 || j != 1;
                          });
}

std::vector<NamedSolid> makeSolids()
{
    std::vector<NamedSolid> solids;
    const auto add = [&](const char* name, TriangleMesh mesh, InsideTest isInside) {
        const double volume = signedVolumeOf(mesh);
        solids.push_back({name, std::move(mesh), volume, std::move(isInside)});
    };
    const auto exactly = [](const std::function<bool(const Vec3&)>& isInside) {
        return [=](const Vec3& p) { return std::optional(isInside(p)); };
    };
    const TriangleMesh sphere = makeIcosphereMesh(Vec3::Zero(), 0.5, 4);
    const TriangleMesh small = makeIcosphereMesh(Vec3::Zero(), 0.3, 4);
    const double facet = facetDepth(sphere, 0.5);
    const auto inSphere = byDepth([](const Vec3& p) { return 0.5 - p.norm(); }, facet);

    add("box", makeBoxMesh({0.1, 0.2, -0.4}, {0.6, 0.3, 0.5}),
        exactly([](const Vec3& p) { return isInBox(p, {0.1, 0.2, -0.4}, {0.6, 0.3, 0.5}); }));
    add("sphere", sphere, inSphere);
    const TriangleMesh torus = makeTorusMesh(kRing, kTube, kSteps, kSides);
    add("torus lying", torus, byDepth(torusDepth, torusFacet()));
    add("torus standing", mapped(torus, standUp),
        byDepth([](const Vec3& p) { return torusDepth(layDown(p)); }, torusFacet()));
    add("cavity", joined(sphere, turnedInsideOut(small)),
        byDepth([](const Vec3& p) { return std::min(0.5 - p.norm(), p.norm() - 0.3); }, facet));
    add("table", makeTable(), exactly(isInTable));
    add("bridge",
        makeBlocksMesh({0.0, 0.1, 0.7, 0.8}, {0.0, 0.2}, {0.0, 0.3, 0.4},
                       [](int i, int, int k) { return k == 1 || i != 1; }),
        exactly([](const Vec3& p) {
            return isInBox(p, Vec3::Zero(), {0.8, 0.2, 0.4}) &&
                   !isInBox(p, {0.1, 0.0, 0.0}, {0.7, 0.2, 0.3});
        }));
    add("arch", makeArch(), byDepth([](const Vec3& p) {
            const double radius = std::hypot(p.x(), p.z());
            return std::min({kArchOuter - radius, radius - kArchInner, p.z(), p.y() + 0.2,
                             0.3 - p.y()});
        }, kArchOuter * (1.0 - std::cos(0.5 * kPi / kArchSides)) + 1e-9));
    add("closed box",
        makeBlocksMesh({0.0, 0.1, 0.7, 0.8}, {0.0, 0.1, 0.7, 0.8}, {0.0, 0.1, 0.3, 0.4},
                       [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; }),
        exactly([](const Vec3& p) {
            return isInBox(p, Vec3::Zero(), {0.8, 0.8, 0.4}) &&
                   !isInBox(p, {0.1, 0.1, 0.1}, {0.7, 0.7, 0.3});
        }));
    add("inside out", turnedInsideOut(sphere), inSphere);
    solids.back().volume = signedVolumeOf(sphere);
    add("nested shells", joined(sphere, small), inSphere);
    solids.back().volume = signedVolumeOf(sphere);
    add("overlapping boxes",
        joined(makeBoxMesh(Vec3::Zero(), Vec3::Ones()),
               makeBoxMesh({0.5, 0.0, 0.25}, {2.0, 1.0, 0.5})),
        exactly([](const Vec3& p) {
            return isInBox(p, Vec3::Zero(), Vec3::Ones()) ||
                   isInBox(p, {0.5, 0.0, 0.25}, {2.0, 1.0, 0.5});
        }));
    solids.back().volume = 1.25;
    // Its upper side dips through its lower one: winding 1 to the left, -1 to the right.
    add("folded bar",
        makeDrawnMesh({{-1.0, 0.5}, {1.0, -0.5}}, {{-1.0, 0.0}, {1.0, 0.0}}, 0.0, 1.0),
        byDepth([](const Vec3& p) {
            const double other = -0.5 * p.x() - p.z();
            const double depth = std::min(std::abs(p.z()), std::abs(other));
            return std::min({p.z() * other > 0.0 ? depth : -depth, p.y(), 1.0 - p.y(),
                             1.0 - std::abs(p.x())});
        }, 1e-7));
    solids.back().volume = 0.5;
    return solids;
}

TEST(MeshColumns, VolumeOfTheSpansIsThatOfTheMesh)
{
    for (const NamedSolid& solid : makeSolids()) {
        const MeshColumns columns(solid.mesh, kThin);
        EXPECT_FALSE(columns.isOpen()) << solid.name;
        EXPECT_EQ(columns.countOpenLines(100), 0u);
        const double error = spanVolume(columns, 400) / solid.volume - 1.0;
        EXPECT_LT(std::abs(error), 1e-3) << solid.name;
        RecordProperty(solid.name, std::to_string(error));
    }
}

TEST(MeshColumns, InsideIsWhereTheSolidIs)
{
    std::mt19937_64 random(11);
    for (const NamedSolid& solid : makeSolids()) {
        const MeshColumns columns(solid.mesh, kThin);
        Eigen::AlignedBox3d around = columns.bounds();
        around.extend(Vec3(around.max() + 0.1 * around.sizes()));
        around.extend(Vec3(around.min() - 0.1 * around.sizes()));
        int judged = 0;
        for (int k = 0; k < 10000; ++k) {
            const Vec3 p = pointIn(random, around);
            const std::optional<bool> expected = solid.isInside(p);
            if (expected.has_value()) {
                ++judged;
                ASSERT_EQ(columns.contains(p), *expected) << solid.name << " at " << p.transpose();
            }
        }
        EXPECT_GT(judged, 9500) << solid.name;
    }
}

TEST(MeshColumns, ContainsAgreesWithTheStretches)
{
    std::mt19937_64 random(12);
    std::vector<NamedSolid> solids = makeSolids();
    const TriangleMesh sheet =
        makeSheetMesh(-1.0, 1.0, 20, [](double x, double y) { return 0.2 * x * y; });
    solids.push_back({"sheet", sheet, 0.0, {}});
    TriangleMesh holed = makeIcosphereMesh(Vec3::Zero(), 1.0, 2);
    holed.triangles.resize(200);
    solids.push_back({"holed sphere", holed, 0.0, {}});
    for (const NamedSolid& solid : solids) {
        const MeshColumns columns(solid.mesh, kThin);
        for (int k = 0; k < 10000; ++k) {
            Vec3 p = pointIn(random, columns.bounds());
            const std::vector<SolidInterval> stretches = stretchesAt(columns, p.x(), p.y());
            if (k % 4 == 0 && !stretches.empty()) {
                // Just at, above or below an end.
                const SolidInterval& stretch = stretches[random() % stretches.size()];
                p.z() = random() % 2 == 0 ? stretch.lo : stretch.hi;
                const auto side = random() % 3;
                p.z() = side == 0 ? p.z() : std::nextafter(p.z(), side == 1 ? -9.0 : 9.0);
            }
            bool within = false;
            for (std::size_t s = 0; s < stretches.size(); ++s) {
                ASSERT_LT(stretches[s].lo, stretches[s].hi);
                ASSERT_TRUE(s == 0 || stretches[s - 1].hi < stretches[s].lo);
                within = within || (p.z() >= stretches[s].lo && p.z() <= stretches[s].hi);
            }
            ASSERT_EQ(columns.contains(p), within) << solid.name << " at " << p.transpose();
        }
    }
}

/// Chord of the line at distance rho from the middle, between the inscribed sphere of the facets
/// and that of the corners.
TEST(MeshColumns, ChordsOfASphere)
{
    const TriangleMesh sphere = makeIcosphereMesh(Vec3::Zero(), 0.5, 5);
    const double inner = 0.5 - facetDepth(sphere, 0.5);
    const MeshColumns columns(sphere, kThin);
    std::mt19937_64 random(13);
    for (int k = 0; k < 20000; ++k) {
        const double x = uniformIn(random, -0.5, 0.5);
        const double y = uniformIn(random, -0.5, 0.5);
        const double rho = std::hypot(x, y);
        const std::vector<SolidInterval> stretches = stretchesAt(columns, x, y);
        if (rho > 0.5) {
            ASSERT_TRUE(stretches.empty());
        } else if (rho < inner - 1e-6) {
            ASSERT_EQ(stretches.size(), 1u);
            for (const double end : {stretches[0].hi, -stretches[0].lo}) {
                ASSERT_LT(end, std::sqrt(0.25 - rho * rho) + 1e-6);
                ASSERT_GT(end, std::sqrt(inner * inner - rho * rho) - 1e-6);
            }
        }
    }
}

TEST(MeshColumns, ALyingTorusIsOpenInTheMiddleAndAStandingOneIsTwoStretches)
{
    const TriangleMesh torus = makeTorusMesh(kRing, kTube, kSteps, kSides);
    const MeshColumns lying(torus, kThin);
    const MeshColumns standing(mapped(torus, standUp), kThin);
    EXPECT_TRUE(stretchesAt(lying, 0.0, 0.0).empty());
    EXPECT_TRUE(stretchesAt(lying, 0.1, -0.15).empty());
    EXPECT_EQ(stretchesAt(lying, kRing, 0.0).size(), 1u);
    const std::vector<SolidInterval> stretches = stretchesAt(standing, 0.0, 0.0);
    ASSERT_EQ(stretches.size(), 2u);
    const double facet = torusFacet();
    EXPECT_NEAR(stretches[0].lo, -kRing - kTube, facet);
    EXPECT_NEAR(stretches[0].hi, -kRing + kTube, facet);
    EXPECT_NEAR(stretches[1].lo, kRing - kTube, facet);
    EXPECT_NEAR(stretches[1].hi, kRing + kTube, facet);
    EXPECT_EQ(stretchesAt(standing, kRing, 0.0).size(), 1u);
}

/// Neighbouring boxes as meshes of their own: every line over them belongs to one of them alone,
/// also those exactly on their common faces and edges, whatever lattice each of them has.
TEST(MeshColumns, BoxesThatTouchShareNoLineAndLeaveNoneOut)
{
    const std::vector<double> xs = {-0.3, 0.0, 0.1, 0.7, 0.75, 1.0 / 3.0 + 0.5};
    const std::vector<double> ys = {0.2, 0.25, 1.0 / 7.0 + 0.2, 0.5};
    std::vector<MeshColumns> boxes;
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
        for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
            boxes.emplace_back(makeBoxMesh({xs[i], ys[j], 0.0}, {xs[i + 1], ys[j + 1], 1.0}),
                               kThin);
        }
    }
    const auto countAt = [&](double x, double y) {
        int count = 0;
        for (const MeshColumns& box : boxes) {
            for (const SolidInterval& stretch : stretchesAt(box, x, y)) {
                EXPECT_EQ(stretch.lo, 0.0);
                EXPECT_EQ(stretch.hi, 1.0);
                ++count;
            }
        }
        return count;
    };
    std::mt19937_64 random(14);
    for (std::size_t i = 1; i + 1 < xs.size(); ++i) {
        for (std::size_t j = 1; j + 1 < ys.size(); ++j) {
            EXPECT_EQ(countAt(xs[i], ys[j]), 1);
        }
        for (int k = 0; k < 500; ++k) {
            EXPECT_EQ(countAt(xs[i], uniformIn(random, 0.21, 0.49)), 1);
            EXPECT_EQ(countAt(uniformIn(random, -0.29, 0.8), ys[1 + random() % 2]), 1);
        }
    }
    // Of the rims those at -x and +y belong to the boxes: half of them, as of every box.
    EXPECT_EQ(countAt(-0.3, 0.3), 1);
    EXPECT_EQ(countAt(xs.back(), 0.3), 0);
    EXPECT_EQ(countAt(0.05, 0.5), 1);
    EXPECT_EQ(countAt(0.05, 0.2), 0);
}

TEST(MeshColumns, BoxesThatTouchInOneMeshAreOneStretch)
{
    const TriangleMesh side = joined(makeBoxMesh({0.0, 0.0, 0.0}, {0.3, 0.3, 0.3}),
                                     makeBoxMesh({0.3, 0.0, 0.0}, {0.7, 0.3, 0.3}));
    const TriangleMesh pile = joined(side, makeBoxMesh({0.0, 0.0, 0.3}, {0.7, 0.3, 0.9}));
    const MeshColumns columns(pile, kThin);
    std::mt19937_64 random(15);
    for (int k = 0; k < 2000; ++k) {
        const double x = k % 2 == 0 ? 0.3 : uniformIn(random, 0.01, 0.69);
        const std::vector<SolidInterval> stretches =
            stretchesAt(columns, x, uniformIn(random, 0.01, 0.29));
        ASSERT_EQ(stretches.size(), 1u);
        EXPECT_EQ(stretches[0].lo, 0.0);
        EXPECT_EQ(stretches[0].hi, 0.9);
    }
}

TEST(MeshColumns, ClosedBoxStaysEmptyInside)
{
    for (const NamedSolid& solid : makeSolids()) {
        if (solid.name != std::string("closed box")) {
            continue;
        }
        const MeshColumns columns(solid.mesh, kThin);
        const std::vector<SolidInterval> stretches = stretchesAt(columns, 0.4, 0.4);
        ASSERT_EQ(stretches.size(), 2u);
        EXPECT_EQ(stretches[0].lo, 0.0);
        EXPECT_EQ(stretches[0].hi, 0.1);
        EXPECT_EQ(stretches[1].lo, 0.3);
        EXPECT_EQ(stretches[1].hi, 0.4);
        EXPECT_FALSE(columns.contains({0.4, 0.4, 0.2}));
    }
}

TEST(MeshColumns, FarFromTheOriginIsTheSame)
{
    const Vec3 away(100.0, -100.0, 100.0);
    std::mt19937_64 random(16);
    for (const NamedSolid& solid : makeSolids()) {
        const MeshColumns here(solid.mesh, kThin);
        const MeshColumns there(mapped(solid.mesh, [&](const Vec3& p) { return Vec3(p + away); }),
                                kThin);
        EXPECT_LT(there.latticeSpacing(), 1e-8);
        EXPECT_NEAR(spanVolume(there, 150), spanVolume(here, 150), 1e-5 * solid.volume)
            << solid.name;
        for (int k = 0; k < 2000; ++k) {
            const Vec3 p = pointIn(random, here.bounds());
            const std::optional<bool> expected = solid.isInside(p);
            if (expected.has_value()) {
                ASSERT_EQ(there.contains(p + away), *expected) << solid.name;
            }
        }
    }
}

TEST(MeshColumns, AnOpenSheetIsASlabAndNothingBelowItIsInside)
{
    const auto heightAt = [](double x, double y) { return 0.1 * std::sin(3.0 * x) + 0.05 * y; };
    const TriangleMesh sheet = makeSheetMesh(0.0, 2.0, 100, heightAt);
    for (const bool facesUp : {true, false}) {
        const MeshColumns columns(facesUp ? sheet : turnedInsideOut(sheet), kThin);
        EXPECT_TRUE(columns.isOpen());
        EXPECT_EQ(columns.countOpenLines(50), 2500u);
        std::mt19937_64 random(17);
        for (int k = 0; k < 5000; ++k) {
            const double x = uniformIn(random, 0.0, 2.0);
            const double y = uniformIn(random, 0.0, 2.0);
            const std::vector<SolidInterval> stretches = stretchesAt(columns, x, y);
            ASSERT_EQ(stretches.size(), 1u);
            ASSERT_NEAR(stretches[0].hi, heightAt(x, y), 1e-4);
            ASSERT_NEAR(stretches[0].hi - stretches[0].lo, kThin, 1e-12);
            const double top = stretches[0].hi;
            EXPECT_FALSE(columns.contains({x, y, top + 1e-9}));
            EXPECT_TRUE(columns.contains({x, y, top - 1e-9}));
            EXPECT_TRUE(columns.contains({x, y, top - 0.9 * kThin}));
            EXPECT_FALSE(columns.contains({x, y, top - 1.1 * kThin}));
            EXPECT_FALSE(columns.contains({x, y, -0.2}));
        }
    }
}

TEST(MeshColumns, ABodyOverASheetKeepsItsInside)
{
    const TriangleMesh sheet = makeSheetMesh(-1.0, 1.0, 4, [](double, double) { return 0.0; });
    const TriangleMesh body = makeBoxMesh({-0.5, -0.5, 0.25}, {0.5, 0.5, 0.5});
    const MeshColumns above(joined(sheet, body), kThin);
    const MeshColumns below(joined(sheet, mapped(body, [](const Vec3& p) {
                                       return Vec3(p - 0.75 * Vec3::UnitZ());
                                   })), kThin);
    for (const double x : {-0.3, 0.0, 0.499}) {
        std::vector<SolidInterval> stretches = stretchesAt(above, x, 0.1);
        ASSERT_EQ(stretches.size(), 2u);
        EXPECT_EQ(stretches[0].lo, -kThin);
        EXPECT_EQ(stretches[0].hi, 0.0);
        EXPECT_EQ(stretches[1].lo, 0.25);
        EXPECT_EQ(stretches[1].hi, 0.5);
        stretches = stretchesAt(below, x, 0.1);
        ASSERT_EQ(stretches.size(), 2u);
        EXPECT_EQ(stretches[0].lo, -0.5);
        EXPECT_EQ(stretches[0].hi, -0.25);
        EXPECT_EQ(stretches[1].hi, 0.0);
    }
}

/// A terrain whose rock hangs over: the sheet faces up, down and up again along one line.
TEST(MeshColumns, TheRockOfAnOverhangingSheetIsSolid)
{
    TriangleMesh sheet;
    const std::array<Vec2, 4> profile = {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(0.5, 0.5),
                                         Vec2(2.0, 1.0)};
    for (const Vec2& p : profile) {
        sheet.points.push_back({p.x(), 0.0, p.y()});
        sheet.points.push_back({p.x(), 1.0, p.y()});
    }
    for (std::uint32_t a = 0; a < 6; a += 2) {
        sheet.triangles.push_back({a, a + 2, a + 3});
        sheet.triangles.push_back({a, a + 3, a + 1});
    }
    const MeshColumns columns(sheet, kThin);
    const std::vector<SolidInterval> stretches = stretchesAt(columns, 0.8, 0.5);
    ASSERT_EQ(stretches.size(), 2u);
    EXPECT_EQ(stretches[0].hi, 0.0);
    EXPECT_NEAR(stretches[0].lo, -kThin, 1e-15);
    EXPECT_NEAR(stretches[1].lo, 0.2, 1e-8);
    EXPECT_NEAR(stretches[1].hi, 0.6, 1e-8);
    EXPECT_FALSE(columns.contains({0.8, 0.5, 0.1}));
    EXPECT_TRUE(columns.contains({0.8, 0.5, 0.4}));
}

/// A box whose lid lacks a strip from x = 0.4 to x = 0.4 + width.
TriangleMesh makeCrackedBox(double width)
{
    TriangleMesh box = makeBlocksMesh({0.0, 0.4, 0.4 + width, 1.0}, {0.0, 1.0}, {0.0, 1.0},
                                      [](int, int, int) { return true; });
    std::erase_if(box.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
        bool isLid = true;
        double centre = 0.0;
        for (const std::uint32_t corner : triangle) {
            isLid = isLid && box.points[corner].z() == 1.0;
            centre += box.points[corner].x() / 3.0;
        }
        return isLid && centre > 0.4 && centre < 0.4 + width;
    });
    return box;
}

TEST(MeshColumns, CracksAreClosed)
{
    const double width = 0.4 * kThin;
    const MeshColumns columns(makeCrackedBox(width), kThin);
    EXPECT_TRUE(columns.isOpen());
    EXPECT_TRUE(columns.isOpenAt(0.4 + 0.5 * width, 0.5));
    EXPECT_FALSE(columns.isOpenAt(0.3, 0.5));
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const double x = 0.4 + share * width;
        const std::vector<SolidInterval> stretches = stretchesAt(columns, x, 0.5);
        ASSERT_EQ(stretches.size(), 1u) << share;
        EXPECT_EQ(stretches[0].lo, 0.0);
        EXPECT_EQ(stretches[0].hi, 1.0);
        EXPECT_TRUE(columns.contains({x, 0.5, 0.5}));
    }
}

TEST(MeshColumns, ThroughAWideHoleTheBottomIsSeen)
{
    const MeshColumns columns(makeCrackedBox(0.2), kThin);
    const std::vector<SolidInterval> stretches = stretchesAt(columns, 0.5, 0.5);
    ASSERT_EQ(stretches.size(), 1u);
    EXPECT_EQ(stretches[0].lo, -kThin);
    EXPECT_EQ(stretches[0].hi, 0.0);
    EXPECT_FALSE(columns.contains({0.5, 0.5, 0.5}));
    EXPECT_TRUE(columns.contains({0.5, 0.5, -0.5 * kThin}));
    EXPECT_TRUE(columns.contains({0.3, 0.5, 0.5}));
    // A fifth of the lines, as the hole has a fifth of the lid.
    EXPECT_EQ(columns.countOpenLines(100), 2000u);
}

TEST(MeshColumns, ManyThreadsGetTheSameAnswers)
{
    const MeshColumns columns(makeIcosphereMesh(Vec3::Zero(), 0.5, 4), kThin);
    constexpr int count = 20000;
    std::vector<Vec3> points;
    std::mt19937_64 random(18);
    for (int k = 0; k < count; ++k) {
        points.push_back(pointIn(random, columns.bounds()));
    }
    std::vector<char> inside(count);
    std::vector<double> lengths(count);
#pragma omp parallel for num_threads(4)
    for (int k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        inside[at] = columns.contains(points[at]);
        for (const SolidInterval& s : stretchesAt(columns, points[at].x(), points[at].y())) {
            lengths[at] += s.hi - s.lo;
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ(inside[k] != 0, columns.contains(points[k]));
        double length = 0.0;
        for (const SolidInterval& s : stretchesAt(columns, points[k].x(), points[k].y())) {
            length += s.hi - s.lo;
        }
        ASSERT_EQ(lengths[k], length);
    }
}

TEST(MeshColumns, NoTrianglesNoSolid)
{
    const MeshColumns nothing(TriangleMesh{}, kThin);
    EXPECT_TRUE(nothing.bounds().isEmpty());
    EXPECT_TRUE(stretchesAt(nothing, 0.0, 0.0).empty());
    EXPECT_FALSE(nothing.contains(Vec3::Zero()));
    EXPECT_EQ(nothing.countOpenLines(10), 0u);
    const MeshColumns box(makeBoxMesh(Vec3::Zero(), Vec3::Ones()), kThin);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(box.contains({0.5, 0.5, nan}));
    EXPECT_FALSE(box.contains({nan, 0.5, 0.5}));
    EXPECT_THROW(MeshColumns(TriangleMesh{}, 0.0), InternalError);
    EXPECT_THROW(MeshColumns(TriangleMesh{}, nan), InternalError);
}

}  // namespace
}  // namespace sandflow::testing
