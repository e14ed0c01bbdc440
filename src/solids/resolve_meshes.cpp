#include "solids/resolve_meshes.h"

#include <filesystem>

namespace sandflow {

Scene resolveMeshes(Scene scene, const SolidSet& solids)
{
    for (const MeshSolid& mesh : solids.meshes()) {
        SolidSpec& solid = scene.solids[static_cast<std::size_t>(mesh.solid)];
        solid.mesh = std::filesystem::absolute(mesh.file).string();
        solid.standIn.clear();
    }
    return scene;
}

}  // namespace sandflow
