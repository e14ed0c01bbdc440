#include "mesh/load_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace sandflow {
namespace {

/// A mesh of our own as meshes/README.md describes it.
struct OwnMesh {
    std::string name;
    std::size_t triangles;
    Vec3 low, high;  ///< m, in the axes of the file
};

const OwnMesh kOwnMeshes[] = {
    {"terrain", 15'120, {-0.630, -0.630, -0.050}, {0.630, 0.630, 0.250}},
    {"bowl", 47'616, {-0.592, -0.592, 0.000}, {0.592, 0.592, 0.400}},
    {"stand_in_dragon", 56'536, {-0.351, 0.000, -0.156}, {0.349, 0.498, 0.156}},
    {"stand_in_armadillo", 59'844, {-0.344, 0.000, -0.274}, {0.358, 0.800, 0.357}},
};

std::filesystem::path pathOf(const OwnMesh& own)
{
    return std::filesystem::path(SANDFLOW_SOURCE_DIR "/meshes") / (own.name + ".ply");
}

TEST(OwnMeshes, AreClosedAndOfOnePieceAndNeedNoRepair)
{
    for (const OwnMesh& own : kOwnMeshes) {
        const MeshReport report = loadMesh(pathOf(own)).report;
        EXPECT_TRUE(report.repairs.empty()) << own.name << ": " << report.repairs.front();
        EXPECT_EQ(report.boundaryEdges, 0) << own.name;
        EXPECT_EQ(report.nonManifoldEdges, 0) << own.name;
        EXPECT_EQ(report.unbalancedEdges, 0) << own.name;
        EXPECT_EQ(report.components, 1) << own.name;
        EXPECT_GT(report.signedVolume, 0.0) << own.name;
    }
}

TEST(OwnMeshes, HaveTheSizesInTheReadme)
{
    for (const OwnMesh& own : kOwnMeshes) {
        const MeshReport report = loadMesh(pathOf(own)).report;
        EXPECT_EQ(report.triangles, own.triangles) << own.name;
        EXPECT_LT((report.bounds.min() - own.low).cwiseAbs().maxCoeff(), 1e-3) << own.name;
        EXPECT_LT((report.bounds.max() - own.high).cwiseAbs().maxCoeff(), 1e-3) << own.name;
        EXPECT_LT(std::filesystem::file_size(pathOf(own)), 1'500'000) << own.name;
    }
}

/// Scenes place them with the same keys as the scans.
TEST(OwnMeshes, FiguresHaveTheProportionsOfTheScans)
{
    const Vec3 dragon = loadMesh(pathOf(kOwnMeshes[2])).report.bounds.sizes();
    EXPECT_NEAR(dragon.y() / dragon.x(), 144.0 / 204.0, 0.02);
    EXPECT_NEAR(dragon.z() / dragon.x(), 91.0 / 204.0, 0.02);
    const Vec3 armadillo = loadMesh(pathOf(kOwnMeshes[3])).report.bounds.sizes();
    EXPECT_NEAR(armadillo.x() / armadillo.y(), 127.0 / 151.0, 0.05);
    EXPECT_NEAR(armadillo.z() / armadillo.y(), 115.0 / 151.0, 0.05);
}

}  // namespace
}  // namespace sandflow
