#pragma once

#include "io/picture_extent.h"
#include "io/scene_mesh.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace sandflow {

/// What the picture needs to know about the run beyond its scene.
struct PovSceneInfo {
    std::uint64_t frameCount = 0;  ///< frames are numbered 1 to frameCount
    Box3 sand;                     ///< m, at the end of the run; aims the camera and the lights
};

/// "frame_NNNNNN.inc", at least six digits: the name scene.pov includes.
std::string povFrameName(std::uint64_t frame);

/// True for the files that writePovScene puts into a run folder.
bool isPovSceneFileName(std::string_view name);

/// "solid_N.inc": the file with the mesh of scene.solids[N].
std::string povMeshFileName(std::size_t solid);

/// The generated half of the picture: constants, camera and solids of one scene. `meshes` holds the
/// surface of every mesh solid that is drawn.
std::string formatRunScene(const Scene& scene, const PovSceneInfo& info,
                           std::span<const SceneMesh> meshes = {});

/// Puts run_scene.inc, a solid_N.inc for each mesh that is drawn (both generated) and the
/// hand-written scene.pov, scene.ini, materials.inc and lights.inc of povrayFolder into the run
/// folder, so that
///
///     povray scene.ini                               draws the last frame there is,
///     povray scene.ini +KFI1 +KFF<N> +SF<n> +EF<n>   draws frame n (N >= 2)
///
/// when called in that folder. To be called when a run starts, with an estimate of the sand's
/// place, and again at its end; a mesh file that is there already is left alone, because meshes do
/// not move. Throws InputError for a look or a solid that cannot be drawn, also for a mesh solid
/// that is not among `meshes`; SystemError if a file cannot be read or written.
void writePovScene(const std::string& runFolder, const std::string& povrayFolder,
                   const Scene& scene, const PovSceneInfo& info,
                   std::span<const SceneMesh> meshes = {});

}  // namespace sandflow
