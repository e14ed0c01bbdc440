#include "app/program.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <set>
#include <vector>

namespace sandflow {
namespace {

/// An 8-bit RGB picture, rows from the top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;

    std::size_t countColours() const
    {
        std::set<std::uint32_t> colours;
        for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
            colours.insert(bytes[i] * 65536U + bytes[i + 1] * 256U + bytes[i + 2]);
        }
        return colours.size();
    }
};

std::uint32_t readNumber(const std::string& file, std::size_t at)
{
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        number = number << 8 | static_cast<std::uint8_t>(file.at(at + i));
    }
    return number;
}

/// The neighbour (left a, above b, above left c) that is nearest to a + b - c.
int predictPaeth(int a, int b, int c)
{
    const int p = a + b - c;
    if (std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c)) {
        return a;
    }
    return std::abs(p - b) <= std::abs(p - c) ? b : c;
}

/// Decodes a PNG of 8-bit RGB without interlacing, which is what POV-Ray writes.
Picture decodePng(const std::string& file)
{
    Picture picture;
    if (file.size() < 33 || file.compare(1, 3, "PNG") != 0 || file[24] != 8 || file[25] != 2 ||
        file[28] != 0) {
        ADD_FAILURE() << "no PNG of 8-bit RGB";
        return picture;
    }
    picture.width = static_cast<int>(readNumber(file, 16));
    picture.height = static_cast<int>(readNumber(file, 20));
    std::string packed;
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t length = readNumber(file, at);
        if (file.compare(at + 4, 4, "IDAT") == 0) {
            packed += file.substr(at + 8, length);
        }
        at += length + 12;
    }
    // A row is the number of its filter, then its bytes as differences to what the filter predicts.
    const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
    const auto rows = static_cast<std::size_t>(picture.height);
    std::vector<std::uint8_t> filtered(rows * (row + 1));
    uLongf size = filtered.size();
    EXPECT_EQ(uncompress(filtered.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                         packed.size()),
              Z_OK);
    EXPECT_EQ(size, filtered.size());
    picture.bytes.resize(rows * row);
    for (std::size_t y = 0; y < rows; ++y) {
        const int filter = filtered[y * (row + 1)];
        for (std::size_t i = 0; i < row; ++i) {
            const std::size_t at = y * row + i;
            const int left = i >= 3 ? picture.bytes[at - 3] : 0;
            const int above = y > 0 ? picture.bytes[at - row] : 0;
            const int corner = i >= 3 && y > 0 ? picture.bytes[at - row - 3] : 0;
            const int predicted[] = {0, left, above, (left + above) / 2,
                                     predictPaeth(left, above, corner)};
            picture.bytes[at] = static_cast<std::uint8_t>(filtered[y * (row + 1) + 1 + i] +
                                                          predicted[std::min(filter, 4)]);
        }
    }
    return picture;
}

/// scripts/render.sh on a run of three frames.
class RenderTest : public ProgramTest {
protected:
    void SetUp() override
    {
        ASSERT_EQ(std::system("command -v povray > /dev/null"), 0)
            << "POV-Ray is not installed; scripts/install_packages.sh does it";
        writeTinyScene("tiny.toml");
        ASSERT_EQ(call("run tiny.toml --quiet --frames 3 --out run").exitCode, 0);
    }

    /// Calls a command in the test's folder.
    ProgramResult shell(const std::string& command) const
    {
        const std::string whole =
            "cd '" + path("") + "' && { " + command + "; } >.stdout 2>.stderr </dev/null";
        const int status = std::system(whole.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status, read(".stdout"),
                read(".stderr")};
    }
    ProgramResult render(const std::string& arguments) const
    {
        return shell("'" SANDFLOW_SOURCE_DIR "/scripts/render.sh' " + arguments);
    }

    /// Names in a folder that no finished call may leave there.
    std::size_t countLeftOvers(const std::string& folder) const
    {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
            count += entry.path().filename().string().starts_with("part_") ? 1U : 0U;
        }
        return count;
    }
};

