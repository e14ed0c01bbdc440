#include "app/program.h"

namespace sandflow {
namespace {

using CommandLine = ProgramTest;

TEST_F(CommandLine, VersionNamesProgramAndKernel)
{
    const ProgramResult result = call("--version");
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.output.rfind("sandflow ", 0), 0u) << result.output;
    EXPECT_NE(result.output.find("kernel"), std::string::npos) << result.output;
}

TEST_F(CommandLine, HelpListsEveryCommand)
{
    const ProgramResult result = call("--help");
    EXPECT_EQ(result.exitCode, 0);
    for (const char* command : {"run", "check", "compare", "export", "bench"}) {
        EXPECT_NE(result.output.find(std::string("\n  ") + command), std::string::npos) << command;
        const ProgramResult own = call(std::string(command) + " --help");
        EXPECT_EQ(own.exitCode, 0) << command;
        EXPECT_NE(own.output.find("Usage"), std::string::npos) << own.output;
    }
}

TEST_F(CommandLine, WrongUsageIsExitCodeTwoAndSaysWhat)
{
    for (const char* arguments :
         {"", "pour", "--fast", "run", "run x.toml --fast", "run x.toml --mode quick", "compare a",
          "bench", "bench kernel --grains 0", "bench kernel --steps many", "export"}) {
        const ProgramResult result = call(arguments);
        EXPECT_EQ(result.exitCode, 2) << arguments;
        EXPECT_FALSE(result.errors.empty()) << arguments;
    }
    EXPECT_NE(call("run x.toml --fast").errors.find("--fast"), std::string::npos);
}

TEST_F(CommandLine, MissingSceneIsRefusedAndLeavesNothing)
{
    for (const char* command : {"run", "check"}) {
        const ProgramResult result = call(std::string(command) + " nowhere.toml");
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE(result.errors.find("nowhere.toml"), std::string::npos) << result.errors;
    }
    EXPECT_FALSE(exists("runs"));
}

TEST_F(CommandLine, SceneErrorIsOneExactSentence)
{
    write("bad.toml", "[[emitters]]\nkind = \"jet\"\nrte = 5\n");
    const std::string sentence =
        "sandflow: bad.toml:3:1: emitters[0].rte: unknown key (did you mean \"rate\"?)\n";
    for (const char* command : {"check bad.toml", "run bad.toml", "run bad.toml --out here"}) {
        const ProgramResult result = call(command);
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_EQ(result.errors, sentence);
        EXPECT_EQ(result.output, "");
    }
    EXPECT_FALSE(exists("runs"));
    EXPECT_FALSE(exists("here"));
}

TEST_F(CommandLine, WrongOverrideIsRefused)
{
    writeTinyScene("tiny.toml");
    for (const char* command : {"run", "check"}) {
        const ProgramResult result =
            call(std::string(command) + " tiny.toml --set grains.radius=-1");
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_EQ(result.errors.rfind("sandflow: --set grains.radius=-1: ", 0), 0u)
            << result.errors;
    }
    EXPECT_FALSE(exists("runs"));
}

}  // namespace
}  // namespace sandflow
