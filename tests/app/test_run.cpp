#include "app/json_reader.h"
#include "app/program.h"

#include <algorithm>
#include <vector>

namespace sandflow {
namespace {

/// The lines of a text, without their ends.
std::vector<std::string> splitLines(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> splitFields(const std::string& line)
{
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) {
        fields.push_back(field);
    }
    return fields;
}

/// Each test runs the tiny scene, once in the folder "out".
class TinyRun : public ProgramTest {
protected:
    void SetUp() override
    {
        writeTinyScene("tiny.toml");
        result_ = call("run tiny.toml --out out --threads 2");
        ASSERT_EQ(result_.exitCode, 0) << result_.errors;
    }

    ProgramResult result_;
};

TEST_F(TinyRun, LeavesTheFilesPromised)
{
    for (const char* name :
         {"scene.toml", "frames.csv", "summary.json", "state_last.bin", "scene.pov", "scene.ini",
          "run_scene.inc", "frame_000001.inc", "frame_000012.inc"}) {
        EXPECT_TRUE(exists(std::string("out/") + name)) << name;
    }
    EXPECT_FALSE(exists("out/frame_000013.inc"));
    EXPECT_EQ(splitLines(read("out/frames.csv")).size(), 13u);

    const JsonScalars summary(read("out/summary.json"));
    EXPECT_EQ(summary.text("scene"), "tiny");
    EXPECT_EQ(summary.text("mode"), "surface-flow");
    EXPECT_EQ(summary.number("grains"), 200);
    EXPECT_EQ(summary.number("frames"), 12);
    EXPECT_EQ(summary.number("threads"), 2);
    EXPECT_EQ(summary.text("ledger_ok"), "true");
    EXPECT_EQ(summary.number("leaks"), 0);
    EXPECT_EQ(summary.text("state_hash").size(), 16u);
    for (const char* key : {"mean_wall_s_per_frame", "peak_rss_bytes", "dt_mean_s", "heap.apex_m",
                            "heap.r90_m", "skipped.grain_steps_done"}) {
        EXPECT_GT(summary.number(key), 0.0) << key;
    }
    EXPECT_TRUE(summary.has("heap.repose_deg"));
}

TEST_F(TinyRun, FolderIsTakenOnceAndAgainOnlyByForce)
{
    const std::string hash = JsonScalars(read("out/summary.json")).text("state_hash");
    const ProgramResult refused = call("run tiny.toml --out out");
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.errors.find("already holds a run"), std::string::npos) << refused.errors;
    EXPECT_EQ(JsonScalars(read("out/summary.json")).text("state_hash"), hash);

