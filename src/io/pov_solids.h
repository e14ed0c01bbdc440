#pragma once

#include "io/scene_mesh.h"
#include "scene/scene.h"

#include <string>

namespace sandflow {

/// A number POV-Ray reads: shortest form, a point whatever the locale. InternalError for NaN or
/// infinity.
std::string povNumber(double number);

/// "<x,z,y>": POV-Ray's axes for a vector in the simulator's.
std::string povVector(const Vec3& vector);

/// "#macro RunSolids()": the solids of a scene, lengths in mean grain radii, each within a test of
/// RunTime (s) if it does not exist for ever. `camera` (m): a plane it would see from behind is
/// left out, because it would hide everything. Throws InputError for a look that has no material
/// and for a mesh solid that is not among `meshes`. A mesh is called by its name, povMeshName; the
/// files of the meshes must have been included before.
std::string formatPovSolids(const Scene& scene, const Vec3& camera,
                            std::span<const SceneMesh> meshes = {});

/// What the mesh of a solid is called in the picture: "Solid3" for that of scene.solids[3].
std::string povMeshName(std::size_t solid);

}  // namespace sandflow
