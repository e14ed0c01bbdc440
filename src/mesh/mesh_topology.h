#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandflow {

/// An edge of a mesh with the sides of triangles that run along it.
struct MeshEdge {
    std::uint32_t lo;        ///< lower point
    std::uint32_t hi;        ///< higher point
    std::uint32_t forward;   ///< sides from lo to hi
    std::uint32_t backward;  ///< sides from hi to lo
    std::size_t firstSide;   ///< into MeshEdges::sides; forward ones first

    std::uint32_t sides() const { return forward + backward; }
};

struct MeshEdges {
    std::vector<MeshEdge> edges;       ///< by (lo, hi)
    std::vector<std::uint32_t> sides;  ///< triangles, edge by edge
};

MeshEdges findEdges(const TriangleMesh& mesh);

/// Which component each triangle belongs to: triangles with a common point are connected.
struct MeshComponents {
    std::vector<std::uint32_t> ofTriangle;
    std::uint32_t count = 0;  ///< numbered by their first triangle
};

MeshComponents findComponents(const TriangleMesh& mesh);

/// Of each component, the widest of the holes bounded by edges with a single triangle: the diagonal
/// of the bounding box of a connected set of them. 0 without a hole.
std::vector<double> findHoles(const TriangleMesh& mesh, const MeshEdges& edges,
                              const MeshComponents& components);

}  // namespace sandflow
