#include "app/json_reader.h"
#include "app/program.h"

#include <cmath>

namespace sandflow {
namespace {

using Bench = ProgramTest;

TEST_F(Bench, KernelReportsAsJson)
{
    const ProgramResult result =
        call("bench kernel --grains 2000 --steps 50 --warmup 20 --repeat 2 --threads 2 --json");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_GT(json.number("kernel.mps"), 0.0);
    EXPECT_GE(json.number("kernel.mps_without_rebuilds"), json.number("kernel.mps"));
    EXPECT_LE(json.number("kernel.mps_low"), json.number("kernel.mps_high"));
    EXPECT_EQ(json.number("kernel.threads"), 2);
    EXPECT_EQ(json.number("kernel.grains"), 2000);
    EXPECT_EQ(json.number("kernel.steps"), 50);
    EXPECT_TRUE(json.has("kernel.rebuilds"));
    EXPECT_FALSE(json.text("kernel.target").empty());
    // At the least the two copies of a grain's record; at most what `check` reckons with.
    EXPECT_GT(json.number("kernel.bytes_per_grain"), 128.0);
    EXPECT_LT(json.number("kernel.bytes_per_grain"), 440.0);
    // Every grain of a bed at rest lies on something.
    EXPECT_GT(json.number("kernel.contacts_per_grain"), 1.0);
    EXPECT_LT(json.number("kernel.max_overlap_r"), 0.2);
}

TEST_F(Bench, BesideABusyProcessToo)
{
    const ProgramResult result =
        call("bench kernel --grains 1000 --steps 20 --warmup 0 --repeat 1 --busy 1 --json");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_EQ(json.number("kernel.busy"), 1);
    EXPECT_GT(json.number("kernel.mps_busy"), 0.0);
}

TEST_F(Bench, BedFromAFileIsTheBedThatWasWritten)
{
    const std::string sizes = " --steps 40 --warmup 0 --repeat 1 --threads 1 --json";
    const ProgramResult made = call("bench kernel --grains 2000 --write-positions bed.csv" + sizes);
    ASSERT_EQ(made.exitCode, 0) << made.errors;
    EXPECT_EQ(read("bed.csv").rfind("id,x,y,z\n1,", 0), 0u);
    const ProgramResult again = call("bench kernel --positions bed.csv" + sizes);
    ASSERT_EQ(again.exitCode, 0) << again.errors;
    // The same bits go in, so the same energy comes out.
    EXPECT_EQ(JsonScalars(again.output).text("kernel.kinetic_energy_j"),
              JsonScalars(made.output).text("kernel.kinetic_energy_j"));

    const ProgramResult twoThreads = call(
        "bench kernel --positions bed.csv --threads 2 --steps 40 --warmup 0 --repeat 1 --json");
    EXPECT_EQ(JsonScalars(twoThreads.output).text("kernel.kinetic_energy_j"),
              JsonScalars(made.output).text("kernel.kinetic_energy_j"));
}

TEST_F(Bench, SwitchesReachTheKernel)
{
    const std::string sizes = "bench kernel --grains 1000 --steps 20 --warmup 0 --repeat 1 --json ";
    EXPECT_EQ(JsonScalars(call(sizes).output).text("kernel.precision"), "float");
    const JsonScalars wide(call(sizes + "--double").output);
    EXPECT_EQ(wide.text("kernel.precision"), "double");
    const JsonScalars narrow(call(sizes).output);
    EXPECT_GT(wide.number("kernel.bytes_per_grain"), narrow.number("kernel.bytes_per_grain"));
    EXPECT_EQ(JsonScalars(call(sizes + "--no-rolling").output).text("kernel.rolling"), "false");
}

TEST_F(Bench, BadBedsAreRefused)
{
    write("outside.csv", "id,x,y,z\n1,0.1,0.1,0.005\n2,0.7,0.1,0.005\n");
    write("twice.csv", "id,x,y,z\n1,0.1,0.1,0.005\n1,0.2,0.1,0.005\n");
    write("short.csv", "id,x,y\n1,0.1,0.1\n");
    write("empty.csv", "id,x,y,z\n");
    for (const char* name : {"outside", "twice", "short", "empty", "missing"}) {
        const ProgramResult result = call(std::string("bench kernel --positions ") + name + ".csv");
        EXPECT_EQ(result.exitCode, 2) << name;
        EXPECT_NE(result.errors.find(std::string(name) + ".csv"), std::string::npos)
            << result.errors;
    }
}

}  // namespace
}  // namespace sandflow
