#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sandflow {

/// Where the file of a mesh solid may be, in the order in which findMesh looks: an absolute name
/// only there. Others: in the folder of the scene; in each folder of the environment variable
/// SANDFLOW_MESH_PATH (separated by colons) under the name and under its last part; in the
/// meshes/ folder of this project under its last part.
std::vector<std::filesystem::path> listMeshPlaces(const std::string& name,
                                                  const std::filesystem::path& sceneFolder);

/// The first of these places that holds a file.
std::optional<std::filesystem::path> findMesh(const std::string& name,
                                              const std::filesystem::path& sceneFolder);

}  // namespace sandflow
