#include "scene/repose_table.h"
#include "scene/write_scene.h"
#include "scene_support.h"

namespace sandflow {
namespace {

Scene withContact(const std::string& keys, const std::vector<std::string>& overrides = {})
{
    return parseScene(kJet + "[contact]\n" + keys, "s.toml", overrides);
}

double angleOf(const Scene& scene)
{
    return measuredRepose().angle(scene.contact.friction, scene.contact.rollingFriction);
}

TEST(SolveFriction, RollingFrictionUnlessItIsGiven)
{
    for (const char* keys : {"repose_angle = 26\n", "repose_angle = 26\nfriction = 0.5\n",
                             "repose_angle = 26\nrolling_friction = \"auto\"\n"}) {
        SCOPED_TRACE(keys);
        const Scene scene = withContact(keys);
        EXPECT_EQ(scene.contact.friction, 0.5);
        EXPECT_GT(scene.contact.rollingFriction, 0.0);
        EXPECT_LT(scene.contact.rollingFriction, 0.1) << "heaps of 0.5 and 0.1 stand at 28";
        EXPECT_NEAR(angleOf(scene), 26.0, 1e-9);
        EXPECT_EQ(scene.contact.reposeAngle, 26.0);
    }
    const Scene other = withContact("repose_angle = 26\nfriction = 0.8\n");
    EXPECT_EQ(other.contact.friction, 0.8);
    EXPECT_NEAR(angleOf(other), 26.0, 1e-9);
}

TEST(SolveFriction, FrictionWhereOnlyRollingFrictionIsGivenOrItIsAuto)
{
    for (const char* keys :
         {"repose_angle = 24\nrolling_friction = 0.1\n", "repose_angle = 24\nfriction = \"auto\"\n",
          "repose_angle = 24\nfriction = \"auto\"\nrolling_friction = 0.1\n"}) {
        SCOPED_TRACE(keys);
        const Scene scene = withContact(keys);
        EXPECT_EQ(scene.contact.rollingFriction, 0.1);
        EXPECT_GT(scene.contact.friction, 0.1);
        EXPECT_LT(scene.contact.friction, 0.5) << "heaps of 0.5 and 0.1 stand at 28";
        EXPECT_NEAR(angleOf(scene), 24.0, 1e-9);
    }
}

TEST(SolveFriction, OnTheCommandLineOverAFileThatGivesBoth)
{
    const Scene scene = withContact("friction = 0.6\nrolling_friction = 0.3\n",
                                    {"contact.repose_angle=27", "contact.rolling_friction=auto"});
    EXPECT_EQ(scene.contact.friction, 0.6);
    EXPECT_NEAR(angleOf(scene), 27.0, 1e-9);
}

TEST(SolveFriction, WhatWasSolvedIsWrittenWhatWasAskedIsNot)
{
    const Scene scene = withContact("repose_angle = 26\n");
    const std::string text = writeScene(scene);
    EXPECT_NE(text.find("\nrolling_friction = 0.0"), std::string::npos) << text;
    const Scene back = parseScene(text, "back.toml");
    EXPECT_EQ(bitsOf(back.contact.rollingFriction), bitsOf(scene.contact.rollingFriction));
    EXPECT_FALSE(back.contact.reposeAngle.has_value());
}

TEST(SolveFriction, RefusesAnglesOutOfReachAndSaysWhatIsInReach)
{
    const auto reach = measuredRepose().reachByRolling(0.2);
    const std::string steep = refusalOf(kJet + "[contact]\nrepose_angle = 44\nfriction = 0.2\n");
    EXPECT_TRUE(
        steep.starts_with("s.toml:9:16: contact.repose_angle: is 44, but with "
                          "contact.friction = 0.2 heaps stand at " +
                          fmt::format("{:.4g} to {:.4g} degrees", reach.low, reach.high)))
        << steep;
    EXPECT_NE(steep.find("expected an angle in that range or another contact.friction: with 0.1 "
                         "to 1, heaps of "),
              std::string::npos)
        << steep;
    const std::string flat =
        refusalOf(kJet, {"contact.repose_angle=5", "contact.rolling_friction=0.1"});
    EXPECT_TRUE(
        flat.starts_with("--set contact.repose_angle=5: is 5, but with "
                         "contact.rolling_friction = 0.1 heaps stand at "))
        << flat;
}

TEST(SolveFriction, RefusesAGivenCoefficientThatWasNotMeasured)
{
    EXPECT_EQ(refusalOf(kJet + "[contact]\nrepose_angle = 30\nfriction = 5\n"),
              "s.toml:10:12: contact.friction: is 5, expected 0.1 to 1, where heaps were measured, "
              "as contact.rolling_friction is solved for contact.repose_angle");
    EXPECT_EQ(refusalOf(kJet + "[contact]\nrepose_angle = 30\nrolling_friction = 2\n"),
              "s.toml:10:20: contact.rolling_friction: is 2, expected 0 to 0.4, where heaps were "
              "measured, as contact.friction is solved for contact.repose_angle");
}

TEST(SolveFriction, RefusesKeysThatDoNotGoTogether)
{
    EXPECT_EQ(refusalOf(kJet + "[contact]\nfriction = 0.5\nrolling_friction = 0.1\n"
                               "repose_angle = 30\n"),
              "s.toml:11:16: contact.repose_angle: is given beside friction and rolling_friction, "
              "expected one of these to be \"auto\" or absent");
    EXPECT_EQ(refusalOf(kJet + "[contact]\nfriction = \"auto\"\nrolling_friction = \"auto\"\n"
                               "repose_angle = 30\n"),
              "s.toml:9:12: contact.friction: is \"auto\" like rolling_friction, expected a number "
              "for one of the two");
    EXPECT_EQ(refusalOf(kJet + "[contact]\nrolling_friction = \"auto\"\n"),
              "s.toml:9:20: contact.rolling_friction: is \"auto\", expected contact.repose_angle, "
              "for which it is solved");
    EXPECT_EQ(refusalOf(kJet + "[contact]\nfriction = \"automatic\"\n"),
              "s.toml:9:12: contact.friction: is \"automatic\", expected \"auto\" or a number from "
              "0 to 10");
    EXPECT_EQ(refusalOf(kJet + "[contact]\nrepose_angle = 90\n"),
              "s.toml:9:16: contact.repose_angle: is 90, expected a number above 0 and below 90 "
              "degrees");
}

}  // namespace
}  // namespace sandflow