    const ProgramResult forced =
        call("run tiny.toml --out out --force --frames 6 --quiet --no-frames --threads 1");
    EXPECT_EQ(forced.exitCode, 0) << forced.errors;
    EXPECT_EQ(JsonScalars(read("out/summary.json")).number("frames"), 6);
    EXPECT_FALSE(exists("out/frame_000001.inc"));
    EXPECT_TRUE(exists("out/state_last.bin"));
}

TEST_F(TinyRun, ResolvedSceneAndOtherThreadCountGiveTheSameBits)
{
    const ProgramResult again = call("run out/scene.toml --out again --threads 4 --no-frames");
    ASSERT_EQ(again.exitCode, 0) << again.errors;
    EXPECT_EQ(JsonScalars(read("again/summary.json")).text("state_hash"),
              JsonScalars(read("out/summary.json")).text("state_hash"));
}

TEST_F(TinyRun, SlopesThatTheTableGaveAreWrittenAsNumbers)
{
    write("tiny.toml",
          read("tiny.toml") + "[contact]\nrepose_angle = 24\nrolling_friction = 0.1\n"
                              "[surface_flow]\nrepose_angle = \"auto\"\n");
    ASSERT_EQ(call("run tiny.toml --out auto --no-frames").exitCode, 0);
    const std::string scene = read("auto/scene.toml");
    EXPECT_NE(scene.find("\nfriction = 0.2"), std::string::npos) << scene;
    EXPECT_NE(scene.find("\nrolling_friction = 0.1\n"), std::string::npos) << scene;
    EXPECT_NE(scene.find("\nrepose_margin = 8.0\n"), std::string::npos) << scene;
    EXPECT_EQ(scene.find("repose_angle = \"auto\""), std::string::npos) << scene;

    ASSERT_EQ(call("run auto/scene.toml --out again --no-frames").exitCode, 0);
    const std::string hash = JsonScalars(read("auto/summary.json")).text("state_hash");
    EXPECT_EQ(JsonScalars(read("again/summary.json")).text("state_hash"), hash);
    EXPECT_NE(JsonScalars(read("out/summary.json")).text("state_hash"), hash);
}

TEST_F(TinyRun, ScalarKernelGivesTheSameBits)
{
    const ProgramResult scalar = call("run tiny.toml --out scalar --simd scalar --no-frames");
    ASSERT_EQ(scalar.exitCode, 0) << scalar.errors;
    const JsonScalars summary(read("scalar/summary.json"));
    EXPECT_EQ(summary.text("simd_target"), "scalar");
    EXPECT_EQ(summary.text("state_hash"),
              JsonScalars(read("out/summary.json")).text("state_hash"));

    const ProgramResult refused = call("run tiny.toml --out refused --simd mmx");
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.errors.find("--simd mmx: expected auto, scalar"), std::string::npos)
        << refused.errors;
    EXPECT_FALSE(exists("refused"));
}

TEST_F(TinyRun, ExportHoldsEveryGrain)
{
    const ProgramResult csv = call("export out --frame last --format csv");
    ASSERT_EQ(csv.exitCode, 0) << csv.errors;
    const std::vector<std::string> lines = splitLines(csv.output);
    ASSERT_EQ(lines.size(), 201u);
    EXPECT_EQ(lines[0], "id,x,y,z,radius,vx,vy,vz,state");
    for (std::size_t n = 1; n < lines.size(); ++n) {
        const std::vector<std::string> fields = splitFields(lines[n]);
        ASSERT_EQ(fields.size(), 9u) << lines[n];
        const double radius = std::stod(fields[4]);
        EXPECT_TRUE(radius >= 0.0046 && radius <= 0.0054) << lines[n];
        EXPECT_GT(std::stod(fields[3]), 0.0) << lines[n];
    }
    EXPECT_EQ(call("export out --frame 12").output, csv.output);

    ASSERT_EQ(call("export out --format ply --out grains.ply").exitCode, 0);
    EXPECT_EQ(read("grains.ply").rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
    ASSERT_EQ(call("export out --format vtp --out grains.vtp").exitCode, 0);
    EXPECT_NE(read("grains.vtp").find("NumberOfPoints=\"200\""), std::string::npos);
}

TEST_F(TinyRun, ExportHoldsBuriedGrainsToo)
{
    // Settled sand is buried from birth: here some 9 diameters deep, of which the height field
    // holds all but the uppermost.
    write("box.toml",
          "name = \"box\"\n"
          "[time]\nduration = 0.1\n"
          "[[solids]]\nshape = \"plane\"\n"
          "[[solids]]\nshape = \"box\"\nhollow = true\n"
          "min = [0, 0, 0]\nmax = [0.12, 0.12, 0.3]\n"
          "[[emitters]]\nkind = \"fill\"\ncount = 1500\n"
          "min = [0, 0, 0]\nmax = [0.12, 0.12, 0.3]\n");
    const ProgramResult run = call("run box.toml --out box --no-frames");
    ASSERT_EQ(run.exitCode, 0) << run.errors;
    const double buried = JsonScalars(read("box/summary.json")).number("buried");
    ASSERT_GT(buried, 100);
    const std::vector<std::string> lines = splitLines(call("export box").output);
    EXPECT_EQ(lines.size(), 1501u);
    const auto named = std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
        return line.ends_with(",buried");
    });
    EXPECT_EQ(static_cast<double>(named), buried);
}

