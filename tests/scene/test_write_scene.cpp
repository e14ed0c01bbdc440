#include "scene/write_scene.h"

#include "random_scene.h"
#include "scene_equality.h"

#include <limits>

namespace sandflow {
namespace {

TEST(WriteScene, RandomScenesReadBackBitForBit)
{
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = RandomScene(seed).make();
        const std::string text = writeScene(scene);
        Scene back;
        ASSERT_NO_THROW(back = parseScene(text, "back.toml")) << text;
        expectSame(scene, back);
        EXPECT_EQ(writeScene(back), text);
        if (HasFailure()) {
            break;
        }
    }
}

TEST(WriteScene, DirectionsFromAFileKeepTheirBitsFromThenOn)
{
    RandomScene random(7);
    for (int i = 0; i < 300; ++i) {
        Scene scene = random.make();
        scene.emitters[0].direction *= std::pow(10.0, i % 21 - 10);
        const Scene first = parseScene(writeScene(scene), "s.toml");
        const Scene second = parseScene(writeScene(first), "s.toml");
        expectSameBits(first.emitters[0].direction, second.emitters[0].direction);
        EXPECT_NEAR(first.emitters[0].direction.norm(), 1.0, 1e-15);
    }
}

TEST(WriteScene, ExtremeDoublesSurvive)
{
    Scene scene = parseScene(kJet, "s.toml");
    for (const double value : {5e-324, 2.2250738585072014e-308, 0.1, 1.0 / 3.0, 1e-5, 123456789.0,
                               999999999.9999999, 1e9}) {
        scene.emitters[0].rate = value;
        expectSameBits(parseScene(writeScene(scene), "s.toml").emitters[0].rate, value);
    }
    scene.gravity = Vec3(-0.0, 0.0, -1e-300);
    expectSameBits(parseScene(writeScene(scene), "s.toml").gravity, scene.gravity);
}

TEST(WriteScene, WritesEveryDefaultAndLeavesOutWhatIsOpenOrAbsent)
{
    const std::string text = writeScene(parseScene(kOneGrain, "one.toml"));
    for (const char* line :
         {"name = \"one\"\n", "mode = \"surface-flow\"\n", "precision = \"float\"\n", "seed = 1\n",
          "gravity = [0.0, 0.0, -9.81]\n", "[grains]\nradius = 0.005\n", "density = 2600.0\n",
          "stiffness = \"auto\"\n", "tangential_ratio = 0.2857142857142857\n",
          "[surface_flow]\ninterval = 0.02\n", "[skip]\nsleep = true\n",
          "[[emitters]]\nkind = \"single\"\n", "spin = [0.0, 0.0, 0.0]\n"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line << "is not in\n" << text;
    }
    for (const char* word : {"domain", "until", "duration", "look_at", "slope_angle", "\nrate ="}) {
        EXPECT_EQ(text.find(word), std::string::npos) << word << " is in\n" << text;
    }
}

TEST(WriteScene, RefusesWhatNoFileCanHold)
{
    Scene scene = parseScene(kJet, "s.toml");
    scene.seed = std::uint64_t{1} << 63;
    EXPECT_THROW(writeScene(scene), InternalError);
    scene.seed = 1;
    scene.grains.radius = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(writeScene(scene), InternalError);
    scene.grains.radius = 0.005;
    scene.solids.emplace_back().look = "gold";
    EXPECT_THROW(writeScene(scene), InternalError);
    scene.solids.back().look = "glass";
    EXPECT_NO_THROW(writeScene(scene));
}

}  // namespace
}  // namespace sandflow