const std::string kSmall = " --size 64x48 --quality preview";

TEST_F(RenderTest, rendersTheFramesAskedForOnce)
{
    ProgramResult result = render("run --frames 1:3 --jobs 2 --out 'my pictures'" + kSmall);
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    std::vector<std::uint8_t> previous;
    for (int frame = 1; frame <= 3; ++frame) {
        const Picture picture =
            decodePng(read(fmt::format("my pictures/frame_00000{}.png", frame)));
        EXPECT_EQ(picture.width, 64);
        EXPECT_EQ(picture.height, 48);
        // A blank one has one colour; that of an empty floor has few.
        EXPECT_GT(picture.countColours(), 100u) << frame;
        EXPECT_FALSE(picture.bytes == previous) << frame;
        previous = picture.bytes;
    }
    EXPECT_EQ(countLeftOvers("run") + countLeftOvers("my pictures"), 0u);

    const auto rerun = [&](const std::string& more) {
        const ProgramResult again = render("run --frames 1:3 --out 'my pictures' " + more);
        EXPECT_EQ(again.exitCode, 0) << again.errors;
        return again.output.substr(std::min(again.output.size(), again.output.find(',')));
    };
    EXPECT_EQ(rerun(kSmall), ", 0 rendered, 3 were there\n");
    // A frame that was written anew is rendered anew; so is every frame for another size, and when
    // the camera has moved.
    write("run/frame_000002.inc", read("run/frame_000002.inc"));
    EXPECT_EQ(rerun(kSmall), ", 1 rendered, 2 were there\n");
    EXPECT_EQ(rerun("--size 64x32 --quality preview"), ", 3 rendered, 0 were there\n");
    EXPECT_EQ(decodePng(read("my pictures/frame_000002.png")).height, 32);
    write("run/run_scene.inc", read("run/run_scene.inc"));
    EXPECT_EQ(rerun("--size 64x32 --quality preview"), ", 3 rendered, 0 were there\n");
}

TEST_F(RenderTest, showsTheLastFrameThatIsThereByDefault)
{
    std::filesystem::remove(path("run/frame_000003.inc"));
    const ProgramResult result = render("run --size=64x48 --quality=preview");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_TRUE(exists("run/frame_000002.png"));
    EXPECT_FALSE(exists("run/frame_000001.png"));
    EXPECT_NE(result.output.find("run/frame_000002.png\n"), std::string::npos) << result.output;
}

TEST_F(RenderTest, rendersARunOfOneFrameAndTheOtherQualities)
{
    ASSERT_EQ(call("run tiny.toml --quiet --frames 1 --out one").exitCode, 0);
    for (const char* quality : {"movie", "final"}) {
        const ProgramResult result =
            render(fmt::format("one --size 32x16 --jobs 1 --out {0} --quality {0}", quality));
        EXPECT_EQ(result.exitCode, 0) << result.errors;
        EXPECT_EQ(decodePng(read(fmt::format("{}/frame_000001.png", quality))).width, 32);
    }
}

