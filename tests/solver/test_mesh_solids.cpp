#include "mesh/shapes.h"
#include "mesh/write_mesh.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kRadius = 0.005;  // m

SolidSpec meshOf(const TriangleMesh& mesh, const std::string& name)
{
    SolidSpec solid;
    solid.shape = SolidShape::mesh;
    solid.name = name;
    solid.mesh = writeMesh(mesh, ::testing::TempDir() + "solver_" + name + ".ply");
    solid.stand = false;
    return solid;
}

/// A level square of n x n x 2 triangles, facing up.
TriangleMesh makeSquare(double halfEdge, int n)
{
    TriangleMesh mesh;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            mesh.points.push_back(
                {halfEdge * (2.0 * i / n - 1.0), halfEdge * (2.0 * j / n - 1.0), 0.0});
        }
    }
    const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

struct Rebound {
    double energy = 0.0;   ///< mean kinetic energy after over before
    double deviation = 0.0;  ///< of one grain's
    double height = 0.0;   ///< m, mean lowest height of the centres
};

/// 196 grains dropped side by side, each alone.
Rebound dropOn(const SolidSpec& solid)
{
    constexpr double kSpeed = 1.0;
    Scene scene;
    scene.mode = Mode::dem;
    scene.contact.restitution = 0.6;
    scene.gravity = Vec3(0.0, 0.0, -1e-9);
    scene.grains.sizeSpread = 0.0;
    scene.time.framesPerSecond = 2000.0;
    scene.time.duration = 0.03;
    scene.solids.push_back(solid);
    for (int k = 0; k < 196; ++k) {
        scene.emitters.push_back(makeSingle(
            Vec3(0.0303 * (k % 14 - 6.5), 0.0307 * (k / 14 - 6.5), 3.0 * kRadius),
            Vec3(0.0, 0.0, -kSpeed)));
    }
    std::vector<double> lowest(196, 1.0);
    const auto sim = run(scene, [&](const Simulation& s, const FrameReport&) {
        const Snapshot now = snapshotOf(s);
        for (std::size_t k = 0; k < now.id.size(); ++k) {
            lowest[k] = std::min(lowest[k], now.position[k].z());
        }
    });
    const Snapshot last = snapshotOf(*sim);
    Rebound out;
    std::vector<double> share;
    for (std::size_t k = 0; k < last.id.size(); ++k) {
        EXPECT_GT(last.position[k].z(), lowest[k]) << "grain " << k << " did not come back";
        const double v2 = last.velocity[k].cast<double>().squaredNorm();
        const double w2 = last.spin[k].cast<double>().squaredNorm();
        share.push_back((v2 + 0.4 * kRadius * kRadius * w2) / (kSpeed * kSpeed));
        out.energy += share.back() / 196.0;
        out.height += lowest[k] / 196.0;
    }
    for (const double s : share) {
        out.deviation += (s - out.energy) * (s - out.energy) / 195.0;
    }
    out.deviation = std::sqrt(out.deviation);
    return out;
}

SolidSpec smoothPlane()
{
    SolidSpec plane;
    plane.rough = false;
    return plane;
}

SolidSpec boxBelow()
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.min = Vec3(-0.3, -0.3, -0.1);
    box.max = Vec3(0.3, 0.3, 0.0);
    return box;
}

TEST(MeshSolids, APlaneAndABoxThrowAGrainBackAlike)
{
    const Rebound plane = dropOn(smoothPlane()), box = dropOn(boxBelow());
    // Speed is the root of energy.
    EXPECT_NEAR(std::sqrt(plane.energy), std::sqrt(box.energy), 0.01 * std::sqrt(plane.energy));
    EXPECT_LT(plane.deviation, 1e-3);
}

/// On particles a grain is thrown aside, not straight back: single rebounds scatter with the bumps.
/// The mean over 196 places is the same however the face is cut into triangles.
TEST(MeshSolids, TheSameFaceInTwoOrTwoThousandTrianglesThrowsGrainsBackAlike)
{
    const Rebound two = dropOn(meshOf(makeSquare(0.3, 1), "two")),
                  many = dropOn(meshOf(makeSquare(0.3, 32), "many")),
                  box = dropOn(meshOf(makeBoxMesh({-0.3, -0.3, -0.1}, {0.3, 0.3, 0.0}), "box"));
    for (const Rebound& other : {many, box}) {
        const double noise = std::sqrt((two.deviation * two.deviation +
                                        other.deviation * other.deviation) / 196.0);
        EXPECT_NEAR(other.energy, two.energy, 3.0 * noise);
        EXPECT_NEAR(other.height, two.height, 0.03 * kRadius);
    }
    RecordProperty("energy_share", std::to_string(two.energy));
    RecordProperty("deviation", std::to_string(two.deviation));
    RecordProperty("height_r", std::to_string(two.height / kRadius));
}

