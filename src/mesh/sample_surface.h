#pragma once

#include "mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// Points of a surface and the outward unit normals of the triangles they lie in, one each.
struct SurfaceSamples {
    std::vector<Vec3> points;  ///< m
    std::vector<Vec3> normals;
};

/// The most samples a mesh may need; their points and normals take 0.4 GB, twice that while made.
inline constexpr std::uint64_t kMostSurfaceSamples = 8'000'000;

/// Covers a mesh with samples so that no point of it is farther than `gap` [m] from a sample whose
/// normal is less than 60 degrees off: so every face of a thin part has samples of its own. Such
/// samples are no closer to each other than 0.85 gap, mostly not closer than the gap itself.
///
/// The same bits for the same mesh, gap and seed on every machine. Triangles without area count as
/// the lines they are; for them any normal will do. Throws InputError if the mesh needs more than
/// kMostSurfaceSamples, or is too wide or too far from the origin for so small a gap.
SurfaceSamples sampleSurface(const TriangleMesh& mesh, double gap, std::uint64_t seed);

}  // namespace sandflow
