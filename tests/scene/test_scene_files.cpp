#include "scene/scene_reference.h"
#include "scene/write_scene.h"

#include "scene_equality.h"

#include <filesystem>

namespace sandflow {
namespace {

TEST(SceneFiles, FloorIsThePublishedScene)
{
    const Scene scene = readScene(kSceneDir + "floor.toml");
    EXPECT_EQ(scene.name, "floor");
    EXPECT_EQ(scene.grains.radius, 0.005);
    EXPECT_EQ(scene.grains.sizeSpread, 0.08);
    EXPECT_EQ(scene.grains.density, 2600.0);
    EXPECT_EQ(scene.contact.friction, 0.5);
    EXPECT_EQ(scene.contact.rollingFriction, 0.1);
    EXPECT_EQ(scene.contact.restitution, 0.3);
    EXPECT_EQ(scene.time.framesPerSecond, 30.0);
    EXPECT_EQ(scene.time.settle, 1.0);
    ASSERT_EQ(scene.solids.size(), 1U);
    EXPECT_EQ(scene.solids[0].shape, SolidShape::plane);
    EXPECT_TRUE(scene.solids[0].rough);
    EXPECT_EQ(scene.solids[0].point.z(), 0.0);
    EXPECT_EQ(scene.solids[0].normal, Vec3::UnitZ());
    ASSERT_EQ(scene.emitters.size(), 1U);
    const EmitterSpec& jet = scene.emitters[0];
    EXPECT_EQ(jet.kind, EmitterKind::jet);
    EXPECT_EQ(jet.count, 107687);
    EXPECT_EQ(jet.rate, 10700.0);
    EXPECT_EQ(jet.radius, 0.07);
    EXPECT_EQ(jet.position, Vec3(0, 0, 0.5));
    EXPECT_EQ(jet.direction, -Vec3::UnitZ());
    EXPECT_EQ(jet.speed, 1.6);
}

TEST(SceneFiles, SmallFloorIsAQuickOne)
{
    const Scene scene = readScene(kSceneDir + "small_floor.toml");
    ASSERT_EQ(scene.emitters.size(), 1U);
    EXPECT_EQ(scene.emitters[0].count, 5000);
    EXPECT_EQ(scene.emitters[0].rate, 3000.0);
    EXPECT_EQ(scene.emitters[0].radius, 0.05);
    EXPECT_EQ(scene.emitters[0].position, Vec3(0, 0, 0.4));
    EXPECT_EQ(scene.emitters[0].speed, 1.0);
    ASSERT_EQ(scene.solids.size(), 1U);
    EXPECT_TRUE(scene.solids[0].rough);
}

TEST(SceneFiles, EverySceneReadsAndReadsBack)
{
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kSceneDir)) {
        if (entry.path().extension() == ".toml") {
            SCOPED_TRACE(entry.path());
            const Scene scene = readScene(entry.path().string());
            expectSame(scene, parseScene(writeScene(scene), "again.toml"));
            ++scenes;
        }
    }
    EXPECT_GE(scenes, 2);
}

TEST(SceneFiles, TheReadmeHoldsTheReferenceOfThisProgram)
{
    const std::string readme = readText(kSceneDir + "README.md");
    const std::string expected = writeSceneReference();
    const std::string path = testing::TempDir() + "scene_reference.md";
    if (readme.find(expected) == std::string::npos) {
        std::ofstream(path) << expected;
        ADD_FAILURE() << "scenes/README.md differs from the program; the right text of its "
                         "reference part is in "
                      << path;
    }
}

TEST(SceneFiles, TheReadmesExamplesRead)
{
    const std::string readme = readText(kSceneDir + "README.md");
    const std::string fence = "```toml\n";
    int examples = 0;
    for (auto at = readme.find(fence); at != std::string::npos; at = readme.find(fence, at)) {
        at += fence.size();
        const std::string text = readme.substr(at, readme.find("```", at) - at);
        EXPECT_NO_THROW(parseScene(text, "example.toml")) << text;
        ++examples;
    }
    EXPECT_EQ(examples, 2);
}

}  // namespace
}  // namespace sandflow
