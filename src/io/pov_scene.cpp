#include "io/pov_scene.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/camera_frame.h"
#include "io/pov_mesh.h"
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

/// True for a mesh solid whose look is not "none".
bool isDrawnMesh(const SolidSpec& solid)
{
    return solid.shape == SolidShape::mesh && solid.look != "none";
}

/// True for "solid_N.inc" as povMeshFileName makes it.
bool isMeshFileName(std::string_view name)
{
    constexpr std::string_view prefix = "solid_";
    constexpr std::string_view suffix = ".inc";
    if (!name.starts_with(prefix) || !name.ends_with(suffix) ||
        name.size() <= prefix.size() + suffix.size()) {
        return false;
    }
    name.remove_prefix(prefix.size());
    name.remove_suffix(suffix.size());
    return name.size() <= 9 && name.find_first_not_of("0123456789") == std::string_view::npos &&
           (name.size() == 1 || name.front() != '0');
}

}  // namespace

std::string povFrameName(std::uint64_t frame)
{
    return fmt::format("frame_{:06}.inc", frame);
}

bool isPovSceneFileName(std::string_view name)
{
    return name == kGeneratedName || isMeshFileName(name) ||
           std::ranges::find(kHandWrittenNames, name) != kHandWrittenNames.end();
}

std::string povMeshFileName(std::size_t solid)
{
    return fmt::format("solid_{}.inc", solid);
}

std::string formatRunScene(const Scene& scene, const PovSceneInfo& info,
                           std::span<const SceneMesh> meshes)
{
    const double unit = scene.grains.radius;
    const Box3 sand = info.sand.isEmpty() ? estimateSandBox(scene, meshes) : info.sand;
    const CameraFrame camera = frameCamera(scene, sand, meshes);
    const Box3 things = measurePictureBox(scene, sand, meshes);
    std::string text =
        fmt::format("// Constants, camera and solids of this run. Lengths are in mean\n"
                    "// grain radii, axes are (x, z, y) of the simulator.\n"
                    "#declare RadiusInMetres = {};\n"
                    "#declare NFrames = {};\n"
                    "#declare FramesPerSecond = {};\n"
                    "#declare SandMin = {};\n"
                    "#declare SandMax = {};\n"
                    "#declare PictureSize = {};  // of sand and meshes together\n"
                    "#declare CameraPosition = {};\n"
                    "#declare CameraLookAt = {};\n"
                    "#declare CameraAngle = {};\n\n",
                    povNumber(unit), info.frameCount, povNumber(scene.time.framesPerSecond),
                    povVector(sand.min() / unit), povVector(sand.max() / unit),
                    povNumber(things.diagonal().norm() / unit), povVector(camera.position / unit),
                    povVector(camera.lookAt / unit), povNumber(camera.angle));
    for (std::size_t index = 0; index < scene.solids.size(); ++index) {
        if (isDrawnMesh(scene.solids[index])) {
            text += fmt::format("#include \"{}\"\n", povMeshFileName(index));
        }
    }
    return text + formatPovSolids(scene, camera.position, meshes);
}

void writePovScene(const std::string& runFolder, const std::string& povrayFolder,
                   const Scene& scene, const PovSceneInfo& info, std::span<const SceneMesh> meshes)
{
    const std::filesystem::path folder(runFolder);
    // First, because it finds out whether everything can be drawn.
    const std::string runScene = formatRunScene(scene, info, meshes);
    for (std::size_t index = 0; index < scene.solids.size(); ++index) {
        const std::string path = (folder / povMeshFileName(index)).string();
        if (isDrawnMesh(scene.solids[index]) && !std::filesystem::exists(path)) {
            writeFileAtomically(path, formatPovMesh(povMeshName(index), *meshOf(meshes, index),
                                                    scene.grains.radius));
        }
    }
    writeFileAtomically((folder / kGeneratedName).string(), runScene);
    for (std::string_view name : kHandWrittenNames) {
        copyHandWritten(std::string(name), povrayFolder, folder);
    }
}

}  // namespace sandflow
