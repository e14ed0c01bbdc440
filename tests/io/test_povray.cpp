#include "io/pov_frame.h"
#include "io/pov_scene.h"
#include "sample_snapshot.h"
#include "temp_folder.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace sandflow {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 36;

/// A run of three frames in a fresh folder, drawn by POV-Ray.
class PovrayTest : public testing::Test {
protected:
    void SetUp() override
    {
        ASSERT_EQ(std::system("command -v povray > /dev/null 2>&1"), 0)
            << "POV-Ray is not installed; scripts/install_packages.sh does it";
        SolidSpec ground;
        ground.name = "ground";
        ground.rough = true;
        scene_.solids.push_back(ground);
    }

    void writeRun()
    {
        const Snapshot heap = makeHeap(3000);
        for (std::uint64_t frame = 1; frame <= 3; ++frame) {
            writePovFrame(folder_.file(povFrameName(frame)), heap, options_);
        }
        PovSceneInfo info;
        info.frameCount = 3;
        info.sand = measureSandBox(heap);
        writePovScene(folder_.path(), std::string(SANDFLOW_SOURCE_DIR) + "/povray", scene_, info);
    }

    /// Runs POV-Ray in the run's folder; its exit code. What it printed is in output_.
    int render(const std::string& options)
    {
        const std::string command = fmt::format(
            "cd '{}' && povray scene.ini +W{} +H{} -A +FP +Oscene.ppm +WT2 -GD -GR -GS {} "
            "> log 2>&1",
            folder_.path(), kWidth, kHeight, options);
        const int status = std::system(command.c_str());
        output_ = slurp(folder_.file("log"));
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    /// Pixel bytes of a binary PPM of the size asked for.
    std::string readPixels(const std::string& name)
    {
        const std::string file = slurp(folder_.file(name));
        constexpr std::size_t bytes = 3 * kWidth * kHeight;
        EXPECT_EQ(file.substr(0, 2), "P6") << name;
        EXPECT_GT(file.size(), bytes) << name;
        return file.size() > bytes ? file.substr(file.size() - bytes) : std::string(bytes, '\0');
    }

    static std::array<int, 3> pixelAt(const std::string& pixels, int x, int y)
    {
        const auto at = static_cast<std::size_t>(3 * (y * kWidth + x));
        return {static_cast<unsigned char>(pixels[at]), static_cast<unsigned char>(pixels[at + 1]),
                static_cast<unsigned char>(pixels[at + 2])};
    }

    TempFolder folder_;
    Scene scene_;
    PovFrameOptions options_;
    std::string output_;
};

TEST_F(PovrayTest, drawsTheLastFrameOfAPlainCallWithoutWarnings)
{
    writeRun();
    ASSERT_EQ(render(""), 0) << output_;
    EXPECT_EQ(output_.find("Warning"), std::string::npos) << output_;
    const std::string pixels = readPixels("scene.ppm");
    const auto ground = pixelAt(pixels, 2, 33);
    EXPECT_GT(*std::ranges::min_element(ground), 150) << "the ground is pale";
    // The heap takes about two thirds of the width and is yellower than the ground on the whole;
    // single pixels may be dark gaps.
    int sandPixels = 0;
    std::array<int, 3> sum{};
    for (int x = 0; x < kWidth; ++x) {
        const auto pixel = pixelAt(pixels, x, 20);
        if (std::abs(pixel[1] - ground[1]) > 25) {
            ++sandPixels;
            sum[0] += pixel[0];
            sum[2] += pixel[2];
        }
    }
    EXPECT_GT(sandPixels, kWidth * 5 / 10);
    EXPECT_LT(sandPixels, kWidth * 8 / 10);
    EXPECT_GT(1.0 * sum[0] / sum[2], 1.1 * ground[0] / ground[2]);
}

TEST_F(PovrayTest, fallsBackToTheLastFrameThatIsThere)
{
    writeRun();
    std::filesystem::remove(folder_.file("frame_000003.inc"));
    EXPECT_EQ(render("Declare=Quality=0"), 0) << output_;
    std::filesystem::remove(folder_.file("frame_000002.inc"));
    std::filesystem::remove(folder_.file("frame_000001.inc"));
    EXPECT_NE(render("Declare=Quality=0"), 0) << output_;
}

TEST_F(PovrayTest, drawsOneFrameOfAMovieAndFailsWithoutIt)
{
    writeRun();
    ASSERT_EQ(render("Declare=Quality=0 +KFI1 +KFF3 +SF2 +EF2"), 0) << output_;
    EXPECT_TRUE(std::filesystem::exists(folder_.file("scene2.ppm")));
    EXPECT_FALSE(std::filesystem::exists(folder_.file("scene1.ppm")));
    std::filesystem::remove(folder_.file("frame_000002.inc"));
    EXPECT_NE(render("Declare=Quality=0 +KFI1 +KFF3 +SF2 +EF2"), 0) << output_;
}

TEST_F(PovrayTest, showsSolidsOnlyWhileTheyExist)
{
    SolidSpec plate;
    plate.shape = SolidShape::disc;
    plate.name = "plate";
    plate.look = "wood";
    plate.point = Vec3(0.0, 0.0, 0.1);
    plate.radius = 0.1;
    plate.from = 1.5 / 30.0;
    plate.until = 2.5 / 30.0;
    scene_.solids.push_back(plate);
    writeRun();
    ASSERT_EQ(render("Declare=Quality=0 +KFI1 +KFF3"), 0) << output_;
    const std::string before = readPixels("scene1.ppm");
    EXPECT_TRUE(before == readPixels("scene3.ppm"));
    EXPECT_FALSE(before == readPixels("scene2.ppm"));
}

TEST_F(PovrayTest, drawsEveryShapeAndMaterialInEveryQuality)
{
    for (const char* look : {"floor", "glass", "ceramic", "wood"}) {
        const double x = 0.1 * static_cast<double>(scene_.solids.size());
        SolidSpec box;
        box.shape = SolidShape::box;
        box.name = look;
        box.look = look;
        box.min = Vec3(x, 0.1, 0.0);
        box.max = Vec3(x + 0.05, 0.2, 0.1);
        box.hollow = scene_.solids.size() % 2 == 0;
        scene_.solids.push_back(box);
        SolidSpec tube;
        tube.shape = SolidShape::cylinder;
        tube.name = look;
        tube.look = look;
        tube.point = Vec3(-x, -0.1, 0.0);
        tube.radius = 0.03;
        tube.height = 0.1;
        tube.hollow = !box.hollow;
        tube.floor = true;
        scene_.solids.push_back(tube);
    }
    options_.colourBy = GrainColour::state;
    writeRun();
    for (int quality : {0, 1, 2}) {
        EXPECT_EQ(render(fmt::format("Declare=Quality={}", quality)), 0) << output_;
        EXPECT_EQ(output_.find("Warning"), std::string::npos) << output_;
    }
}

}  // namespace
}  // namespace sandflow
