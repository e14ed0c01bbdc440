#include "core/errors.h"
#include "io/camera_frame.h"
#include "io/pov_scene.h"
#include "io/pov_solids.h"
#include "mesh/shapes.h"
#include "sample_snapshot.h"
#include "scene/scene_choices.h"
#include "temp_folder.h"

#include <cmath>
#include <locale>

namespace sandflow {
namespace {

const std::string kPovrayFolder = std::string(SANDFLOW_SOURCE_DIR) + "/povray";

SolidSpec makeBox(const Vec3& min, const Vec3& max, bool hollow, bool floor)
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.name = "tank";
    box.look = "glass";
    box.min = min;
    box.max = max;
    box.hollow = hollow;
    box.floor = floor;
    return box;
}

std::string drawSolid(const SolidSpec& solid)
{
    Scene scene;
    scene.grains.radius = 0.01;
    scene.solids = {solid};
    const std::string text = formatPovSolids(scene, Vec3(0.0, -5.0, 3.0));
    const std::string begin = "#macro RunSolids()\n";
    EXPECT_TRUE(text.starts_with(begin) && text.ends_with("#end\n"));
    return text.substr(begin.size(), text.size() - begin.size() - 5);
}

/// Where a point lands in the picture of a camera, in half widths; the plainest pinhole there is.
Vec2 projectPoint(const CameraFrame& camera, const Vec3& point)
{
    const Vec3 forward = (camera.lookAt - camera.position).normalized();
    const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
    const Vec3 offset = point - camera.position;
    const double scale = offset.dot(forward) * std::tan(camera.angle * kPi / 360.0);
    return {offset.dot(right) / scale, offset.dot(right.cross(forward)) / scale};
}

TEST(PovSolids, drawsEachShapeInMeanRadiiAndPovRayAxes)
{
    SolidSpec plane;
    plane.name = "ground";
    plane.point = Vec3(3.0, 0.0, 0.1);
    EXPECT_EQ(drawSolid(plane), "  // ground\n  plane{<0,1,0>,10 no_shadow FloorLook()}\n");

    EXPECT_EQ(drawSolid(makeBox(Vec3(0.0, 0.1, 0.2), Vec3(1.0, 2.0, 3.0), false, false)),
              "  // tank\n  box{<0,20,10>,<100,300,200> GlassLook()}\n");

    SolidSpec post;
    post.shape = SolidShape::cylinder;
    post.name = "post";
    post.look = "wood";
    post.point = Vec3(0.0, 1.0, 0.0);
    post.normal = Vec3::UnitX();
    post.radius = 0.05;
    post.height = 0.5;
    EXPECT_EQ(drawSolid(post), "  // post\n  cylinder{<0,0,100>,<50,0,100>,5 WoodLook()}\n");

    SolidSpec disc = post;
    disc.shape = SolidShape::disc;
    disc.look = "ceramic";
    disc.normal = Vec3::UnitZ();
    EXPECT_EQ(drawSolid(disc),
              "  // post\n  cylinder{<0,-0.25,100>,<0,0.25,100>,5 CeramicLook()}\n");
}

TEST(PovSolids, drawsContainersAsThinWallsOpenAtTheTop)
{
    const Vec3 min(0.0, 0.0, 0.0);
    const Vec3 max(1.0, 2.0, 3.0);
    EXPECT_EQ(drawSolid(makeBox(min, max, true, true)),
              "  // tank\n  difference{box{<-0.25,-0.25,-0.25>,<100.25,300,200.25>} "
              "box{<0.25,0.25,0.25>,<99.75,300.5,199.75>} GlassLook()}\n");
    EXPECT_EQ(drawSolid(makeBox(min, max, true, false)),
              "  // tank\n  difference{box{<-0.25,0,-0.25>,<100.25,300,200.25>} "
              "box{<0.25,-0.5,0.25>,<99.75,300.5,199.75>} GlassLook()}\n");
    SolidSpec tube;
    tube.shape = SolidShape::cylinder;
    tube.name = "tube";
    tube.hollow = true;
    tube.radius = 0.1;
    tube.height = 0.2;
    EXPECT_EQ(drawSolid(tube),
              "  // tube\n  difference{cylinder{<0,0,0>,<0,20,0>,10.25} "
              "cylinder{<0,-0.25,0>,<0,20.5,0>,9.75} FloorLook()}\n");
    tube.floor = true;
    EXPECT_EQ(drawSolid(tube),
              "  // tube\n  difference{cylinder{<0,-0.25,0>,<0,20,0>,10.25} "
              "cylinder{<0,0.25,0>,<0,20.5,0>,9.75} FloorLook()}\n");
}

TEST(PovSolids, drawsRoughGroundWhereGrainsRest)
{
    SolidSpec plane;
    plane.rough = true;  // its fixed grains lie below it, so that sand rests on the plane itself
    EXPECT_NE(drawSolid(plane).find("plane{<0,1,0>,0 "), std::string::npos);
}

TEST(PovSolids, leavesOutAWallThatHidesTheSand)
{
    SolidSpec wall;
    wall.name = "front";
    wall.point = Vec3(0.0, -1.0, 0.0);
    wall.normal = Vec3::UnitY();  // the camera is at y = -5, behind it
    EXPECT_EQ(drawSolid(wall), "  // front: not drawn, its back is to the camera\n");
    wall.normal = -Vec3::UnitY();
    EXPECT_NE(drawSolid(wall).find("plane{<0,0,-1>,100 "), std::string::npos);
}

TEST(PovSolids, testsTheTimeOfSolidsThatComeAndGo)
{
    SolidSpec box = makeBox(Vec3::Zero(), Vec3::Ones(), false, false);
    const std::string object = "  box{<0,0,0>,<100,100,100> GlassLook()}\n";
    box.until = 2.5;
    EXPECT_EQ(drawSolid(box), "  // tank\n  #if (RunTime < 2.5)\n" + object + "  #end\n");
    box.from = 0.5;
    EXPECT_EQ(drawSolid(box),
              "  // tank\n  #if (RunTime >= 0.5 & RunTime < 2.5)\n" + object + "  #end\n");
    box.until = 1e30;
    EXPECT_EQ(drawSolid(box), "  // tank\n  #if (RunTime >= 0.5)\n" + object + "  #end\n");
}

TEST(PovSolids, hidesAndRefusesLooks)
{
    SolidSpec box = makeBox(Vec3::Zero(), Vec3::Ones(), false, false);
    box.look = "none";
    EXPECT_EQ(drawSolid(box), "");
    box.look = "gold";
    EXPECT_EQ(messageOf<InputError>([&] { drawSolid(box); }),
              "solid \"tank\": unknown look \"gold\": use floor, glass, ceramic, wood, stone, "
              "jade, bronze or none");
}

TEST(PovSolids, hasAMaterialForEveryLookOfAScene)
{
    for (const auto& look : words::kLooks) {
        SolidSpec box = makeBox(Vec3::Zero(), Vec3::Ones(), false, false);
        box.look = look.value;
        EXPECT_NO_THROW(drawSolid(box)) << look.name;
    }
}

TEST(PovSolids, callsAMeshByItsNameAndRefusesOneItDoesNotHave)
{
    Scene scene;
    scene.solids.resize(2);
    scene.solids[1].shape = SolidShape::mesh;
    scene.solids[1].name = "figure";
    scene.solids[1].look = "jade";
    scene.solids[1].from = 0.5;
    const std::vector<SceneMesh> meshes{{1, makeBoxMesh(Vec3::Zero(), Vec3::Ones())}};
    EXPECT_NE(formatPovSolids(scene, Vec3(0.0, -5.0, 3.0), meshes)
                  .find("  // figure\n  #if (RunTime >= 0.5)\n"
                        "  object{Solid1 JadeLook()}\n  #end\n"),
              std::string::npos);
    EXPECT_EQ(
        messageOf<InputError>([&] { formatPovSolids(scene, Vec3(0.0, -5.0, 3.0)); }),
        "solid \"figure\": its mesh cannot be drawn: its triangles were not loaded");
    scene.solids[1].look = "none";
    EXPECT_NO_THROW(formatPovSolids(scene, Vec3(0.0, -5.0, 3.0)));
}

TEST(PovSolids, keepsANameWithinItsComment)
{
    SolidSpec box = makeBox(Vec3::Zero(), Vec3::Ones(), false, false);
    box.name = "a\n#error \"b\"";
    EXPECT_TRUE(drawSolid(box).starts_with("  // a #error \"b\"\n"));
}

TEST(PovSolids, writesNumbersThatPovRayReads)
{
    EXPECT_EQ(povNumber(-0.0), "0");
    EXPECT_EQ(povNumber(0.1), "0.1");
    EXPECT_EQ(povVector(Vec3(1.0, 2.0, 3.5)), "<1,3.5,2>");
    EXPECT_THROW(povNumber(std::nan("")), InternalError);
}

TEST(CameraFrame, letsTheHeapFillTwoThirdsOfTheWidth)
{
    for (double size : {0.01, 1.0, 30.0}) {
        Scene scene;
        const Box3 heap(Vec3(-size, -size, 0.0), Vec3(size, size, 0.4 * size));
        const CameraFrame camera = frameCamera(scene, heap);
        double left = 0.0;
        double right = 0.0;
        for (int k = 0; k < 360; ++k) {
            const double phi = k * kPi / 180.0;
            const Vec2 p =
                projectPoint(camera, Vec3(size * std::cos(phi), size * std::sin(phi), 0.0));
            left = std::min(left, p.x());
            right = std::max(right, p.x());
            EXPECT_LT(std::abs(p.y()), 0.95 * 9.0 / 16.0);
        }
        EXPECT_NEAR(0.5 * (right - left), 0.65, 0.04) << "size " << size;
        EXPECT_NEAR(left + right, 0.0, 0.03);
        EXPECT_LT(projectPoint(camera, Vec3(0.0, 0.0, 0.4 * size)).y(), 0.95 * 9.0 / 16.0);
    }
}

TEST(CameraFrame, showsNoHorizon)
{
    const CameraFrame camera =
        frameCamera(Scene(), Box3(Vec3(-1.0, -1.0, 0.0), Vec3(1.0, 1.0, 0.5)));
    const Vec3 forward = (camera.lookAt - camera.position).normalized();
    const double down = std::asin(-forward.z()) * 180.0 / kPi;
    const double halfHeight =
        std::atan(std::tan(camera.angle * kPi / 360.0) * 9.0 / 16.0) * 180.0 / kPi;
    EXPECT_GT(down, halfHeight + 5.0);
}

TEST(CameraFrame, keepsSolidsOfLimitedSizeInThePicture)
{
    Scene scene;
    scene.solids = {makeBox(Vec3(-1.0, -0.5, 0.0), Vec3(1.0, 0.5, 1.5), true, true)};
    const CameraFrame camera =
        frameCamera(scene, Box3(Vec3(-0.9, -0.5, 0.0), Vec3(0.9, 0.5, 0.3)));
    for (double x : {-1.0, 1.0}) {
        for (double y : {-0.5, 0.5}) {
            for (double z : {0.0, 1.5}) {
                const Vec2 p = projectPoint(camera, Vec3(x, y, z));
                EXPECT_LT(std::abs(p.x()), 1.0);
                EXPECT_LT(std::abs(p.y()), 9.0 / 16.0);
            }
        }
    }
}

TEST(CameraFrame, obeysTheScene)
{
    Scene scene;
    scene.camera.position = Vec3(1.0, 2.0, 3.0);
    scene.camera.lookAt = Vec3(0.0, 0.5, 0.0);
    scene.camera.angle = 50.0;
    const CameraFrame camera = frameCamera(scene, Box3(Vec3::Zero(), Vec3::Ones()));
    EXPECT_EQ(camera.position, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(camera.lookAt, Vec3(0.0, 0.5, 0.0));
    EXPECT_EQ(camera.angle, 50.0);
}

/// A bowl of revolution: a thin shell, 24 points around, standing at z = 0.
TriangleMesh makeBowlMesh(double radius, double height)
{
    TriangleMesh mesh;
    const std::vector<Vec2> profile{{0.3, 0.0}, {0.8, 0.5}, {1.0, 1.0}, {0.95, 1.0},
                                    {0.7, 0.5}, {0.0, 0.1}};
    constexpr std::uint32_t around = 24;
    const auto rows = static_cast<std::uint32_t>(profile.size());
    for (const Vec2& p : profile) {
        for (std::uint32_t k = 0; k < around; ++k) {
            const double phi = 2.0 * kPi * k / around;
            mesh.points.push_back(Vec3(radius * p.x() * std::cos(phi),
                                       radius * p.x() * std::sin(phi), height * p.y()));
        }
    }
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t k = 0; k < around; ++k) {
            const std::uint32_t a = row * around + k;
            const std::uint32_t b = row * around + (k + 1) % around;
            mesh.triangles.push_back({a, b, b + around});
            mesh.triangles.push_back({a, b + around, a + around});
        }
    }
    return mesh;
}

