#include "app/json_reader.h"
#include "app/program.h"

#include <algorithm>

namespace sandflow {
namespace {

/// 200 grains, the ends of each sweep, a reference hardly finer: it has to run, not to find.
class BenchError : public ProgramTest {
protected:
    BenchError() { writeTinyScene("tiny.toml"); }

    const std::string cheap_ =
        "bench error tiny.toml --quick --threads 2 --reference-stiffness 2 --reference-step 0.8 ";
};

TEST_F(BenchError, LeavesTablesAndPictures)
{
    const ProgramResult result = call(cheap_ + "--seeds 2 --out study");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_NE(result.output.find("front:"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("two references"), std::string::npos);
    const std::string trials = read("study/trials.csv");
    const std::string settings = read("study/settings.csv");
    const auto countLines = [](const std::string& text, const std::string& start) {
        std::istringstream in(text);
        std::ptrdiff_t count = 0;
        for (std::string line; std::getline(in, line);) {
            count += line.starts_with(start) ? 1 : 0;
        }
        return count;
    };
    // Each setting, the reference among them, once for each seed; the default more often.
    EXPECT_EQ(countLines(settings, "default,"), 1);
    EXPECT_EQ(countLines(trials, "") - countLines(trials, "default,") - 1,
              2 * (countLines(settings, "") - 2));
    EXPECT_GE(countLines(trials, "default,"), 2 * 3);
    for (const char* picture : {"study/front.png", "study/sweeps.png"}) {
        EXPECT_EQ(read(picture).substr(1, 3), "PNG") << picture;
    }
}

TEST_F(BenchError, ReportsAsJson)
{
    const ProgramResult result = call(cheap_ + "--seeds 1 --no-plot --json --clock processor");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_EQ(json.text("error.clock"), "processor");
    EXPECT_EQ(json.text("error.settings[0].approximation"), "default");
    EXPECT_EQ(json.number("error.settings[0].cost"), 1.0);
    EXPECT_GE(json.number("error.settings[0].radial_d"), 0.0);
    EXPECT_EQ(json.text("error.settings[1].set[0]"), "mode=dem");
    EXPECT_EQ(json.text("error.two_references"), "null");  // there is but one
    EXPECT_EQ(json.text("error.noise.error_d"), "null");
    EXPECT_TRUE(exists("runs/tiny-error/trials.csv"));
    EXPECT_FALSE(exists("runs/tiny-error/front.png"));
}

TEST_F(BenchError, StudiesAreEvaluatedAgain)
{
    ASSERT_EQ(call(cheap_ + "--seeds 1 --no-plot --out one").exitCode, 0);
    ASSERT_EQ(call(cheap_ + "--seeds 1 --no-plot --set seed=2 --out two").exitCode, 0);
    const ProgramResult result =
        call("bench error --from one --from two --no-plot --measure cells --json --out both");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_EQ(json.text("error.measure"), "cells");
    EXPECT_EQ(json.number("error.seeds[0]"), 1);
    EXPECT_EQ(json.number("error.seeds[1]"), 2);
    EXPECT_EQ(json.number("error.settings[0].finished"), 2);
    EXPECT_GE(json.number("error.noise.error_d"), 0.0);
    EXPECT_TRUE(exists("both/settings.csv"));
}

TEST_F(BenchError, BadUsageIsASentence)
{
    write("taken", "");
    struct Case {
        const char* arguments;
        int exitCode;
        const char* says;
    };
    const Case cases[] = {
        {"bench error missing.toml", 2, "missing.toml"},
        {"bench error", 2, "--from"},
        {"bench error tiny.toml --from elsewhere", 2, "--from"},
        {"bench error --from elsewhere", 2, "elsewhere"},
        {"bench error tiny.toml --seeds 0", 2, "--seeds"},
        {"bench error tiny.toml --seeds many", 2, "--seeds"},
        {"bench error tiny.toml --measure length", 2, "--measure"},
        {"bench error tiny.toml --reference-step 2", 2, "--reference-step"},
        {"bench error tiny.toml --set grains.colour=red", 2, "grains.colour"},
        {"bench error tiny.toml --set mode=dem", 2, "mode"},
        {"bench error tiny.toml --set time.step=1e-5", 2, "time.step"},
        {"bench error tiny.toml --out taken", 2, "taken"},
        {"bench error tiny.toml --out .", 2, "exists"},
        {"bench error tiny.toml --out taken/study", 4, "taken/study"},
        {"bench error tiny.toml --out /proc/study", 4, "/proc/study"},
    };
    for (const Case& c : cases) {
        const ProgramResult result = call(c.arguments);
        EXPECT_EQ(result.exitCode, c.exitCode) << c.arguments << "\n" << result.errors;
        EXPECT_NE(result.errors.find(c.says), std::string::npos)
            << c.arguments << "\n" << result.errors;
        EXPECT_FALSE(exists("runs")) << c.arguments;
    }
}

TEST_F(BenchError, WithoutGnuplotNothingIsStarted)
{
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", "/nowhere", 1);
    const ProgramResult result = call("bench error tiny.toml");
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_NE(result.errors.find("apt-get install gnuplot-nox"), std::string::npos)
        << result.errors;
    EXPECT_FALSE(exists("runs"));
}

}  // namespace
}  // namespace sandflow
