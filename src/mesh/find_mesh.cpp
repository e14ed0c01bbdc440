#include "mesh/find_mesh.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace sandflow {
namespace {

std::vector<std::filesystem::path> listSearchPath()
{
    std::vector<std::filesystem::path> folders;
    const char* variable = std::getenv("SANDFLOW_MESH_PATH");
    std::string_view left = variable == nullptr ? "" : variable;
    while (!left.empty()) {
        const std::string_view folder = left.substr(0, left.find(':'));
        if (!folder.empty()) {
            folders.emplace_back(folder);
        }
        left.remove_prefix(std::min(folder.size() + 1, left.size()));
    }
    return folders;
}

}  // namespace

std::vector<std::filesystem::path> listMeshPlaces(const std::string& name,
                                                  const std::filesystem::path& sceneFolder)
{
    const std::filesystem::path file(name);
    if (file.is_absolute()) {
        return {file};
    }
    std::vector<std::filesystem::path> places = {sceneFolder / file};
    for (const std::filesystem::path& folder : listSearchPath()) {
        places.push_back(folder / file);
        if (file.has_parent_path()) {
            places.push_back(folder / file.filename());
        }
    }
    places.push_back(std::filesystem::path(SANDFLOW_MESH_DIR) / file.filename());
    return places;
}

std::optional<std::filesystem::path> findMesh(const std::string& name,
                                              const std::filesystem::path& sceneFolder)
{
    for (const std::filesystem::path& place : listMeshPlaces(name, sceneFolder)) {
        std::error_code error;
        const std::filesystem::file_status status = std::filesystem::status(place, error);
        // A pipe or device is found, for loadMesh to say that it is none.
        if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
            return place;
        }
    }
    return std::nullopt;
}

}  // namespace sandflow