/// A scene with one mesh solid, for which it is the mesh.
Scene makeMeshScene(const std::string& look = "stone")
{
    Scene scene;
    scene.solids.resize(1);
    scene.solids[0].shape = SolidShape::mesh;
    scene.solids[0].look = look;
    return scene;
}

void expectInPicture(const CameraFrame& camera, const TriangleMesh& mesh)
{
    double highest = -1.0;
    double widest = 0.0;
    for (const Vec3& point : mesh.points) {
        const Vec2 p = projectPoint(camera, point);
        EXPECT_LT(std::abs(p.x()), 0.96);
        EXPECT_LT(std::abs(p.y()), 0.96 * 9.0 / 16.0);
        highest = std::max(highest, p.y());
        widest = std::max(widest, std::abs(p.x()));
    }
    // ... but it is not lost in it either.
    EXPECT_TRUE(highest > 0.35 || widest > 0.5) << highest << " " << widest;
}

TEST(CameraFrame, showsAFigureTallerThanTheSandWhole)
{
    for (const double height : {0.4, 1.0, 4.0}) {
        const std::vector<SceneMesh> meshes{
            {0, makeBoxMesh(Vec3(-0.2, -0.1, 0.0), Vec3(0.2, 0.1, height))}};
        const Box3 sand(Vec3(-0.5, -0.5, 0.0), Vec3(0.5, 0.5, 0.2));
        expectInPicture(frameCamera(makeMeshScene(), sand, meshes), meshes[0].mesh);
    }
}

