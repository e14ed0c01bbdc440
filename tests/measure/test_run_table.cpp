#include "core/errors.h"
#include "measure/run_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace sandflow {
namespace {

class RunTableTest : public ::testing::Test {
protected:
    RunTableTest()
        : folder_(std::filesystem::temp_directory_path() /
                  fmt::format("sandflow_run_table_{}", ::getpid()))
    {
        std::filesystem::create_directories(folder_);
    }

    ~RunTableTest() override
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    RunTable readText(const std::string& text) const
    {
        std::ofstream(folder_ / "frames.csv") << text;
        return RunTable::readRun(folder_);
    }

    /// The sentence with which reading `text` is refused.
    std::string refusal(const std::string& text) const
    {
        try {
            readText(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "was read";
    }

    std::filesystem::path folder_;
};

TEST_F(RunTableTest, FindsColumnsByNameWhateverTheirOrder)
{
    const RunTable table = readText("mobile,frame,new_column,time_s\n10,0,5,0\n20,1,7,0.5\n");
    EXPECT_EQ(table.rowCount(), 2u);
    EXPECT_EQ(table.names().size(), 4u);
    EXPECT_TRUE(table.has("new_column"));
    EXPECT_FALSE(table.has("buried"));
    EXPECT_EQ(table.column("mobile"), (std::vector<double>{10.0, 20.0}));
    EXPECT_EQ(table.column("time_s"), (std::vector<double>{0.0, 0.5}));
}

TEST_F(RunTableTest, MeanIsOverTheFramesOfTheWindow)
{
    const RunTable table = readText("frame,time_s,mobile\n0,0,100\n1,0.5,10\n2,1.0,20\n3,1.5,60\n");
    EXPECT_DOUBLE_EQ(meanOver(table, "mobile", 0.5, 1.5), 30.0) << "both ends belong to it";
    EXPECT_DOUBLE_EQ(meanOver(table, "mobile", 0.6, 1.4), 20.0);
    EXPECT_DOUBLE_EQ(meanOver(table, "mobile", -1.0, 9.0), 47.5);
}

TEST_F(RunTableTest, WindowWithoutFramesIsRefused)
{
    const RunTable table = readText("time_s,mobile\n0,100\n");
    EXPECT_THROW(meanOver(table, "mobile", 0.1, 0.2), InputError);
    EXPECT_THROW(meanOver(readText("time_s,mobile\n"), "mobile", 0.0, 1.0), InputError);
}

TEST_F(RunTableTest, UnknownColumnIsNamedWithTheFile)
{
    const RunTable table = readText("time_s,mobile\n0,100\n");
    try {
        meanOver(table, "moblie", 0.0, 1.0);
        FAIL() << "was found";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("frames.csv"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("\"moblie\""), std::string::npos);
    }
}

TEST_F(RunTableTest, AcceptsWindowsLinesBlankLinesAndExponents)
{
    const RunTable table = readText("time_s, kinetic_energy_j\r\n0.0, 1.5e-3\r\n\r\n1.0, -2\r\n");
    EXPECT_EQ(table.rowCount(), 2u);
    EXPECT_EQ(table.column("kinetic_energy_j"), (std::vector<double>{1.5e-3, -2.0}));
}

TEST_F(RunTableTest, BadLinesAreRefusedWithTheirNumber)
{
    EXPECT_NE(
        refusal("time_s,mobile\n0,1\n1,2,3\n").find("frames.csv:3: expected 2 values, found 3"),
        std::string::npos);
    EXPECT_NE(refusal("time_s,mobile\n0,1\n1\n").find("frames.csv:3: expected 2 values, found 1"),
              std::string::npos);
    EXPECT_NE(refusal("time_s,mobile\n0,many\n")
                  .find("frames.csv:2: column \"mobile\" holds "
                        "\"many\""),
              std::string::npos);
    EXPECT_NE(refusal("time_s,mobile\n0,12abc\n").find("frames.csv:2"), std::string::npos);
    EXPECT_NE(refusal("time_s,mobile\n0,\n").find("frames.csv:2"), std::string::npos);
    EXPECT_NE(refusal("time_s,time_s\n").find("frames.csv:1: column \"time_s\" is there twice"),
              std::string::npos);
    EXPECT_NE(refusal("time_s,,mobile\n").find("frames.csv:1"), std::string::npos);
    EXPECT_NE(refusal("").find("frames.csv:1"), std::string::npos);
}

TEST_F(RunTableTest, MissingFileAndFolderAreRefused)
{
    EXPECT_THROW(RunTable::readRun(folder_ / "nowhere"), InputError);
    EXPECT_THROW(RunTable::read(folder_), InputError);
}

}  // namespace
}  // namespace sandflow
