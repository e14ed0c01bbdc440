#pragma once

#include "mesh/clean_mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace sandflow {

struct LoadedMesh {
    TriangleMesh mesh;
    MeshReport report;
};

/// Reads a triangle mesh in the file's own axes and units: .ply, .obj, .stl, .off, .gltf or .glb,
/// in any case. What can be repaired is, and the report says so in a sentence per repair; what
/// cannot is refused with InputError in one sentence. The same file gives the same mesh.
LoadedMesh loadMesh(const std::filesystem::path& path);

/// The same for a file that is in memory; `extension` as ".ply", `name` for messages. A glTF file
/// must hold its buffers.
LoadedMesh loadMeshFromMemory(std::string_view bytes, const std::string& extension,
                              const std::string& name);

}  // namespace sandflow