TEST(CameraFrame, showsABowlAndTheSandInIt)
{
    const std::vector<SceneMesh> meshes{{0, makeBowlMesh(0.2, 0.12)}};
    for (const double filled : {0.03, 0.19}) {
        const Box3 sand(Vec3(-filled, -filled, 0.015), Vec3(filled, filled, 0.1));
        expectInPicture(frameCamera(makeMeshScene(), sand, meshes), meshes[0].mesh);
    }
}

TEST(CameraFrame, leavesOutLandscapesAndWhatIsNotDrawn)
{
    const Box3 sand(Vec3(-0.5, -0.5, 0.0), Vec3(0.5, 0.5, 0.2));
    const CameraFrame bare = frameCamera(Scene(), sand);
    const std::vector<SceneMesh> hills{
        {0, makeBoxMesh(Vec3(-20.0, -20.0, -1.0), Vec3(20.0, 20.0, 0.0))}};
    EXPECT_EQ(frameCamera(makeMeshScene(), sand, hills).position, bare.position);
    const std::vector<SceneMesh> hidden{{0, makeBoxMesh(Vec3::Zero(), Vec3::Ones())}};
    EXPECT_EQ(frameCamera(makeMeshScene("none"), sand, hidden).position, bare.position);
    EXPECT_NE(frameCamera(makeMeshScene(), sand, hidden).position, bare.position);
    EXPECT_EQ(measurePictureBox(makeMeshScene(), sand, hills).max(), sand.max());
    EXPECT_EQ(measurePictureBox(makeMeshScene(), sand, hidden).max(), Vec3::Ones());
}

