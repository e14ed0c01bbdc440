#include "emit_support.h"

namespace sandflow {
namespace {

using testing::makeFloorScene;
using testing::makeScene;

SolidSpec makePlane(const Vec3& point, const Vec3& normal)
{
    SolidSpec plane;
    plane.point = point;
    plane.normal = normal.normalized();
    return plane;
}

double speedAfterFall(double speed, double height)
{
    return std::sqrt(speed * speed + 2.0 * kGravity * height);
}

TEST(SceneLimits, FloorSceneFallsFromTheJetToTheFloor)
{
    Scene scene = makeFloorScene();
    scene.solids.push_back(makePlane(Vec3::Zero(), Vec3::UnitZ()));
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 0.5), 1e-12);
    // A wall changes nothing; a box, a disc and an upright cylinder below the floor do.
    scene.solids.push_back(makePlane(Vec3(0.5, 0.0, -9.0), -Vec3::UnitX()));
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 0.5), 1e-12);
    SolidSpec box;
    box.shape = SolidShape::box;
    box.min = Vec3(0.0, 0.0, -1.0);
    box.max = Vec3(1.0, 1.0, -0.5);
    scene.solids.push_back(box);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 1.5), 1e-12);
    SolidSpec disc;
    disc.shape = SolidShape::disc;
    disc.point = Vec3(0.0, 0.0, -2.0);
    disc.radius = 0.3;
    scene.solids.push_back(disc);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 2.5), 1e-12);
    SolidSpec cylinder = disc;
    cylinder.shape = SolidShape::cylinder;
    cylinder.point.z() = -2.5;
    cylinder.height = 1.0;
    scene.solids.push_back(cylinder);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 3.0), 1e-12);
    // Below the domain nothing is hit any more.
    scene.domain.min.z() = -0.7;
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 1.2), 1e-12);
}

TEST(SceneLimits, WithoutSolidsGrainsCanMeetDownToTheLowestEmitter)
{
    Scene scene = makeFloorScene();
    EXPECT_NEAR(fastestPossibleSpeed(scene), 1.6, 1e-12);
    EmitterSpec single;
    single.kind = EmitterKind::single;
    single.position = Vec3(0.0, 0.0, -0.25);
    scene.emitters.push_back(single);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 0.75), 1e-12);
}

TEST(SceneLimits, TheFastestEmitterCountsFromItsHighestPoint)
{
    EmitterSpec block;
    block.kind = EmitterKind::block;
    block.count = 1;
    block.min = Vec3::Zero();
    block.max = Vec3(1.0, 1.0, 2.0);
    block.velocity = Vec3(3.0, 0.0, 0.0);
    Scene scene = makeScene(block);
    scene.solids.push_back(makePlane(Vec3::Zero(), Vec3::UnitZ()));
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(3.0, 2.0), 1e-12);
    EmitterSpec jet = makeFloorScene().emitters[0];
    jet.direction = Vec3::UnitX();  // the disc stands upright and reaches 0.07 m higher
    jet.position.z() = 4.0;
    scene.emitters.push_back(jet);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(1.6, 4.07), 1e-12);
    scene.gravity.setZero();
    EXPECT_NEAR(fastestPossibleSpeed(scene), 3.0, 1e-12);
}

TEST(SceneLimits, InclineIsMetStraightBelow)
{
    EmitterSpec single;
    single.kind = EmitterKind::single;
    single.position = Vec3(1.0, 0.0, 3.0);
    Scene scene = makeScene(single);
    scene.solids.push_back(makePlane(Vec3::Zero(), Vec3(-1.0, 0.0, 1.0)));  // z = x
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(0.0, 2.0), 1e-12);
    // Tilting gravity instead: 3 m up a floor's normal are 3 sqrt(2) m along gravity.
    scene.solids[0] = makePlane(Vec3::Zero(), Vec3::UnitZ());
    scene.gravity = Vec3(kGravity, 0.0, -kGravity) / std::sqrt(2.0);
    EXPECT_NEAR(fastestPossibleSpeed(scene), speedAfterFall(0.0, 3.0 * std::sqrt(2.0)), 1e-12);
}

TEST(SceneLimits, LastEmissionIsTheLatestOfAll)
{
    Scene scene = makeFloorScene();
    const double jet = lastEmissionTime(scene);
    EXPECT_NEAR(jet, 107687.0 / 10700.0, 0.008);
    EmitterSpec single;
    single.kind = EmitterKind::single;
    single.start = 30.0;
    scene.emitters.push_back(single);
    EXPECT_EQ(lastEmissionTime(scene), 30.0);
    EXPECT_EQ(lastEmissionTime(Scene{}), 0.0);
}

}  // namespace
}  // namespace sandflow
