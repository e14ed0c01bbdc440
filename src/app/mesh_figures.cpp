#include "app/mesh_figures.h"

#include <fmt/format.h>

#include <filesystem>

namespace sandflow {

std::vector<MeshFigures> describeMeshes(const Scene& scene, const SolidSet& solids)
{
    std::vector<MeshFigures> all;
    for (const MeshSolid& mesh : solids.meshes()) {
        const std::string& name = scene.solids[static_cast<std::size_t>(mesh.solid)].name;
        MeshFigures figures;
        figures.name = name.empty() ? fmt::format("solids[{}]", mesh.solid) : name;
        figures.file = mesh.file;
        figures.triangles = mesh.mesh.triangles.size();
        figures.size = boundsOf(mesh.mesh).sizes();
        figures.volume = signedVolumeOf(mesh.mesh);
        figures.particles = mesh.cover.points.size();
        figures.secondsToLoad = mesh.secondsToLoad;
        figures.secondsToCover = mesh.secondsToCover;
        all.push_back(figures);
    }
    return all;
}

std::string formatMesh(const MeshFigures& mesh)
{
    return fmt::format(
        "{:<12} {}: {} triangles, {:.3g} x {:.3g} x {:.3g} m, {:.3g} m3, covered by {} particles "
        "(loaded in {:.2f} s, covered in {:.2f} s)",
        mesh.name, std::filesystem::path(mesh.file).filename().string(), mesh.triangles,
        mesh.size.x(), mesh.size.y(), mesh.size.z(), mesh.volume, mesh.particles,
        mesh.secondsToLoad, mesh.secondsToCover);
}

void writeMesh(JsonWriter& json, const MeshFigures& mesh)
{
    json.beginObject();
    json.member("name", mesh.name).member("file", mesh.file);
    json.member("triangles", mesh.triangles).member("particles", mesh.particles);
    json.member("size_x_m", mesh.size.x()).member("size_y_m", mesh.size.y());
    json.member("size_z_m", mesh.size.z()).member("volume_m3", mesh.volume);
    json.member("load_s", mesh.secondsToLoad).member("cover_s", mesh.secondsToCover);
    json.endObject();
}

}  // namespace sandflow
