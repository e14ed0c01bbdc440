#include "app/json_reader.h"
#include "app/program.h"

namespace sandflow {
namespace {

using BenchStability = ProgramTest;

TEST_F(BenchStability, JudgesRunsAndWritesThemDown)
{
    const ProgramResult result =
        call("bench stability --quick --only 'one grain' --threads 1 --out study --no-plot --json");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const JsonScalars json(result.output);
    EXPECT_EQ(json.text("acceptable"), "true");
    EXPECT_EQ(json.text("findings[0].family"), "impact speed, one grain");
    EXPECT_EQ(json.text("findings[0].verdict"), "sound");
    EXPECT_LT(json.number("findings[0].error"), json.number("findings[0].limit"));
    const std::string csv = read("study/stability.csv");
    EXPECT_EQ(csv.rfind("family,parameter,value,mode,verdict,measure,error,limit,unit,cause\n", 0), 0u);
    EXPECT_NE(csv.find("0.005,dem,refused"), std::string::npos) << csv;
    EXPECT_NE(csv.find("must lie between 0.01 and 1"), std::string::npos) << csv;
    // The folder is there now: it is never written over.
    EXPECT_EQ(call("bench stability --quick --only 'one grain' --out study --no-plot").exitCode, 2);
    EXPECT_EQ(call("bench stability --only nonsense").exitCode, 2);
}

/// One family: all of them take a minute even when quick.
TEST_F(BenchStability, FindsNothingWrongAtTheEndsOfARange)
{
    const ProgramResult result = call("bench stability --quick --only friction --threads 1");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_NE(result.output.find(" 0 wrong shape, 0 jitters, 0 broke"), std::string::npos)
        << result.output;
}

}  // namespace
}  // namespace sandflow