TEST_F(TinyRun, ExportRefusesWhatIsNotThere)
{
    for (const char* arguments : {"export nowhere", "export out --frame 5", "export out --frame x",
                                  "export out --format obj"}) {
        const ProgramResult result = call(arguments);
        EXPECT_EQ(result.exitCode, 2) << arguments;
        EXPECT_FALSE(result.errors.empty()) << arguments;
    }
    EXPECT_EQ(call("export out --out no/such/folder.csv").exitCode, 4);
}

TEST_F(TinyRun, ComparedWithItselfDiffersByNothing)
{
    const ProgramResult result = call("compare out out --json");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_EQ(json.text("difference.identical"), "true");
    for (const char* key :
         {"height_radial.mean_d", "height_radial.worst_d", "height_cells.mean_d", "apex_d",
          "r90_percent", "foot_d", "volume_percent", "centroid_d", "grains"}) {
        EXPECT_EQ(json.number(std::string("difference.") + key), 0.0) << key;
    }
    EXPECT_EQ(json.number("difference.wall_ratio"), 1.0);
    EXPECT_EQ(json.number("a.grains"), 200);
    EXPECT_EQ(json.text("a.ledger_ok"), "true");
    EXPECT_GT(json.number("a.share_pouring.mobile"), 0.0);
    // The last of 200 grains at 1000/s leaves before 0.2 s; frames are 1/30 s.
    EXPECT_NEAR(json.number("a.last_emission_s"), 0.2, 0.034);

    const ProgramResult table = call("compare out out");
    EXPECT_EQ(table.exitCode, 0);
    EXPECT_NE(table.output.find("identical, bit for bit"), std::string::npos) << table.output;
}

TEST_F(TinyRun, ComparedWithAnotherPourDiffers)
{
    const ProgramResult other = call("run tiny.toml --out other --seed 2 --mode dem --no-frames");
    ASSERT_EQ(other.exitCode, 0) << other.errors;
    const JsonScalars json(call("compare out other --json").output);
    EXPECT_EQ(json.text("difference.identical"), "false");
    EXPECT_EQ(json.number("b.share_at_end.mobile"), 1.0);
    EXPECT_EQ(json.number("b.share_at_end.interface"), 0.0);

    EXPECT_EQ(call("compare out nowhere").exitCode, 2);
    const ProgramResult finer =
        call("run tiny.toml --out finer --set grains.radius=0.004 --no-frames --frames 3");
    ASSERT_EQ(finer.exitCode, 0) << finer.errors;
    const ProgramResult refused = call("compare out finer");
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.errors.find("mean radius"), std::string::npos) << refused.errors;
}

TEST_F(TinyRun, SaysWhatTrappingCost)
{
    const JsonScalars summary(read("out/summary.json"));
    EXPECT_GT(summary.number("transfer.landed_momentum_kg_m_s"), 0.0);
    EXPECT_NEAR(summary.number("trapped_momentum_share"),
                summary.number("transfer.trapped_momentum_kg_m_s") /
                    summary.number("transfer.landed_momentum_kg_m_s"),
                1e-9);
    EXPECT_LT(summary.number("trapped_momentum_share"), 0.01);
    EXPECT_NE(result_.output.find("momentum lost to trapping:"), std::string::npos);
    EXPECT_FALSE(summary.has("release.seconds"));
}

