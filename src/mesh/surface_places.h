#pragma once

#include "mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// A point of a mesh, m, and the triangle it lies in.
struct SurfacePlace {
    Vec3 point;
    std::uint32_t triangle;
};

/// `count` places spread over a mesh, uniform by area and stratified: the mesh is cut into as many
/// stretches of equal area, triangle after triangle, and each holds one place. They are computed
/// when asked for, from the seed and their number alone, so their count costs no memory.
class SurfacePlaces {
public:
    /// Keeps a reference to the mesh, which must have an area.
    SurfacePlaces(const TriangleMesh& mesh, std::uint64_t count, std::uint64_t seed);

    SurfacePlace at(std::uint64_t number) const;

private:
    std::uint32_t triangleAt(double along) const;

    const TriangleMesh& mesh_;
    std::vector<double> areaUpTo_;  ///< m2, of all triangles up to and including this one
    double stretch_;                ///< m2
    std::uint64_t seed_;

    /// The whole area in as many equal slots as there are triangles, and the triangle in which each
    /// begins: from there it is a step or two to any place of the slot.
    std::vector<std::uint32_t> slotBegin_;
    double slotsPerArea_;  ///< 1/m2
};

}  // namespace sandflow
