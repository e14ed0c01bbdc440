#include "io/pov_scene.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/camera_frame.h"
#include "io/pov_solids.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace sandflow {
namespace {

constexpr std::string_view kGeneratedName = "run_scene.inc";
constexpr std::array<std::string_view, 4> kHandWrittenNames{"scene.pov", "scene.ini",
                                                            "materials.inc", "lights.inc"};

void copyHandWritten(const std::string& name, const std::filesystem::path& from,
                     const std::filesystem::path& to)
{
    std::string content;
    try {
        content = readWholeFile((from / name).string());
    } catch (const InputError& error) {
        throw SystemError(fmt::format("the picture files are not installed: {}", error.what()));
    }
    writeFileAtomically((to / name).string(), content);
}

}  // namespace

std::string povFrameName(std::uint64_t frame)
{
    return fmt::format("frame_{:06}.inc", frame);
}

bool isPovSceneFileName(std::string_view name)
{
    return name == kGeneratedName ||
           std::ranges::find(kHandWrittenNames, name) != kHandWrittenNames.end();
}

std::string formatRunScene(const Scene& scene, const PovSceneInfo& info)
{
    const double unit = scene.grains.radius;
    const Box3 sand = info.sand.isEmpty() ? estimateSandBox(scene) : info.sand;
    const CameraFrame camera = frameCamera(scene, sand);
    return fmt::format("// Constants, camera and solids of this run. Lengths are in mean\n"
                       "// grain radii, axes are (x, z, y) of the simulator.\n"
                       "#declare RadiusInMetres = {};\n"
                       "#declare NFrames = {};\n"
                       "#declare FramesPerSecond = {};\n"
                       "#declare SandMin = {};\n"
                       "#declare SandMax = {};\n"
                       "#declare CameraPosition = {};\n"
                       "#declare CameraLookAt = {};\n"
                       "#declare CameraAngle = {};\n\n",
                       povNumber(unit), info.frameCount, povNumber(scene.time.framesPerSecond),
                       povVector(sand.min() / unit), povVector(sand.max() / unit),
                       povVector(camera.position / unit), povVector(camera.lookAt / unit),
                       povNumber(camera.angle)) +
           formatPovSolids(scene, camera.position);
}

void writePovScene(const std::string& runFolder, const std::string& povrayFolder,
                   const Scene& scene, const PovSceneInfo& info)
{
    const std::filesystem::path folder(runFolder);
    writeFileAtomically((folder / kGeneratedName).string(), formatRunScene(scene, info));
    for (std::string_view name : kHandWrittenNames) {
        copyHandWritten(std::string(name), povrayFolder, folder);
    }
}

}  // namespace sandflow
