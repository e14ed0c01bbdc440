#include "app/json_reader.h"
#include "app/program.h"

#include <cmath>

namespace sandflow {
namespace {

class Check : public ProgramTest {
protected:
    /// Every doubt about a scene, each on its line.
    std::string doubtsOf(const std::string& scene, const std::string& arguments = "") const
    {
        write("doubtful.toml", scene);
        const ProgramResult result = call("check doubtful.toml --json " + arguments);
        EXPECT_EQ(result.exitCode, 0) << result.errors;
        const JsonScalars json(result.output);
        std::string doubts;
        for (int n = 0; json.has("doubts[" + std::to_string(n) + "]"); ++n) {
            doubts += json.text("doubts[" + std::to_string(n) + "]") + "\n";
        }
        return doubts;
    }
};

constexpr const char* kFloor = "[[solids]]\nshape = \"plane\"\nname = \"ground\"\n";

std::string spout(const std::string& count, const std::string& rate, const std::string& position)
{
    return "[[emitters]]\nkind = \"jet\"\nname = \"spout\"\ncount = " + count + "\nrate = " + rate +
           "\nposition = " + position + "\nradius = 0.03\nspeed = 1.0\n";
}

TEST_F(Check, PrintsSizesStepAndNoDoubtsOfASoundScene)
{
    writeTinyScene("tiny.toml");
    const ProgramResult result = call("check tiny.toml");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    for (const char* part : {"tiny: can run, in surface-flow mode", "200 in all", "12 frames",
                             "\nstep ", "contact.stiffness", "bound", "440 bytes a computed grain",
                             "doubts     none"}) {
        EXPECT_NE(result.output.find(part), std::string::npos) << part << "\n" << result.output;
    }
    EXPECT_FALSE(exists("runs"));
}

TEST_F(Check, NumbersAreThoseOfTheScene)
{
    writeTinyScene("tiny.toml");
    const JsonScalars json(call("check tiny.toml --json --mode dem").output);
    EXPECT_EQ(json.text("mode"), "dem");
    EXPECT_EQ(json.number("grains"), 200);
    EXPECT_EQ(json.number("frames"), 12);
    EXPECT_EQ(json.text("emitters[0].kind"), "jet");
    EXPECT_EQ(json.number("emitters[0].grains"), 200);
    EXPECT_NEAR(json.number("emitters[0].end_s"), 0.2, 0.02);
    // v^2 = 1^2 + 2 g 0.1 m
    EXPECT_NEAR(json.number("load.fastest_speed_m_s"), std::sqrt(1.0 + 0.2 * 9.81), 1e-9);
    EXPECT_LT(json.number("step.step_s"), json.number("step.bound_s"));
    EXPECT_NEAR(json.number("stiffness.impact_overlap_r"), 0.3, 1e-6);
    EXPECT_FALSE(json.has("doubts[0]"));

    // Grains grow to 200 over the first 0.2 s of 0.4: some 7 full and 5 growing frames.
    const double steps = json.number("step.per_frame");
    EXPECT_NEAR(json.number("costs.grain_steps"), 200.0 * (7 + 0.5 * 5) * steps,
                0.1 * 200.0 * 12 * steps);
    EXPECT_NEAR(json.number("costs.frame_bytes"), 33.0 * json.number("costs.grain_steps") / steps,
                1.0);
    const JsonScalars hybrid(call("check tiny.toml --json").output);
    EXPECT_LT(hybrid.number("costs.memory_bytes"), json.number("costs.memory_bytes"));
}

TEST_F(Check, OverridesCount)
{
    writeTinyScene("tiny.toml");
    const JsonScalars json(
        call("check tiny.toml --json --set emitters[0].count=50 --set time.duration=1").output);
    EXPECT_EQ(json.number("grains"), 50);
    EXPECT_EQ(json.number("frames"), 30);
}

TEST_F(Check, SaysHowSteepTheSandStandsAndWhereTheta0ComesFrom)
{
    writeTinyScene("tiny.toml");
    const ProgramResult given = call("check tiny.toml");
    for (const char* part : {"repose     heaps of friction 0.5 and rolling friction 0.1 stand at",
                             "theta0 36 degrees: 36 from surface_flow.repose_angle, 0 added"}) {
        EXPECT_NE(given.output.find(part), std::string::npos) << part << "\n" << given.output;
    }
    EXPECT_EQ(call("check tiny.toml --mode dem").output.find("theta0"), std::string::npos);

    const JsonScalars soft(
        call("check tiny.toml --json --set surface_flow.repose_angle=auto "
             "--set contact.repose_angle=25").output);
    EXPECT_NEAR(soft.number("repose.expected_deg"), 25.0, 1e-9);
    EXPECT_NEAR(soft.number("repose.theta0_deg"), 33.0, 1e-9);
    EXPECT_EQ(soft.text("repose.measured"), "true");
    EXPECT_FALSE(soft.has("doubts[0]"));

    const ProgramResult steep = call("check tiny.toml --set contact.repose_angle=60");
    EXPECT_EQ(steep.exitCode, 2);
    EXPECT_NE(steep.errors.find("heaps stand at"), std::string::npos) << steep.errors;
}

TEST_F(Check, DoubtsASlopeThatTheSandCannotHave)
{
    const std::string sound = kFloor + spout("10", "100", "[0, 0, 0.1]");
    EXPECT_NE(doubtsOf(sound, "--set surface_flow.repose_angle=25").find("erode for ever"),
              std::string::npos);
    EXPECT_NE(doubtsOf(sound, "--set surface_flow.repose_angle=auto --set contact.friction=4")
                  .find("were not measured"),
              std::string::npos);
    EXPECT_EQ(doubtsOf(sound, "--set contact.friction=4"), "");
}

TEST_F(Check, RefusesWhatCannotRun)
{
    writeTinyScene("tiny.toml");
    const ProgramResult soft = call("check tiny.toml --set contact.stiffness=1");
    EXPECT_EQ(soft.exitCode, 2);
    EXPECT_NE(soft.errors.find("is needed"), std::string::npos) << soft.errors;
    EXPECT_EQ(soft.output, "");
    const ProgramResult dense = call("check tiny.toml --set emitters[0].rate=1e6");
    EXPECT_EQ(dense.exitCode, 2);
    EXPECT_NE(dense.errors.find("does not fit"), std::string::npos) << dense.errors;
}

TEST_F(Check, DoubtsASceneWithoutAFloor)
{
    EXPECT_NE(doubtsOf(spout("10", "100", "[0, 0, 0.5]")).find("no floor below"),
              std::string::npos);
    // Half of the opening is beyond the table's edge.
    const std::string table = "[[solids]]\nshape = \"box\"\nmin = [0, -1, -0.1]\nmax = [1, 1, 0]\n";
    EXPECT_NE(doubtsOf(table + spout("10", "100", "[0, 0, 0.5]")).find("some of its grains fall"),
              std::string::npos);
    EXPECT_EQ(doubtsOf(table + spout("10", "100", "[0.5, 0, 0.5]")), "");
}

TEST_F(Check, FollowsAJetDownAWall)
{
    // A level jet hits a pane and slides down to the floor behind its foot.
    const std::string jet = spout("10", "100", "[0, 0, 0.5]") + "direction = [1, 0, 0]\n";
    const std::string pane = "[[solids]]\nshape = \"box\"\nmin = [0.2, -1, 0]\nmax = [0.3, 1, 1]\n";
    EXPECT_EQ(doubtsOf(kFloor + pane + jet), "");
    EXPECT_NE(doubtsOf(pane + jet).find("all of its grains fall"), std::string::npos);
}

TEST_F(Check, DoubtsAWallHitFasterThanThoughtOf)
{
    // With nothing to land on, no fall counts; but 3 m away the jet has fallen for 3 s.
    const std::string wall =
        "[[solids]]\nshape = \"plane\"\nname = \"cliff\"\nrough = false\n"
        "point = [3, 0, 0]\nnormal = [-1, 0, 0]\n";
    const std::string jet = spout("10", "100", "[0, 0, 0.5]") + "direction = [1, 0, 0]\n";
    const std::string doubts = doubtsOf(wall + jet);
    EXPECT_NE(doubts.find("hits solids[0] (\"cliff\") at 29."), std::string::npos) << doubts;
}

TEST_F(Check, SettledSandInAContainerIsSound)
{
    const std::string box =
        "[[solids]]\nshape = \"box\"\nhollow = true\nfloor = true\n"
        "min = [0, 0, 0]\nmax = [0.2, 0.2, 0.3]\n";
    const std::string fill =
        "[[emitters]]\nkind = \"fill\"\ncount = 500\n"
        "min = [0, 0, 0]\nmax = [0.2, 0.2, 0.3]\n";
    EXPECT_EQ(doubtsOf(box + fill), "");
    EXPECT_EQ(doubtsOf(kFloor + fill), "");
    EXPECT_NE(doubtsOf("[domain]\nmin = [0.1, -1, -1]\nmax = [1, 1, 1]\n" + box + fill)
                  .find("outside the domain"),
              std::string::npos);
}

TEST_F(Check, DoubtsAnEmitterInsideASolid)
{
    EXPECT_NE(doubtsOf(kFloor + spout("10", "100", "[0, 0, -0.2]"))
                  .find("lies inside solids[0] (\"ground\")"),
              std::string::npos);
}

TEST_F(Check, DoubtsWeakContacts)
{
    const std::string sound = kFloor + spout("10", "100", "[0, 0, 0.1]");
    EXPECT_EQ(doubtsOf(sound), "");
    EXPECT_NE(doubtsOf(sound, "--set contact.restitution=0.02").find("contact.restitution = 0.02"),
              std::string::npos);
    EXPECT_NE(doubtsOf(sound, "--set contact.friction=0").find("contact.friction = 0"),
              std::string::npos);
    EXPECT_NE(doubtsOf(sound, "--set solids[0].rough=false").find("smooth floor"),
              std::string::npos);
    EXPECT_NE(doubtsOf(sound, "--set time.duration=0.05").find("some never come"),
              std::string::npos);
}

TEST_F(Check, DoubtsARateNearTheMostThatFits)
{
    const std::string scene = kFloor + spout("500", "100", "[0, 0, 0.1]");
    EXPECT_EQ(doubtsOf(scene), "");
    // The refusal says what fits; a little less is doubted, half of it is not.
    write("dense.toml", scene);
    const std::string refusal = call("check dense.toml --set emitters[0].rate=1e5").errors;
    const std::size_t at = refusal.find("the largest that fits is ");
    ASSERT_NE(at, std::string::npos) << refusal;
    const double most = std::stod(refusal.substr(at + 25));
    const auto rate = [most](double share) {
        return "--set emitters[0].rate=" + std::to_string(share * most);
    };
    EXPECT_NE(doubtsOf(scene, rate(0.97)).find("of the most that fits"), std::string::npos);
    EXPECT_EQ(doubtsOf(scene, rate(0.5)), "");
}

}  // namespace
}  // namespace sandflow