/// The particles of a mesh are as large as half the mean grain; the smallest grain that a scene may
/// hold is a third of it and must not find its way between them.
TEST(MeshSolids, TheSmallestGrainsDoNotSlipThrough)
{
    Scene scene;
    scene.mode = Mode::dem;
    scene.grains.sizeSpread = 2.0 / 3.0;
    scene.time.duration = 0.5;
    scene.solids.push_back(meshOf(makeSquare(0.3, 1), "sieve"));
    for (int k = 0; k < 196; ++k) {
        scene.emitters.push_back(makeSingle(
            Vec3(0.0303 * (k % 14 - 6.5), 0.0307 * (k / 14 - 6.5), 3.0 * kRadius),
            Vec3(0.0, 0.0, -1.0)));
        scene.emitters.back().grainRadius = kRadius / 3.0;
    }
    const auto sim = run(scene);
    for (const Vec3& p : snapshotOf(*sim).position) {
        EXPECT_GT(p.z(), 0.0) << "fell through at " << p.x() << ", " << p.y();
    }
}

/// A bowl, open above: a block with a square pit.
TriangleMesh makePit(double half, double wall, double depth)
{
    TriangleMesh mesh;
    const std::array<double, 4> rim = {-half - wall, -half, half, half + wall};
    // Outside and top ring from the outer box, pit walls and bottom inside; a closed surface.
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        const auto first = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.insert(mesh.points.end(), {a, b, c, d});
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    const double lo = rim[0], hi = rim[3], bottom = 0.0, top = wall + depth;
    quad({lo, lo, bottom}, {lo, hi, bottom}, {hi, hi, bottom}, {hi, lo, bottom});
    quad({lo, lo, bottom}, {hi, lo, bottom}, {hi, lo, top}, {lo, lo, top});
    quad({hi, lo, bottom}, {hi, hi, bottom}, {hi, hi, top}, {hi, lo, top});
    quad({hi, hi, bottom}, {lo, hi, bottom}, {lo, hi, top}, {hi, hi, top});
    quad({lo, hi, bottom}, {lo, lo, bottom}, {lo, lo, top}, {lo, hi, top});
    const double a = rim[1], b = rim[2];
    quad({lo, lo, top}, {hi, lo, top}, {b, a, top}, {a, a, top});
    quad({hi, lo, top}, {hi, hi, top}, {b, b, top}, {b, a, top});
    quad({hi, hi, top}, {lo, hi, top}, {a, b, top}, {b, b, top});
    quad({lo, hi, top}, {lo, lo, top}, {a, a, top}, {a, b, top});
    quad({a, a, top}, {b, a, top}, {b, a, wall}, {a, a, wall});
    quad({b, a, top}, {b, b, top}, {b, b, wall}, {b, a, wall});
    quad({b, b, top}, {a, b, top}, {a, b, wall}, {b, b, wall});
    quad({a, b, top}, {a, a, top}, {a, a, wall}, {a, b, wall});
    quad({a, a, wall}, {b, a, wall}, {b, b, wall}, {a, b, wall});
    return mesh;
}

class InAPit : public ::testing::TestWithParam<Mode> {};