TEST_F(TinyRun, ReleaseAtEndAddsFramesAndSaysWhatMoved)
{
    for (const char* mode : {"surface-flow", "dem"}) {
        SCOPED_TRACE(mode);
        const ProgramResult released = call(std::string("run tiny.toml --out ") + mode +
                                            " --release-at-end 0.1 --mode " + mode);
        ASSERT_EQ(released.exitCode, 0) << released.errors;
        const JsonScalars summary(read(std::string(mode) + "/summary.json"));
        EXPECT_NEAR(summary.number("release.seconds"), 0.1, 1e-9);
        for (const char* key : {"apex_moved_d", "mean_dh_d", "repose_moved_deg", "fastest_m_s",
                                "could_fall_m_s"}) {
            EXPECT_TRUE(summary.has(std::string("release.") + key)) << key;
        }
        EXPECT_GT(summary.number("release.could_fall_m_s"), 0.0);
        // The figures of the run itself are those of its end.
        EXPECT_EQ(summary.number("frames"), 12);
        EXPECT_EQ(splitLines(read(std::string(mode) + "/frames.csv")).size(), 16u);
        EXPECT_TRUE(exists(std::string(mode) + "/frame_000015.inc"));
        EXPECT_NE(released.output.find("set free for 0.1 s"), std::string::npos);
    }
    EXPECT_EQ(JsonScalars(read("surface-flow/summary.json")).text("state_hash"),
              JsonScalars(read("out/summary.json")).text("state_hash"));
    for (const char* seconds : {"0", "-1", "soon"}) {
        EXPECT_EQ(call(std::string("run tiny.toml --out no --release-at-end ") + seconds).exitCode,
                  2)
            << seconds;
    }
}

TEST_F(TinyRun, ComparesCratersBetweenFrames)
{
    for (const char* mode : {"surface-flow", "dem"}) {
        ASSERT_EQ(call(std::string("run tiny.toml --no-frames --keep-states --out ") + mode +
                       " --mode " + mode)
                      .exitCode,
                  0);
    }
    const JsonScalars json(
        call("compare surface-flow dem --frame 11 --since 6 --json").output);
    for (const char* key : {"a.depth_m", "a.volume_m3", "b.depth_m", "depth_d"}) {
        EXPECT_TRUE(json.has(std::string("crater.") + key)) << key;
    }
    EXPECT_NE(call("compare surface-flow dem --since 6").output.find("sunk since frame 6"),
              std::string::npos);
    const ProgramResult missing = call("compare out out --frame 5");
    EXPECT_EQ(missing.exitCode, 2) << "its states were not kept";
}

class GentlePour : public ProgramTest {
protected:
    /// Angle of repose [degrees] of 3,000 grains poured from a hand's height, full DEM.
    double pourHeap(const std::string& settings) const
    {
        write("gentle.toml",
              "mode = \"dem\"\n"
              "[time]\nsettle = 0.6\n"
              "[[solids]]\nshape = \"plane\"\n"
              "[[emitters]]\nkind = \"jet\"\ncount = 3000\nrate = 1500\n"
              "position = [0, 0, 0.12]\nradius = 0.04\nspeed = 0.6\n");
        const ProgramResult run =
            call("run gentle.toml --out heap --force --no-frames --threads 1" + settings);
        EXPECT_EQ(run.exitCode, 0) << run.errors;
        return JsonScalars(read("heap/summary.json")).number("heap.repose_deg");
    }

    double expectAngle(const std::string& settings) const
    {
        const ProgramResult check = call("check gentle.toml --json" + settings);
        return JsonScalars(check.output).number("repose.expected_deg");
    }
};

TEST_F(GentlePour, StandsAsTheTableSays)
{
    // The table's heaps have 8,000 grains; small ones stand up to a degree flatter, and two pours
    // differ by half a degree.
    constexpr double kNear = 2.0;
    const double sand = pourHeap("");
    EXPECT_NEAR(sand, expectAngle(""), kNear);
    const std::string beads = " --set contact.friction=0.2 --set contact.rolling_friction=0";
    const double flat = pourHeap(beads);
    EXPECT_NEAR(flat, expectAngle(beads), kNear);
    EXPECT_GT(sand, flat + 2.0 * kNear);
}

TEST_F(GentlePour, StandsAsTheSceneAsks)
{
    EXPECT_NEAR(pourHeap(" --set contact.repose_angle=24"), 24.0, 2.0);
}

}  // namespace
}  // namespace sandflow
