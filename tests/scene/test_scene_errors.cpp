#include "scene_support.h"

#include <filesystem>

namespace sandflow {
namespace {

struct Refusal {
    const char* what;
    std::string text;
    std::string message;
};

void expectRefusals(const std::vector<Refusal>& refusals)
{
    for (const Refusal& refusal : refusals) {
        SCOPED_TRACE(refusal.what);
        EXPECT_EQ(refusalOf(refusal.text), refusal.message);
    }
}

TEST(SceneErrors, UnknownKeysAreNamedWithTheNearestLegalOne)
{
    expectRefusals({
        {"in a list", kJet + "rte = 5\n",
         "s.toml:8:1: emitters[0].rte: unknown key (did you mean \"rate\"?)"},
        {"at the top", "sed = 4\n" + kJet, "s.toml:1:1: sed: unknown key (did you mean \"seed\"?)"},
        {"a table", kJet + "[grain]\nradius = 1\n",
         "s.toml:8:2: grain: unknown key (did you mean \"grains\"?)"},
        {"in a table", kJet + "[surface_flow]\n  repose-angel = 30\n",
         "s.toml:9:3: surface_flow.repose-angel: unknown key (did you mean \"repose_angle\"?)"},
        {"nothing near", kJet + "[skip]\ncolour = 1\n",
         "s.toml:9:1: skip.colour: unknown key (expected one of sleep)"},
        {"the first of two", "[grains]\nzzzz = 1\naaaa = 2\n" + kJet,
         "s.toml:2:1: grains.zzzz: unknown key (expected one of radius, size_spread, density)"},
        {"odd characters", "\"a\\nb\" = 1\n" + kJet,
         "s.toml:1:1: \"a\\u000Ab\": unknown key (expected one of name, mode, precision, seed, "
         "gravity, domain, grains, contact, time, surface_flow, skip, camera, solids, emitters)"},
        {"reported before what is missing", "[[emitters]]\nkind = \"jet\"\ncuont = 5\n",
         "s.toml:3:1: emitters[0].cuont: unknown key (did you mean \"count\"?)"},
        {"instead of the kind", "[[emitters]]\nkid = \"jet\"\n",
         "s.toml:2:1: emitters[0].kid: unknown key (did you mean \"kind\"?)"},
    });
}

TEST(SceneErrors, KeysOfAnotherShapeOrKindAreRefused)
{
    expectRefusals({
        {"emitter", kJet + "size = [1, 1]\n",
         "s.toml:8:1: emitters[0].size: does not belong to a jet, only to slot"},
        {"solid", kJet + "[[solids]]\nshape = \"plane\"\nradius = 1\n",
         "s.toml:10:1: solids[0].radius: does not belong to a plane, only to cylinder, disc"},
        {"axis", kJet + "[[solids]]\nshape = \"disc\"\nradius = 1\naxis = [0, 0, 1]\n",
         "s.toml:11:1: solids[0].axis: does not belong to a disc, only to cylinder"},
        {"mesh", kJet + "[[solids]]\nshape = \"box\"\nmesh = \"a.obj\"\n",
         "s.toml:10:1: solids[0].mesh: does not belong to a box, only to mesh"},
    });
}

TEST(SceneErrors, WrongTypesSayWhatIsAndWhatWasExpected)
{
    expectRefusals({
        {"number", "[grains]\nradius = \"5 mm\"\n" + kJet,
         "s.toml:2:10: grains.radius: is a string, expected a number from 1e-05 to 1 m"},
        {"integer", "seed = 1.0\n" + kJet,
         "s.toml:1:8: seed: is a float, expected an integer from 0 to 9223372036854775807"},
        {"boolean", "[skip]\nsleep = 1\n" + kJet,
         "s.toml:2:9: skip.sleep: is an integer, expected true or false"},
        {"string", "name = 5\n" + kJet, "s.toml:1:8: name: is an integer, expected a string"},
        {"choice", "mode = true\n" + kJet,
         "s.toml:1:8: mode: is a boolean, expected one of \"surface-flow\", \"dem\""},
        {"vector", "gravity = -9.81\n" + kJet,
         "s.toml:1:11: gravity: is a float, expected [x, y, z] with each component from -1000 to "
         "1000 m/s2"},
        {"length", "gravity = [0, -9.81]\n" + kJet,
         "s.toml:1:11: gravity: is an array of 2, expected [x, y, z] with each component from "
         "-1000 to 1000 m/s2"},
        {"component", "gravity = [0, \"down\", 0]\n" + kJet,
         "s.toml:1:15: gravity[1]: is a string, expected a number from -1000 to 1000"},
        {"table", "grains = 3\n" + kJet,
         "s.toml:1:10: grains: is an integer, expected a table "
         "[grains]"},
        {"list", "[emitters]\nkind = \"jet\"\n",
         "s.toml:1:1: emitters: is a table, expected a list of tables [[emitters]]"},
        {"element", "solids = [3]\n" + kJet,
         "s.toml:1:11: solids[0]: is an integer, expected a table"},
        {"auto or number", "[contact]\nstiffness = true\n" + kJet,
         "s.toml:2:13: contact.stiffness: is a boolean, expected \"auto\" or a number above 0 and "
         "up to 1e+12 N/m"},
        {"date", "[time]\nsettle = 1979-05-27\n" + kJet,
         "s.toml:2:10: time.settle: is a date, expected a number from 0 to 1000000 s"},
    });
}

TEST(SceneErrors, ValuesOutOfRangeSayTheRange)
{
    expectRefusals({
        {"below", kJet + "start = -1\n",
         "s.toml:8:9: emitters[0].start: is -1, expected a number from 0 to 1000000 s"},
        {"open end", "[contact]\nrestitution = 0\n" + kJet,
         "s.toml:2:15: contact.restitution: is 0, expected a number above 0 and up to 1"},
        {"above", "[contact]\nfriction = 10.5\n" + kJet,
         "s.toml:2:12: contact.friction: is 10.5, expected \"auto\" or a number from 0 to 10"},
        {"open end above", "[grains]\nsize_spread = 0.67\n" + kJet,
         "s.toml:2:15: grains.size_spread: is 0.67, expected a number from 0 to below 0.67"},
        {"both ends open", "[surface_flow]\nrepose_angle = 90\n" + kJet,
         "s.toml:2:16: surface_flow.repose_angle: is 90, expected \"auto\" or a number above 0 "
         "and below 90 degrees"},
        {"nan", "[grains]\ndensity = nan\n" + kJet,
         "s.toml:2:11: grains.density: is not a number (nan), expected a number from 1 to 50000 "
         "kg/m3"},
        {"infinite", "[time]\nsettle = inf\n" + kJet,
         "s.toml:2:10: time.settle: is infinite, expected a number from 0 to 1000000 s"},
        {"infinite component", "[domain]\nmax = [1, 1, -inf]\n" + kJet,
         "s.toml:2:14: domain.max[2]: is infinite, expected a number from -1e+30 to 1e+30"},
        {"infinite direction", kJet + "direction = [0, 0, -inf]\n",
         "s.toml:8:20: emitters[0].direction[2]: is infinite, expected a number from "
         "-1.797693e+308 to 1.797693e+308"},
        {"zero direction", kJet + "direction = [0, 0.0, -0.0]\n",
         "s.toml:8:13: emitters[0].direction: is the zero vector, expected a direction [x, y, z] "
         "of any length but zero"},
        {"negative seed", "seed = -1\n" + kJet,
         "s.toml:1:8: seed: is -1, expected an integer from 0 to 9223372036854775807"},
        {"word", "mode = \"den\"\n" + kJet, "s.toml:1:8: mode: is \"den\" (did you mean \"dem\"?)"},
        {"far word", "mode = \"quick\"\n" + kJet,
         "s.toml:1:8: mode: is \"quick\", expected one of \"surface-flow\", \"dem\""},
        {"not auto", "[time]\nstep = \"Auto\"\n" + kJet,
         "s.toml:2:8: time.step: is \"Auto\", expected \"auto\" or a number above 0 and up to 0.1 "
         "s"},
        {"two sizes of a mesh",
         kJet + "[[solids]]\nshape = \"mesh\"\nmesh = \"a.obj\"\nfit_height = 1\nfit_length = 1\n",
         "s.toml:12:14: solids[0].fit_length: is given beside fit_height, expected one of the two"},
        {"scale and size of a mesh",
         kJet + "[[solids]]\nshape = \"mesh\"\nmesh = \"a.obj\"\nscale = 0.5\nfit_length = 1\n",
         "s.toml:11:9: solids[0].scale: is given beside a size to fit, expected one of the two"},
        {"empty mesh", kJet + "[[solids]]\nshape = \"mesh\"\nmesh = \"\"\n",
         "s.toml:10:8: solids[0].mesh: is empty, expected a string that is not empty"},
        {"two-line name", "name = \"a\\nb\"\n" + kJet,
         "s.toml:1:8: name: is text with control characters, expected a string"},
    });
}

TEST(SceneErrors, MissingKeysPointAtTheirTable)
{
    const auto without = [](std::string text, const std::string& key) {
        const auto begin = text.find("\n" + key + " ") + 1;
        return text.erase(begin, text.find('\n', begin) + 1 - begin);
    };
    expectRefusals({
        {"count", without(kJet, "count"),
         "s.toml:1:1: emitters[0].count: is missing, expected an integer from 1 to 4000000000 "
         "grains"},
        {"rate", without(kJet, "rate"),
         "s.toml:1:1: emitters[0].rate: is missing, expected a number above 0 and up to 1e+09 "
         "grains/s"},
        {"speed", kOneGrain + without(kJet, "speed"),
         "s.toml:5:1: emitters[1].speed: is missing, expected a number above 0 and up to 1000 m/s"},
        {"kind", "emitters = [ {name = \"x\"} ]\n",
         "s.toml:1:14: emitters[0].kind: is missing, expected one of \"jet\", \"slot\", \"block\", "
         "\"fill\", \"pile\", \"single\""},
        {"box", kJet + "[[solids]]\nshape = \"box\"\nmin = [0, 0, 0]\n",
         "s.toml:8:1: solids[0].max: is missing, expected [x, y, z] with each component from "
         "-10000 to 10000 m"},
        {"emitters", "seed = 5\n",
         "s.toml:1:1: emitters: there is none, expected at least one [[emitters]]"},
        {"empty list", "seed = 5\nemitters = []\n",
         "s.toml:2:12: emitters: there is none, expected at least one [[emitters]]"},
    });
}

TEST(SceneErrors, ValuesThatDoNotGoTogether)
{
    const std::string box = "[[solids]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";
    expectRefusals({
        {"box", kJet + "[[solids]]\nshape = \"box\"\nmin = [0, 2, 0]\nmax = [1, 2, 1]\n",
         "s.toml:11:7: solids[0].max: the box ends at y = 2 where it begins at y = 2, expected max "
         "above min"},
        {"emitter box", "[[emitters]]\nkind = \"fill\"\nmin = [0, 0, 1]\nmax = [1, 1, 0.5]\n",
         "s.toml:4:7: emitters[0].max: the box ends at z = 0.5 where it begins at z = 1, expected "
         "max above min"},
        {"domain without max", kJet + "[domain]\nmin = [0, 0, 1e30]\n",
         "s.toml:9:7: domain.min: the box ends at z = 1e+30 where it begins at z = 1e+30, expected "
         "max above min"},
        {"until", kJet + box + "from = 2\nuntil = 2\n",
         "s.toml:13:9: solids[0].until: it is gone at 2 s but exists from 2 s, expected until "
         "above from"},
        {"rough box", kJet + box + "rough = true\n",
         "s.toml:12:9: solids[0].rough: is true, but only planes can be rough"},
        {"floor", kJet + box + "floor = true\n",
         "s.toml:12:9: solids[0].floor: is true, but only a hollow solid has a floor (hollow = "
         "true)"},
        {"neutral slope", "[surface_flow]\nrepose_angle = 60\nrepose_margin = 30\n" + kJet,
         "s.toml:3:17: surface_flow.repose_margin: makes the neutral slope 60 + 30 degrees, "
         "expected a sum above 0 and below 90"},
        {"gravity", "gravity = [0, -9.81, 0]\n" + kJet,
         "s.toml:1:11: gravity: does not point down, expected a negative z in mode "
         "\"surface-flow\""},
        {"stiffness", "[contact]\nlaw = \"hertz\"\nstiffness = 1e4\n" + kJet,
         "s.toml:3:13: contact.stiffness: belongs to law = \"linear\", expected young_modulus "
         "with this law"},
        {"young_modulus", "[contact]\nyoung_modulus = 1e7\n" + kJet,
         "s.toml:2:17: contact.young_modulus: does not belong to law = \"linear\", expected "
         "stiffness with this law"},
        {"big grain", kOneGrain + "radius = 0.05\n",
         "s.toml:5:10: emitters[0].radius: is 0.05, expected 0.001067 to 0.02328 m, as grain "
         "sizes may differ by a factor of 5"},
        {"grains far apart", kOneGrain + "radius = 0.02\n" + kOneGrain + "radius = 0.0015\n",
         "s.toml:5:10: emitters[0].radius: is 0.02 but emitters[1].radius is 0.0015, expected "
         "grain sizes within a factor of 5"},
        {"too many", kJet + kOneGrain + "[[emitters]]\nkind = \"pile\"\ncount = 4000000000\n",
         "s.toml:14:9: emitters[2].count: brings the scene to 4000000101 grains, expected at most "
         "4000000000"},
        {"camera", kJet + "[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]\n",
         "s.toml:10:11: camera.look_at: is the camera's own position, expected another point"},
    });
}

TEST(SceneErrors, DemMayHaveAnyGravity)
{
    EXPECT_EQ(parseScene("mode = \"dem\"\ngravity = [0, 0, 0]\n" + kJet, "s.toml").gravity,
              Vec3::Zero());
}

TEST(SceneErrors, TextThatIsNoTomlIsPlaced)
{
    EXPECT_TRUE(refusalOf("seed = \n").starts_with("s.toml:1:8: not valid TOML: "))
        << refusalOf("seed = \n");
    EXPECT_TRUE(refusalOf("seed = 1\nseed = 2\n").starts_with("s.toml:2:"))
        << refusalOf("seed = 1\nseed = 2\n");
    EXPECT_TRUE(refusalOf("name = \"\xff\xfe\"\n").starts_with("s.toml:1:"))
        << refusalOf("name = \"\xff\xfe\"\n");
    EXPECT_TRUE(refusalOf(std::string(100000, '[')).starts_with("s.toml:1:"));
    for (const char* text : {"", " \n\t\r\n", "# only a comment = 1", "\xEF\xBB\xBF"}) {
        EXPECT_EQ(refusalOf(text), "s.toml: is empty, expected a scene");
    }
}

TEST(SceneErrors, FilesThatCannotBeRead)
{
    const auto refusal = [](const std::string& path) -> std::string {
        try {
            readScene(path);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(refusal("/no/such.toml"), "/no/such.toml: no such file, expected a scene file");
    EXPECT_EQ(refusal(""), ": no such file, expected a scene file");
    EXPECT_EQ(refusal("/tmp"), "/tmp: is a directory, expected a scene file");
    EXPECT_EQ(refusal("/dev/null"), "/dev/null: is empty, expected a scene");
    EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is larger than 16 MiB, expected a scene file");
    // Opens, even for root, but address 0 cannot be read.
    EXPECT_EQ(refusal("/proc/self/mem"), "/proc/self/mem: cannot be read (Input/output error)");
    EXPECT_EQ(refusal("/dev/null/x.toml"), "/dev/null/x.toml: cannot be read (Not a directory)");
    const std::string path = testing::TempDir() + "/written_scene.toml";
    std::ofstream(path) << kJet;
    EXPECT_EQ(readScene(path).name, "written_scene");
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace sandflow