/// A jet at the largest speed of any scene (5 m/s at the bottom) fills a mesh with walls of 8 mm to the
/// brim, over an open floor: nothing gets through,
/// what spills comes to lie beside it.
TEST_P(InAPit, SandStaysAndNothingLeaks)
{
    Scene scene = makePour(2600, GetParam());
    scene.emitters[0].rate = 4000.0;
    scene.emitters[0].radius = 0.04;
    scene.emitters[0].speed = 4.3;
    scene.emitters[0].position.z() = 0.4;
    scene.time.settle = 0.5;
    scene.solids.push_back(meshOf(makePit(0.06, 0.008, 0.12), "pit"));
    std::uint64_t leaks = 0;
    const auto sim = run(scene, [&](const Simulation& s, const FrameReport& report) {
        leaks += s.countLeaks();
        EXPECT_TRUE(report.ledger.balances());
    });
    EXPECT_EQ(leaks, 0u);
    EXPECT_EQ(sim->ledger().emitted, 2600u);
    std::size_t inside = 0;
    const Snapshot last = snapshotOf(*sim);
    for (const Vec3& p : last.position) {
        inside += std::abs(p.x()) < 0.06 && std::abs(p.y()) < 0.06 && p.z() > 0.008 ? 1 : 0;
    }
    // 0.12 x 0.12 x 0.12 m hold about 1,900 grains at a solid fraction of 0.58, and a heap on top.
    EXPECT_GT(inside, 1700u);
    EXPECT_LT(inside, 2450u) << "some must have spilled";
    if (GetParam() == Mode::surfaceFlow) {
        // Two of four columns across are free of the walls.
        const Ledger end = sim->ledger();
        EXPECT_GT(end.interface + end.buried, 200u);
        EXPECT_GT(end.interface + end.buried + end.asleep, 800u);
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, InAPit, ::testing::Values(Mode::surfaceFlow, Mode::dem));

/// The column of the highest scene, 0.45 m of settled sand, on a bottom and between walls of mesh.
TEST(MeshSolids, CarryTheDeepestColumnOfAnySceneWithoutALeak)
{
    Scene scene = makeEmptyScene();
    scene.mode = Mode::dem;
    scene.time.duration = 0.4;
    scene.solids.push_back(meshOf(makePit(0.05, 0.008, 0.5), "shaft"));
    EmitterSpec fill;
    fill.kind = EmitterKind::fill;
    fill.min = Vec3(-0.047, -0.047, 0.011);
    fill.max = Vec3(0.047, 0.047, 0.461);
    scene.emitters.push_back(fill);
    std::uint64_t leaks = 0;
    double deepest = 0.0;
    const auto sim = run(scene, [&](const Simulation& s, const FrameReport& report) {
        leaks += s.countLeaks();
        deepest = std::max(deepest, report.deepestOverlap);
    });
    EXPECT_EQ(leaks, 0u);
    EXPECT_GT(sim->ledger().emitted, 3500u);
    EXPECT_LT(deepest, scene.contact.maxOverlap * kRadius);
    for (const Vec3& p : snapshotOf(*sim).position) {
        EXPECT_LT(p.cwiseAbs().head<2>().maxCoeff(), 0.05);
        EXPECT_GT(p.z(), 0.008);
    }
}

/// Sand on a table that is a mesh, and under it: two levels of one column at once, and all falls
/// when the table vanishes.
TEST(MeshSolids, SandLiesOnATableAndUnderItUntilTheTableVanishes)
{
    Scene scene = makeEmptyScene();
    scene.time.duration = 1.8;
    SolidSpec table = meshOf(makeBoxMesh({-0.12, -0.12, 0.1}, {0.12, 0.12, 0.115}), "table");
    table.until = 1.0;
    scene.solids.push_back(table);
    for (const double z : {0.0, 0.12}) {
        EmitterSpec block;
        block.kind = EmitterKind::block;
        block.count = 500;
        block.min = Vec3(-0.06, -0.06, z + 0.005);
        block.max = Vec3(0.06, 0.06, z + 0.075);
        scene.emitters.push_back(block);
    }
    std::uint64_t leaks = 0;
    std::size_t onTable = 0, underTable = 0;
    const auto sim = run(scene, [&](const Simulation& s, const FrameReport& report) {
        leaks += s.countLeaks();
        if (report.time < 0.99) {
            onTable = underTable = 0;
            for (const Vec3& p : snapshotOf(s).position) {
                const bool over = p.cwiseAbs().head<2>().maxCoeff() < 0.12;
                onTable += over && p.z() > 0.115 ? 1 : 0;
                underTable += over && p.z() < 0.1 ? 1 : 0;
            }
        }
    });
    EXPECT_EQ(leaks, 0u);
    EXPECT_GE(onTable, 480u);
    EXPECT_GE(underTable, 480u);
    double highest = 0.0;
    for (const Vec3& p : snapshotOf(*sim).position) {
        highest = std::max(highest, p.z());
    }
    EXPECT_LT(highest, 0.1) << "all lies on the floor now";
}

}  // namespace
}  // namespace sandflow
