#include "core/errors.h"
#include "mesh/shapes.h"
#include "mesh/write_mesh.h"
#include "solids/solid_set.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

constexpr double kEdge = 0.03;  // m, of a column

SolidSpec boxAt(const Vec3& min, const Vec3& max)
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.min = min;
    box.max = max;
    return box;
}

SolidSpec meshOf(const TriangleMesh& mesh, const std::string& name)
{
    SolidSpec solid;
    solid.shape = SolidShape::mesh;
    solid.name = name;
    solid.mesh = writeMesh(mesh, testing::TempDir() + name + ".ply");
    solid.stand = false;
    return solid;
}

Scene sceneOf(std::vector<SolidSpec> solids)
{
    Scene scene;
    scene.solids = std::move(solids);
    return scene;
}

std::vector<FreeStretch> stretchesAt(const SolidSet& solids, double x, double y, double time = 0.0)
{
    std::vector<FreeStretch> out = {{9.0, 9.0, true}};  // must be replaced
    solids.freeStretches(time, x, y, kEdge, out);
    return out;
}

TEST(SolidSet, ABoxIsTheSameAsAMeshAndAsAPrimitive)
{
    const Vec3 min(-0.2, -0.1, 0.3), max(0.2, 0.1, 0.4);
    const SolidSet drawn(sceneOf({SolidSpec(), boxAt(min, max)}));
    const SolidSet loaded(sceneOf({SolidSpec(), meshOf(makeBoxMesh(min, max), "box")}));
    EXPECT_TRUE(loaded.notices().empty());
    for (int i = -12; i <= 12; ++i) {
        for (int j = -8; j <= 8; ++j) {
            const double x = 0.0201 * i, y = 0.0203 * j;
            const auto a = stretchesAt(drawn, x, y), b = stretchesAt(loaded, x, y);
            ASSERT_EQ(a.size(), b.size()) << x << ' ' << y;
            for (std::size_t k = 0; k < a.size(); ++k) {
                EXPECT_NEAR(a[k].floor, b[k].floor, 1e-6);
                EXPECT_NEAR(a[k].ceiling, b[k].ceiling, 1e-6);
                EXPECT_EQ(a[k].ragged, b[k].ragged) << x << ' ' << y;
            }
            for (const double z : {-0.01, 0.01, 0.29, 0.31, 0.39, 0.41}) {
                EXPECT_EQ(drawn.contains(0.0, {x, y, z}), loaded.contains(0.0, {x, y, z}))
                    << x << ' ' << y << ' ' << z;
            }
        }
    }
}

TEST(SolidSet, ColumnsUnderARimAreRagged)
{
    const SolidSet solids(sceneOf({SolidSpec(), boxAt({-0.2, -0.2, 0.3}, {0.2, 0.2, 0.34})}));
    const auto middle = stretchesAt(solids, 0.0, 0.0);
    ASSERT_EQ(middle.size(), 2u) << "under the table and on it";
    EXPECT_FALSE(middle[0].ragged);
    EXPECT_FALSE(middle[1].ragged);
    EXPECT_TRUE(stretchesAt(solids, 0.195, 0.0)[0].ragged) << "the rim crosses this column";
    EXPECT_TRUE(stretchesAt(solids, 0.205, 0.0)[0].ragged);
    EXPECT_FALSE(stretchesAt(solids, 0.22, 0.0)[0].ragged);
}

TEST(SolidSet, ASlopeIsNotRaggedButAStepIs)
{
    TriangleMesh wedge = makeBoxMesh({-0.5, -0.5, -0.1}, {0.5, 0.5, 0.0});
    for (Vec3& p : wedge.points) {
        p.z() += p.z() == 0.0 ? 0.7 * (p.x() + 0.5) : 0.0;  // 35 degrees
    }
    const SolidSet slope(sceneOf({meshOf(wedge, "slope")}));
    const auto on = stretchesAt(slope, 0.1, 0.1);
    ASSERT_EQ(on.size(), 2u) << "below the block and on its top";
    EXPECT_NEAR(on[1].floor, 0.42, 1e-6);
    EXPECT_FALSE(on[1].ragged);
    const SolidSet step(sceneOf({SolidSpec(), boxAt({0.0, -1.0, 0.0}, {1.0, 1.0, 0.2})}));
    EXPECT_TRUE(stretchesAt(step, 0.005, 0.0)[0].ragged);
    EXPECT_FALSE(stretchesAt(step, 0.05, 0.0)[0].ragged);
}

TEST(SolidSet, SolidsComeAndGo)
{
    SolidSpec plate = meshOf(makeBoxMesh({-0.2, -0.2, 0.3}, {0.2, 0.2, 0.34}), "plate");
    plate.from = 1.0;
    plate.until = 2.0;
    const SolidSet solids(sceneOf({SolidSpec(), plate}));
    EXPECT_EQ(stretchesAt(solids, 0.0, 0.0, 0.5).size(), 1u);
    EXPECT_EQ(stretchesAt(solids, 0.0, 0.0, 1.5).size(), 2u);
    EXPECT_EQ(stretchesAt(solids, 0.0, 0.0, 2.0).size(), 1u);
    EXPECT_FALSE(solids.contains(0.5, {0.0, 0.0, 0.32}));
    EXPECT_TRUE(solids.contains(1.5, {0.0, 0.0, 0.32}));
    EXPECT_TRUE(solids.changesBetween(0.5, 1.5));
    EXPECT_FALSE(solids.changesBetween(1.1, 1.9));
    EXPECT_TRUE(solids.changesBetween(1.9, 2.1));
}

TEST(SolidSet, AStandInTakesThePlaceOfAMeshThatIsNotThereAndSaysSo)
{
    SolidSpec figure = meshOf(makeBoxMesh(Vec3::Zero(), Vec3::Ones()), "stand_in");
    figure.standIn = figure.mesh;
    figure.mesh = "no_such_dragon.ply";
    figure.name = "dragon";
    const SolidSet solids(sceneOf({figure}));
    ASSERT_EQ(solids.meshes().size(), 1u);
    EXPECT_EQ(solids.meshes()[0].file, figure.standIn);
    ASSERT_EQ(solids.notices().size(), 1u);
    const std::string& notice = solids.notices()[0];
    for (const char* part : {"solids[0] (\"dragon\")", "no_such_dragon.ply", "stand_in.ply"}) {
        EXPECT_NE(notice.find(part), std::string::npos) << notice;
    }
}

TEST(SolidSet, WithoutAStandInTheMessageSaysWhereItLooked)
{
    SolidSpec figure;
    figure.shape = SolidShape::mesh;
    figure.mesh = "no_such_dragon.ply";
    Scene scene = sceneOf({figure});
    scene.sourcePath = "somewhere/scene.toml";
    try {
        const SolidSet solids(scene);
        FAIL() << "accepted";
    } catch (const InputError& e) {
        const std::string message = e.what();
        for (const char* part : {"solids[0]", "no_such_dragon.ply", "somewhere"}) {
            EXPECT_NE(message.find(part), std::string::npos) << message;
        }
    }
}

}  // namespace
}  // namespace sandflow
