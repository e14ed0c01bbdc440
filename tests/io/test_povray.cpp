#include "io/pov_frame.h"
#include "io/pov_scene.h"
#include "mesh/shapes.h"
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
        writePovScene(folder_.path(), std::string(SANDFLOW_SOURCE_DIR) + "/povray", scene_, info,
                      meshes_);
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
    std::vector<SceneMesh> meshes_;
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

/// The triangles of several meshes as one.
TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts)
{
    TriangleMesh whole;
    for (const TriangleMesh& part : parts) {
        const auto first = static_cast<std::uint32_t>(whole.points.size());
        whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
        for (const auto& t : part.triangles) {
            whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
    }
    return whole;
}

TEST_F(PovrayTest, mirrorsNoMesh)
{
    // Seen from the front and above: a post at the left, a lower one in front of it, and a bar from
    // the post's top to the right. Every reflection of it looks different.
    scene_.solids.clear();
    SolidSpec figure;
    figure.shape = SolidShape::mesh;
    figure.name = "figure";
    figure.look = "bronze";
    scene_.solids.push_back(figure);
    meshes_ = {{0, joinMeshes({makeBoxMesh(Vec3(-0.4, 0.0, 0.0), Vec3(-0.3, 0.1, 1.0)),
                               makeBoxMesh(Vec3(-0.3, 0.0, 0.9), Vec3(0.4, 0.1, 1.0)),
                               makeBoxMesh(Vec3(-0.4, -1.0, 0.0), Vec3(-0.3, -0.9, 0.3))})}};
    scene_.camera.position = Vec3(0.0, -5.0, 2.0);
    scene_.camera.lookAt = Vec3(0.0, 0.0, 0.5);
    scene_.camera.angle = 40.0;
    writeRun();
    ASSERT_EQ(render("Declare=Quality=0"), 0) << output_;
    EXPECT_EQ(output_.find("Warning"), std::string::npos) << output_;
    const std::string with = readPixels("scene.ppm");
    scene_.solids.clear();
    meshes_.clear();
    writeRun();
    ASSERT_EQ(render("Declare=Quality=0"), 0) << output_;
    const std::string without = readPixels("scene.ppm");

    const Vec3 eye = *scene_.camera.position;
    const Vec3 forward = (*scene_.camera.lookAt - eye).normalized();
    const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
    const auto changes = [&](const Vec3& point) {
        const Vec3 offset = point - eye;
        const double scale =
            0.5 * kWidth / (offset.dot(forward) * std::tan(0.5 * 40.0 * kPi / 180.0));
        const int x = static_cast<int>(0.5 * kWidth + scale * offset.dot(right));
        const int y =
            static_cast<int>(0.5 * kHeight - scale * offset.dot(right.cross(forward)));
        const auto a = pixelAt(with, x, y);
        const auto b = pixelAt(without, x, y);
        return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 40;
    };
    // PictureSize and with it the lights differ a little between the two, but nothing else is lit
    // but the sand, which lies elsewhere.
    EXPECT_TRUE(changes(Vec3(-0.35, 0.0, 0.65)));   // post
    EXPECT_TRUE(changes(Vec3(0.3, 0.0, 0.95)));     // bar
    EXPECT_TRUE(changes(Vec3(-0.35, -1.0, 0.15)));  // the lower one
    EXPECT_FALSE(changes(Vec3(0.35, 0.0, 0.65)));
    EXPECT_FALSE(changes(Vec3(0.35, -1.0, 0.15)));
    EXPECT_FALSE(changes(Vec3(0.0, 0.0, 0.5)));
}

TEST_F(PovrayTest, drawsMeshesOnlyWhileTheyExistAndThoseWithHairlineTriangles)
{
    SolidSpec figure;
    figure.shape = SolidShape::mesh;
    figure.name = "figure";
    figure.look = "stone";
    figure.from = 1.5 / 30.0;
    figure.until = 2.5 / 30.0;
    scene_.solids.push_back(figure);
    TriangleMesh box = makeBoxMesh(Vec3(-0.05, -0.05, 0.0), Vec3(0.05, 0.05, 0.2));
    // So thin that its corners are written as one point.
    box.points.push_back(box.points[0] + Vec3(1e-9, 0.0, 0.0));
    box.triangles.push_back({0, 8, 1});
    box.triangles.push_back({0, 8, 2});
    meshes_ = {{1, box}};
    writeRun();
    ASSERT_EQ(render("Declare=Quality=0 +KFI1 +KFF3"), 0) << output_;
    EXPECT_EQ(output_.find("Warning"), std::string::npos) << output_;
    const std::string before = readPixels("scene1.ppm");
    EXPECT_TRUE(before == readPixels("scene3.ppm"));
    EXPECT_FALSE(before == readPixels("scene2.ppm"));
}

TEST_F(PovrayTest, drawsEveryShapeAndMaterialInEveryQuality)
{
    for (const char* look : {"floor", "glass", "ceramic", "wood", "stone", "jade", "bronze"}) {
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
        SolidSpec figure;
        figure.shape = SolidShape::mesh;
        figure.name = look;
        figure.look = look;
        meshes_.push_back({scene_.solids.size(), makeBoxMesh(Vec3(x, -0.3, 0.0),
                                                             Vec3(x + 0.05, -0.25, 0.05))});
        scene_.solids.push_back(figure);
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
