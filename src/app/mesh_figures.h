#pragma once

#include "io/json_writer.h"
#include "scene/scene.h"
#include "solids/solid_set.h"

#include <string>
#include <vector>

namespace sandflow {

/// What a user wants to know of a mesh that was loaded.
struct MeshFigures {
    std::string name;              ///< of the solid, or solids[N]
    std::string file;
    std::size_t triangles = 0;
    Vec3 size = Vec3::Zero();      ///< m, of its box
    double volume = 0.0;           ///< m3, signed
    std::size_t particles = 0;     ///< that cover it
    double secondsToLoad = 0.0;
    double secondsToCover = 0.0;   ///< little when they were kept from another run
};

std::vector<MeshFigures> describeMeshes(const Scene& scene, const SolidSet& solids);
std::string formatMesh(const MeshFigures& mesh);
void writeMesh(JsonWriter& json, const MeshFigures& mesh);

}  // namespace sandflow
