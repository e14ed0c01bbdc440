#pragma once

#include "mesh/solid_interval.h"
#include "mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Where a vertical line passes through a surface.
struct Crossing {
    double height;  ///< m
    int turn;       ///< +1: going up, the line enters (the surface faces down); -1: it leaves
};

/// Sums of turns along the vertical line through a point.
struct LineWinding {
    int below = 0;  ///< over crossings strictly below the point
    int upTo = 0;   ///< over those below it and at its height
    int total = 0;  ///< over the whole line; 0 wherever the mesh is closed
};

/// Finds the triangles of a mesh that vertical lines pass through, exactly: x and y of corners and
/// of lines are rounded to one fine lattice, where the test needs integers only. A line that
/// touches an edge or a corner counts as if it stood a hair towards +x, and a far smaller hair
/// towards -y: so the triangles around it are crossed once together, none twice and none missed.
class CrossingGrid {
public:
    explicit CrossingGrid(const TriangleMesh& mesh);

    const Eigen::AlignedBox3d& bounds() const { return bounds_; }
    double latticeSpacing() const { return spacing_; }  ///< m, a power of two

    /// True if the edges of the mesh, seen from above, cancel: then every line has as many
    /// crossings that enter as crossings that leave.
    bool isClosed() const { return closed_; }

    /// All crossings of the line (x, y), in no order; replaces `out`.
    void crossingsAt(double x, double y, std::vector<Crossing>& out) const;
    LineWinding windingAt(const Vec3& p) const;
    /// Heights between which all crossings of the line (x, y) lie, found by one look-up; lo > hi if
    /// there are none.
    SolidInterval heightRangeAt(double x, double y) const;

private:
    static constexpr SolidInterval kNoHeights = {1e300, -1e300};

    /// What lies over a square of lattice points.
    struct Bucket {
        std::size_t first = 0;              ///< of its entries; the next bucket's come after them
        SolidInterval heights = kNoHeights; ///< of the corners of its triangles
    };
    /// A lattice point, relative to the first corner of the bounds.
    struct Node {
        std::int32_t x, y;
    };
    /// Counter-clockwise seen from above, whatever the mesh says; `turn` keeps what it said.
    struct Triangle {
        Node a, b, c;
        std::int32_t turn;
        double za, zb, zc;  ///< m
    };

    void chooseLattice();
    Node nodeAt(double x, double y) const;
    void addTriangles(const TriangleMesh& mesh);
    void fillBuckets();
    template <class Visit>
    void forBucketsOf(const Triangle& triangle, const Visit& visit) const;
    bool hasTooManyEntries() const;
    bool isOver(double x, double y) const;
    std::size_t bucketAt(const Node& line) const;
    template <class Visit>
    void forCrossedTriangles(const Node& line, std::size_t bucket, const Visit& visit) const;
    static double heightOf(const Triangle& triangle, std::int64_t ofA, std::int64_t ofB,
                           std::int64_t ofC);

    Eigen::AlignedBox3d bounds_;
    double spacing_ = 1.0;                 ///< m, between lattice points
    double perMetre_ = 1.0;                ///< 1 / spacing, exact
    std::int64_t originX_ = 0;             ///< lattice points from the axes to bounds_
    std::int64_t originY_ = 0;
    bool closed_ = true;
    std::vector<Triangle> triangles_;      ///< those that are not seen edge-on from above

    int bucketShift_ = 0;                  ///< a bucket is 2^shift lattice points wide
    std::int32_t bucketsX_ = 1;
    std::int32_t bucketsY_ = 1;
    std::vector<Bucket> buckets_;          ///< x fastest; one more at the end
    std::vector<std::uint32_t> entries_;   ///< triangles, bucket by bucket
};

}  // namespace sandflow