TEST(SandBox, isEstimatedInsideABowlAndAroundAFigure)
{
    Scene scene = makeMeshScene();
    EmitterSpec jet;
    jet.position = Vec3(0.02, 0.0, 0.5);
    jet.count = 3000;
    scene.emitters = {jet};
    const std::vector<SceneMesh> bowl{{0, makeBowlMesh(0.1, 0.08)}};
    const Box3 inBowl = estimateSandBox(scene, bowl);
    EXPECT_GT(inBowl.min().z(), 0.008);  // its inner floor, a tenth of its height
    EXPECT_LT(inBowl.min().z(), 0.03);
    EXPECT_GE(inBowl.min().x(), -0.1);
    EXPECT_LE(inBowl.max().x(), 0.1);
    // The same sand without the bowl needs more room; a figure does not hold it.
    const Box3 onGround = estimateSandBox(scene);
    EXPECT_LT(onGround.min().x(), -0.1);
    const std::vector<SceneMesh> figure{
        {0, makeBoxMesh(Vec3(-0.05, -0.05, 0.0), Vec3(0.05, 0.05, 0.2))}};
    EXPECT_EQ(estimateSandBox(scene, figure).min(), onGround.min());
    EXPECT_EQ(estimateSandBox(scene, figure).max(), onGround.max());
}

