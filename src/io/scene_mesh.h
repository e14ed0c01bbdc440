#pragma once

#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace sandflow {

/// The surface of a mesh solid where it stands in the scene: what the picture needs to know of it.
struct SceneMesh {
    std::size_t solid = 0;  ///< its place in Scene::solids
    TriangleMesh mesh;      ///< m, in the scene's axes
};

/// The mesh of a solid; null if it was not handed over.
inline const TriangleMesh* meshOf(std::span<const SceneMesh> meshes, std::size_t solid)
{
    const auto found = std::ranges::find(meshes, solid, &SceneMesh::solid);
    return found == meshes.end() ? nullptr : &found->mesh;
}

}  // namespace sandflow
