#pragma once

#include "mesh/crossing_grid.h"
#include "mesh/solid_interval.h"

namespace sandflow {

/// The solid inside a mesh, vertical line by vertical line. Made once; all queries are const and
/// may run in many threads.
///
/// Solid is where the winding number is not 0, so shells may lie in each other (those that face
/// inwards are cavities), overlap, or be folded. Corners are rounded in x and y to a 2^-30 of the
/// width of the mesh; see CrossingGrid for lines that touch edges.
///
/// Where the mesh has a hole, the crossings of a line do not balance. Then three lines at a
/// distance of `thin` are asked, and what two of them call solid is, if two of them cross the mesh
/// and balance: that closes cracks. Else a surface that faces down is paired with the next one
/// above it that faces up; any left alone becomes a slab, `thin` thick, below the surface. An open
/// sheet (terrain) is such a slab all over.
class MeshColumns {
public:
    /// The mesh is in the simulator's axes, z up; thin > 0, m. May have no triangles.
    MeshColumns(const TriangleMesh& mesh, double thin);

    /// Stretches of the line (x, y) inside the solid, disjoint and ascending; replaces `out`. Their
    /// ends belong to them.
    void solidIntervalsAt(double x, double y, std::vector<SolidInterval>& out) const;
    /// True if solidIntervalsAt() of the line through p has a stretch that holds its height.
    bool contains(const Vec3& p) const;

    /// Of the mesh, m. Slabs may reach `thin` below it.
    const Eigen::AlignedBox3d& bounds() const { return grid_.bounds(); }
    /// m, a power of two; corners and lines are moved by up to half of it along x and y.
    double latticeSpacing() const { return grid_.latticeSpacing(); }

    /// False: no line whatsoever is open. True: some edges have no partner, be it only where
    /// triangles meet a longer edge halfway.
    bool isOpen() const { return !grid_.isClosed(); }
    /// True if the crossings of the line (x, y) do not balance.
    bool isOpenAt(double x, double y) const;
    /// How many lines are open, of linesPerEdge^2 spread evenly over the bounds.
    std::size_t countOpenLines(int linesPerEdge) const;

private:
    bool isNear(const Vec3& p) const;
    void appendPatched(double x, double y, const std::vector<Crossing>& crossings,
                       std::vector<SolidInterval>& out) const;

    CrossingGrid grid_;
    double thin_;  ///< m
};

}  // namespace sandflow