TEST(SandBox, isEstimatedAsAHeapWhereAJetLands)
{
    Scene scene;
    EmitterSpec jet;
    jet.position = Vec3(0.0, 0.0, 0.5);
    jet.direction = Vec3::UnitX();
    jet.speed = 2.0;
    jet.count = 100'000;
    scene.emitters = {jet};
    const Box3 box = estimateSandBox(scene);
    // Falls 0.5 m in sqrt(2 h / g) = 0.319 s, meanwhile 0.639 m along x.
    EXPECT_NEAR(box.center().x(), 0.639, 0.001);
    EXPECT_NEAR(box.center().y(), 0.0, 1e-12);
    EXPECT_NEAR(box.min().z(), 0.0, 1e-12);
    // The cone in it holds the grains at 0.58 of its volume and stands at 26 degrees.
    const double radius = 0.5 * box.sizes().y();
    EXPECT_NEAR(kPi / 3.0 * radius * radius * box.sizes().z() * 0.58,
                1e5 * 4.0 / 3.0 * kPi * 0.005 * 0.005 * 0.005, 1e-6);
    EXPECT_NEAR(std::atan(box.sizes().z() / radius) * 180.0 / kPi, 26.0, 0.1);
}

TEST(SandBox, staysWithinAContainerAndOnItsFloor)
{
    Scene scene;
    scene.solids = {makeBox(Vec3(-0.1, -0.3, 0.05), Vec3(0.1, 0.3, 1.0), true, true)};
    EmitterSpec jet;
    jet.position = Vec3(0.0, 0.0, 0.9);
    jet.count = 100'000;
    scene.emitters = {jet};
    const Box3 box = estimateSandBox(scene);
    EXPECT_DOUBLE_EQ(box.min().z(), 0.05);
    EXPECT_DOUBLE_EQ(box.min().x(), -0.1);
    EXPECT_DOUBLE_EQ(box.max().y(), 0.3);
}

TEST(SandBox, isNeverEmptyAsAnEstimate)
{
    EXPECT_GT(estimateSandBox(Scene()).sizes().minCoeff(), 0.0);
}

TEST(SandBox, ignoresAFewGrainsThatRolledAway)
{
    Snapshot heap = makeHeap(4000);
    const Box3 before = measureSandBox(heap);
    heap.position[100].x() += 50.0;
    heap.position[200].y() -= 50.0;
    const Box3 after = measureSandBox(heap);
    EXPECT_LT((after.max() - before.max()).norm(), 0.01);
    EXPECT_LT((after.min() - before.min()).norm(), 0.01);
    EXPECT_TRUE(measureSandBox(Snapshot()).isEmpty());
}

