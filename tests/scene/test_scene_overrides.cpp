#include "scene_support.h"

namespace sandflow {
namespace {

const std::string kFloor = kJet + "[[solids]]\nshape = \"plane\"\n";

Scene override(const std::vector<std::string>& overrides)
{
    return parseScene(kFloor, "s.toml", overrides);
}

TEST(SceneOverrides, ReplaceAndAddValues)
{
    const Scene scene =
        override({"surface_flow.repose_angle=30", "emitters[0].rate=5000", "solids[0].rough=false",
                  "mode=\"dem\"", "name=\"two words\"", "gravity=[0, 0, -1.62]", "gravity[0]=0.5",
                  "seed = 7", "solids[0].look=glass", "contact.stiffness=auto", "seed=8"});
    EXPECT_EQ(scene.surfaceFlow.reposeAngle, 30.0);
    EXPECT_EQ(scene.emitters[0].rate, 5000.0);
    EXPECT_FALSE(scene.solids[0].rough);
    EXPECT_EQ(scene.mode, Mode::dem);
    EXPECT_EQ(scene.name, "two words");
    EXPECT_EQ(scene.gravity, Vec3(0.5, 0.0, -1.62));
    EXPECT_EQ(scene.seed, 8U) << "the last one wins";
    EXPECT_EQ(scene.solids[0].look, "glass");
    EXPECT_FALSE(scene.contact.stiffness.has_value());
}

TEST(SceneOverrides, BareWordsAreStrings)
{
    EXPECT_EQ(override({"mode=dem"}).mode, Mode::dem);
    EXPECT_EQ(override({"contact.law=bell-yu-mucha"}).contact.law, NormalLaw::bellYuMucha);
    EXPECT_EQ(override({"solids[0]={shape=\"mesh\", mesh=\"x\"}", "solids[0].mesh=../a/b.obj"})
                  .solids[0]
                  .mesh,
              "../a/b.obj");
}

TEST(SceneOverrides, ReplaceWholeLists)
{
    const Scene scene =
        override({"emitters=[{kind=\"single\", position=[0,0,1]}, {kind=\"pile\", count=9}]",
                  "emitters[1].count=10", "solids=[]"});
    ASSERT_EQ(scene.emitters.size(), 2U);
    EXPECT_EQ(scene.emitters[1].count, 10);
    EXPECT_TRUE(scene.solids.empty());
}

TEST(SceneOverrides, PassTheSameChecksAndNameThemselves)
{
    const auto refusal = [](const std::string& text) { return refusalOf(kFloor, {text}); };
    EXPECT_EQ(refusal("emitters[0].rte=5"),
              "--set emitters[0].rte=5: unknown key (did you mean \"rate\"?)");
    EXPECT_EQ(refusal("grains.radius=-1"),
              "--set grains.radius=-1: is -1, expected a number from 1e-05 to 1 m");
    EXPECT_EQ(refusal("grains.radius=nan"),
              "--set grains.radius=nan: is not a number (nan), expected a number from 1e-05 to 1 "
              "m");
    EXPECT_EQ(refusal("grains.radius=0.5.3"),
              "--set grains.radius=0.5.3: is a string, expected a number from 1e-05 to 1 m");
    EXPECT_EQ(refusal("mode=den"), "--set mode=den: is \"den\" (did you mean \"dem\"?)");
    EXPECT_EQ(refusal("gravity=[0,0,a]"),
              "--set gravity=[0,0,a]: is not a value, expected a number, a word, true, false, "
              "\"text\" or [x, y, z]");
    EXPECT_EQ(refusal("gravity=[0,0,true]"),
              "--set gravity=[0,0,true]: gravity[2]: is a boolean, expected a number from -1000 to "
              "1000");
    EXPECT_EQ(refusal("colours.red=1"),
              "--set colours.red=1: colours: unknown key (expected one of name, mode, precision, "
              "seed, gravity, domain, grains, contact, time, surface_flow, skip, camera, solids, "
              "emitters)");
    EXPECT_EQ(refusal("solids[0].radius=1"),
              "--set solids[0].radius=1: does not belong to a plane, only to cylinder, disc");
    EXPECT_EQ(refusal("emitters=[]"),
              "--set emitters=[]: there is none, expected at least one [[emitters]]");
    EXPECT_EQ(refusal("emitters[0]={kind=\"pile\"}"),
              "--set emitters[0]={kind=\"pile\"}: emitters[0].count: is missing, expected an "
              "integer from 1 to 4000000000 grains");
    EXPECT_EQ(refusalOf(kFloor, {"solids[0].until=1", "solids[0].from=2"}),
              "--set solids[0].until=1: it is gone at 1 s but exists from 2 s, expected until "
              "above from");
    EXPECT_EQ(refusalOf(kFloor + "until = 1\n", {"solids[0].from=2"}),
              "--set solids[0].from=2: it is gone at 1 s but exists from 2 s, expected until above "
              "from");
}

TEST(SceneOverrides, AChangeThatBreaksAnotherKeyPointsThere)
{
    EXPECT_EQ(refusalOf(kFloor, {"emitters[0].kind=slot"}),
              "s.toml:7:1: emitters[0].radius: does not belong to a slot, only to jet, single");
}

TEST(SceneOverrides, KeysThatLeadNowhere)
{
    const auto refusal = [](const std::string& text) { return refusalOf(kFloor, {text}); };
    EXPECT_EQ(refusal("emitters[1].rate=5"),
              "--set emitters[1].rate=5: emitters has 1 element, counted from 0");
    EXPECT_EQ(refusal("emitters.rate=5"),
              "--set emitters.rate=5: emitters is an array, expected a table");
    EXPECT_EQ(refusal("camera[0].angle=5"),
              "--set camera[0].angle=5: the scene file has no camera");
    EXPECT_EQ(refusal("emitters[0].rate.x=5"),
              "--set emitters[0].rate.x=5: emitters[0].rate is an integer, expected a table");
    EXPECT_EQ(refusal("emitters[0].rate[0]=5"),
              "--set emitters[0].rate[0]=5: emitters[0].rate is an integer, expected an array");
    EXPECT_EQ(refusal("seed"),
              "--set seed: has no \"=\", expected KEY=VALUE such as grains.radius=0.004");
    EXPECT_EQ(refusal("seed="),
              "--set seed=: has no value, expected KEY=VALUE such as grains.radius=0.004");
    for (const char* text :
         {"=5", "a..b=5", ".a=5", "a.=5", "a[=5", "a[]=5", "a[x]=5", "a[-1]=5", "a[0=5", "[0]=5",
          "a[99999999999999999999999]=5", "a b=5", "a]=5", "\"seed\"=5"}) {
        EXPECT_EQ(refusal(text), std::string("--set ") + text +
                                     ": is not a valid key, expected one such as mode, "
                                     "grains.radius or emitters[0].rate");
    }
}

TEST(SceneOverrides, AValueCannotSmuggleInAnotherKey)
{
    EXPECT_EQ(refusalOf(kFloor, {"seed=1\nname=\"x\""}),
              "--set seed=1\\u000Aname=\"x\": is not a value, expected a number, a word, true, "
              "false, \"text\" or [x, y, z]");
}

}  // namespace
}  // namespace sandflow
