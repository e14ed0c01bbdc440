#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace sandflow {

/// What a call of the program left behind.
struct ProgramResult {
    int exitCode = -1;
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
};

/// A test with a folder of its own, in which the program is called as a user calls it.
class ProgramTest : public ::testing::Test {
protected:
    ProgramTest()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "sandflow_app_XXXXXX");
        if (::mkdtemp(pattern.data()) == nullptr) {
            throw std::runtime_error("no temporary folder");
        }
        folder_ = pattern;
    }
    ~ProgramTest() override
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    /// Calls `sandflow ARGUMENTS` through the shell, in the test's folder.
    ProgramResult call(const std::string& arguments) const
    {
        const std::string command = "cd '" + folder_ + "' && '" SANDFLOW_BINARY "' " + arguments +
                                    " >.stdout 2>.stderr </dev/null";
        const int status = std::system(command.c_str());
        ProgramResult result;
        result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
        result.output = read(".stdout");
        result.errors = read(".stderr");
        return result;
    }

    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

    std::string read(const std::string& name) const
    {
        std::ifstream in(path(name), std::ios::binary);
        EXPECT_TRUE(in.is_open()) << name;
        return {std::istreambuf_iterator<char>(in), {}};
    }

    void write(const std::string& name, const std::string& content) const
    {
        std::ofstream(path(name), std::ios::binary) << content;
    }

    /// 200 grains fall from a spout onto a rough floor; 12 frames.
    void writeTinyScene(const std::string& name, const std::string& more = "") const
    {
        write(name,
              "name = \"tiny\"\n"
              "[time]\n"
              "duration = 0.4\n"
              "[[solids]]\n"
              "shape = \"plane\"\n"
              "[[emitters]]\n"
              "kind = \"jet\"\n"
              "name = \"spout\"\n"
              "count = 200\n"
              "rate = 1000\n"
              "position = [0, 0, 0.1]\n"
              "radius = 0.03\n"
              "speed = 1.0\n" +
                  more);
    }

private:
    std::string folder_;
};

}  // namespace sandflow