TEST(PovScene, copiesTheHandWrittenFiles)
{
    TempFolder folder;
    writePovScene(folder.path(), kPovrayFolder, Scene(), {});
    for (const char* name : {"scene.pov", "scene.ini", "materials.inc", "lights.inc"}) {
        EXPECT_EQ(slurp(folder.file(name)), slurp(kPovrayFolder + "/" + name)) << name;
        EXPECT_TRUE(isPovSceneFileName(name));
    }
    EXPECT_TRUE(isPovSceneFileName("run_scene.inc"));
    EXPECT_EQ(folder.countEntries(), 5u);
    EXPECT_THROW(writePovScene(folder.path(), folder.file("none"), Scene(), {}), SystemError);
}

TEST(PovScene, writesEachMeshIntoAFileOfItsOwnOnce)
{
    TempFolder folder;
    Scene scene = makeMeshScene();
    scene.solids.push_back(scene.solids[0]);
    scene.solids[0].look = "none";
    const std::vector<SceneMesh> meshes{{1, makeBoxMesh(Vec3::Zero(), Vec3::Ones())},
                                        {0, makeBoxMesh(Vec3::Zero(), Vec3::Ones())}};
    writePovScene(folder.path(), kPovrayFolder, scene, {}, meshes);
    EXPECT_FALSE(std::filesystem::exists(folder.file("solid_0.inc")));
    const std::string text = slurp(folder.file("solid_1.inc"));
    EXPECT_NE(text.find("#declare Solid1 = mesh2{"), std::string::npos);
    EXPECT_NE(slurp(folder.file("run_scene.inc")).find("#include \"solid_1.inc\"\n"),
              std::string::npos);
    const auto written = std::filesystem::last_write_time(folder.file("solid_1.inc"));
    writePovScene(folder.path(), kPovrayFolder, scene, {}, meshes);
    EXPECT_EQ(std::filesystem::last_write_time(folder.file("solid_1.inc")), written);
    EXPECT_EQ(folder.countEntries(), 6u);

    TempFolder other;
    EXPECT_THROW(writePovScene(other.path(), kPovrayFolder, scene, {}), InputError);
    EXPECT_EQ(other.countEntries(), 0u);
}

TEST(PovScene, knowsItsMeshFiles)
{
    for (const char* name : {"solid_0.inc", "solid_17.inc"}) {
        EXPECT_TRUE(isPovSceneFileName(name)) << name;
    }
    for (const char* name : {"solid_.inc", "solid_01.inc", "solid_1.pov", "solid_x.inc",
                             "my_solid_1.inc", "solid_1234567890.inc", "solid_-1.inc"}) {
        EXPECT_FALSE(isPovSceneFileName(name)) << name;
    }
    EXPECT_EQ(povMeshFileName(17), "solid_17.inc");
}

TEST(PovScene, writesTheConstantsOfTheRun)
{
    Scene scene;
    scene.grains.radius = 0.01;
    scene.time.framesPerSecond = 25.0;
    scene.camera.position = Vec3(1.0, 2.0, 3.0);
    scene.camera.lookAt = Vec3(0.0, 0.5, 0.25);
    PovSceneInfo info;
    info.frameCount = 123;
    info.sand = Box3(Vec3(-0.5, -0.25, 0.0), Vec3(0.5, 0.25, 0.125));
    const std::string text = formatRunScene(scene, info);
    for (const char* line :
         {"#declare RadiusInMetres = 0.01;\n", "#declare NFrames = 123;\n",
          "#declare FramesPerSecond = 25;\n", "#declare SandMin = <-50,0,-25>;\n",
          "#declare SandMax = <50,12.5,25>;\n",
          "#declare CameraPosition = <100,300,200>;\n",
          "#declare CameraLookAt = <0,25,50>;\n", "#declare CameraAngle = 32;\n"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line;
    }
}

}  // namespace
}  // namespace sandflow