TEST_F(RenderTest, refusesBadInputInOneSentence)
{
    ASSERT_EQ(call("run tiny.toml --quiet --frames 1 --no-frames --out bare").exitCode, 0);
    write("file", "");
    const std::pair<const char*, const char*> cases[] = {
        {"", "which run folder? See --help"},
        {"nothing", "nothing: no such run folder"},
        {".", ". holds no run: there is no frames.csv in it"},
        {"bare", "bare holds nothing to draw: it was run with --no-frames"},
        {"run run", "one run folder at a time, not run and run"},
        {"run --fast", "unknown option --fast; see --help"},
        {"run --frames", "--frames needs a value"},
        {"run --frames 2:4", "--frames 2:4: the frames of run are 1 to 3"},
        {"run --frames 0", "--frames 0: the frames of run are 1 to 3"},
        {"run --frames 3:1", "--frames 3:1: the first frame is after the last"},
        {"run --frames all", "--frames all: expected A:B or a single number"},
        {"run --size 64", "--size 64: expected WIDTHxHEIGHT, each 16 to 16384, as in 1280x720"},
        {"run --size 0x48", "--size 0x48: expected WIDTHxHEIGHT, each 16 to 16384, as in 1280x720"},
        {"run --size 20000x48",
         "--size 20000x48: expected WIDTHxHEIGHT, each 16 to 16384, as in 1280x720"},
        {"run --quality best", "--quality best: use preview, movie or final"},
        {"run --jobs 0", "--jobs 0: expected a number from 1 to 999"},
        {"run --out file", "--out file is not a folder"},
    };
    for (const auto& [arguments, sentence] : cases) {
        const ProgramResult result = render(arguments);
        EXPECT_EQ(result.exitCode, 2) << arguments;
        EXPECT_EQ(result.errors, fmt::format("render.sh: {}\n", sentence));
        EXPECT_EQ(result.output, "");
    }
    const ProgramResult help = render("--help");
    EXPECT_EQ(help.exitCode, 0);
    EXPECT_TRUE(help.output.starts_with("usage: scripts/render.sh RUN [options]\n"));
}

TEST_F(RenderTest, namesTheFrameThatIsMissingOrCutOff)
{
    const std::string whole = read("run/frame_000002.inc");
    std::filesystem::remove(path("run/frame_000002.inc"));
    ProgramResult result = render("run --frames 1:3" + kSmall);
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_NE(result.errors.find("frame 2 cannot be rendered: "), std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find("run/frame_000002.inc is missing\n"), std::string::npos)
        << result.errors;
    EXPECT_FALSE(exists("run/frame_000001.png"));

    write("run/frame_000002.inc", whole.substr(0, whole.size() / 2));
    result = render("run --frames 1:3 --jobs 1" + kSmall);
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_TRUE(result.errors.starts_with("render.sh: frame 2 failed; POV-Ray's last words:\n"))
        << result.errors;
    EXPECT_NE(result.errors.find("Parse Error"), std::string::npos) << result.errors;
    EXPECT_TRUE(exists("run/frame_000001.png"));
    EXPECT_FALSE(exists("run/frame_000002.png"));
    EXPECT_FALSE(exists("run/frame_000003.png"));
    EXPECT_EQ(countLeftOvers("run"), 0u);

    // Mended, it goes on.
    write("run/frame_000002.inc", whole);
    result = render("run --frames 1:3" + kSmall);
    EXPECT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_NE(result.output.find(" 2 rendered, 1 were there\n"), std::string::npos)
        << result.output;
}

TEST_F(RenderTest, makesAMovieThatPlaysAnywhere)
{
    ASSERT_EQ(std::system("command -v ffmpeg ffprobe > /dev/null"), 0)
        << "ffmpeg is not installed; scripts/install_packages.sh ffmpeg does it";
    // An odd size: the movie is one pixel smaller, because its colours come in blocks of 2 x 2.
    const ProgramResult result =
        render("run --movie --size 65x49 --quality preview --out movie_of_run");
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_EQ(countLeftOvers("movie_of_run"), 0u);
    const ProgramResult probe = shell(
        "ffprobe -v error -count_frames -of default=nokey=1:noprint_wrappers=1 -show_entries "
        "stream=codec_name,width,height,pix_fmt,color_space,r_frame_rate,nb_read_frames "
        "movie_of_run/movie.mp4");
    EXPECT_EQ(probe.output, "h264\n64\n48\nyuv420p\nbt709\n30/1\n3\n") << probe.errors;
    // The index comes before the pictures.
    const std::string movie = read("movie_of_run/movie.mp4");
    EXPECT_LT(movie.find("moov"), movie.find("mdat"));
}

}  // namespace
}  // namespace sandflow
