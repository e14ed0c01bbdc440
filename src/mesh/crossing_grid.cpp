#include "mesh/crossing_grid.h"

#include "core/errors.h"
#include "core/hash.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandflow {

namespace {

/// Lattice points across the wider side of the mesh: 2^30. Differences of coordinates then have 31
/// bits, edge functions 62: exact in 64. A mesh of a metre gets a lattice of a nanometre.
constexpr int kLatticeBits = 30;
/// Of a double; a lattice finer than the coordinates themselves would be of no use.
constexpr int kMantissaBits = 53;

/// Of the spacing: keeps its inverse finite. Exponents of 0, for a mesh without width, are above.
constexpr int kFinestExponent = -1000;

/// Triangles are a few buckets wide at most where they are alike in size. Fewer buckets make lines
/// slower, more of them cost memory.
constexpr std::size_t kTrianglesPerBucket = 1;
/// Buckets are made wider until triangles are in no more than this many on average: a fan of long
/// needles would take memory without end.
constexpr std::size_t kMostEntriesPerTriangle = 24;

void checkCorners(const TriangleMesh& mesh)
{
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            SAND_CHECK(corner < mesh.points.size(), "a triangle names point {} of {}", corner,
                       mesh.points.size());
            SAND_CHECK(mesh.points[corner].allFinite(), "point {} of the mesh is nowhere", corner);
        }
    }
}

int exponentOf(double value)
{
    int exponent = 0;
    std::frexp(value, &exponent);
    return exponent;
}

/// Twice the area of (a, b, p), positive if p is to the left of the way from a to b.
template <class Node>
std::int64_t edgeFunction(const Node& a, const Node& b, const Node& p)
{
    return (std::int64_t{b.x} - a.x) * (std::int64_t{p.y} - a.y) -
           (std::int64_t{b.y} - a.y) * (std::int64_t{p.x} - a.x);
}

/// True if points on the edge from a to b belong to the triangle to the left of it.
template <class Node>
bool ownsItsPoints(const Node& a, const Node& b)
{
    return b.y < a.y || (b.y == a.y && b.x < a.x);
}

/// A number for the edge from a to b that is the negative of that for the edge from b to a.
template <class Node>
std::uint64_t edgeHash(const Node& a, const Node& b)
{
    const auto pack = [](const Node& node) {
        return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(node.x)) << 32) |
               static_cast<std::uint32_t>(node.y);
    };
    const std::uint64_t first = pack(a);
    const std::uint64_t second = pack(b);
    if (first == second) {
        return 0;
    }
    const std::uint64_t hash =
        mixBits(extendHash(mixBits(std::min(first, second)), std::max(first, second)));
    return first < second ? hash : -hash;
}

}  // namespace

CrossingGrid::CrossingGrid(const TriangleMesh& mesh)
{
    checkCorners(mesh);
    bounds_ = boundsOf(mesh);
    if (mesh.triangles.empty()) {
        return;
    }
    chooseLattice();
    addTriangles(mesh);
    fillBuckets();
}

void CrossingGrid::chooseLattice()
{
    const double extent = bounds_.sizes().head<2>().maxCoeff();
    const double farthest =
        std::max(bounds_.min().head<2>().cwiseAbs().maxCoeff(),
                 bounds_.max().head<2>().cwiseAbs().maxCoeff());
    const int exponent = std::max({exponentOf(extent) - kLatticeBits,
                                   exponentOf(farthest) - kMantissaBits, kFinestExponent});
    spacing_ = std::ldexp(1.0, exponent);
    perMetre_ = std::ldexp(1.0, -exponent);
    // The lattice goes through the origin of the axes, not through a corner of the mesh: meshes
    // that touch round their common face alike.
    originX_ = std::llrint(bounds_.min().x() * perMetre_);
    originY_ = std::llrint(bounds_.min().y() * perMetre_);
}

CrossingGrid::Node CrossingGrid::nodeAt(double x, double y) const
{
    return {static_cast<std::int32_t>(std::llrint(x * perMetre_) - originX_),
            static_cast<std::int32_t>(std::llrint(y * perMetre_) - originY_)};
}

void CrossingGrid::addTriangles(const TriangleMesh& mesh)
{
    // Sums of turns depend only on the border of the mesh seen from above. If every edge is walked
    // as often one way as the other, the hashes cancel; if not, they cancel once in 2^64 cases.
    std::uint64_t border = 0;
    triangles_.reserve(mesh.triangles.size());
    for (const auto& corner : mesh.triangles) {
        const Vec3& a = mesh.points[corner[0]];
        const Vec3& b = mesh.points[corner[1]];
        const Vec3& c = mesh.points[corner[2]];
        Triangle triangle{nodeAt(a.x(), a.y()), nodeAt(b.x(), b.y()), nodeAt(c.x(), c.y()), -1,
                          a.z(), b.z(), c.z()};
        border += edgeHash(triangle.a, triangle.b) + edgeHash(triangle.b, triangle.c) +
                  edgeHash(triangle.c, triangle.a);
        const std::int64_t area = edgeFunction(triangle.a, triangle.b, triangle.c);
        if (area < 0) {
            std::swap(triangle.b, triangle.c);
            std::swap(triangle.zb, triangle.zc);
            triangle.turn = 1;
        }
        if (area != 0) {
            triangles_.push_back(triangle);
        }
    }
    closed_ = border == 0;
}

/// Calls visit(bucket) for all buckets that may have points of the triangle, row by row.
template <class Visit>
void CrossingGrid::forBucketsOf(const Triangle& triangle, const Visit& visit) const
{
    const Node corner[3] = {triangle.a, triangle.b, triangle.c};
    const auto [lowest, highest] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    for (std::int32_t row = lowest >> bucketShift_; row <= highest >> bucketShift_; ++row) {
        // The stretch of x that the triangle takes between the heights lo and hi: from and to
        // corners, or places where its edges come in and go out.
        const double lo = std::ldexp(row, bucketShift_);
        const double hi = std::ldexp(row + 1.0, bucketShift_);
        double left = 1e30;
        double right = -1e30;
        for (int k = 0; k < 3; ++k) {
            const double fromX = corner[k].x;
            const double fromY = corner[k].y;
            const double alongX = corner[(k + 1) % 3].x - fromX;
            const double alongY = corner[(k + 1) % 3].y - fromY;
            if (std::max(fromY, fromY + alongY) < lo || std::min(fromY, fromY + alongY) > hi) {
                continue;
            }
            for (const double end : {0.0, 1.0}) {
                const double y = std::clamp(fromY + end * alongY, lo, hi);
                const double x = fromX + alongX * (alongY == 0.0 ? end : (y - fromY) / alongY);
                left = std::min(left, x);
                right = std::max(right, x);
            }
        }
        // One lattice point more on either side: the divisions above are rounded.
        const auto first = std::max(static_cast<std::int32_t>(left) - 1, 0) >> bucketShift_;
        const auto last =
            std::min((static_cast<std::int32_t>(right) + 2) >> bucketShift_, bucketsX_ - 1);
        for (std::int32_t column = first; column <= last; ++column) {
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(bucketsX_) +
                  static_cast<std::size_t>(column));
        }
    }
}

bool CrossingGrid::hasTooManyEntries() const
{
    const std::size_t most = kMostEntriesPerTriangle * triangles_.size();
    std::size_t count = 0;
    for (std::size_t k = 0; k < triangles_.size() && count <= most; ++k) {
        forBucketsOf(triangles_[k], [&](std::size_t) { ++count; });
    }
    return count > most;
}

void CrossingGrid::fillBuckets()
{
    const Node end = nodeAt(bounds_.max().x(), bounds_.max().y());
    const auto layOut = [&](int shift) {
        bucketShift_ = shift;
        bucketsX_ = (end.x >> shift) + 1;
        bucketsY_ = (end.y >> shift) + 1;
        return static_cast<std::size_t>(bucketsX_) * static_cast<std::size_t>(bucketsY_);
    };
    int shift = kLatticeBits + 1;
    while (shift > 0 && layOut(shift - 1) * kTrianglesPerBucket <= triangles_.size()) {
        --shift;
    }
    layOut(shift);
    while (shift <= kLatticeBits && hasTooManyEntries()) {
        layOut(++shift);
    }

    // Counting sort.
    buckets_.assign(static_cast<std::size_t>(bucketsX_) * bucketsY_ + 1, Bucket{});
    for (const Triangle& triangle : triangles_) {
        const auto [lowest, highest] = std::minmax({triangle.za, triangle.zb, triangle.zc});
        forBucketsOf(triangle, [&, lo = lowest, hi = highest](std::size_t bucket) {
            ++buckets_[bucket + 1].first;
            SolidInterval& heights = buckets_[bucket].heights;
            heights = {std::min(heights.lo, lo), std::max(heights.hi, hi)};
        });
    }
    std::vector<std::size_t> next;
    next.reserve(buckets_.size());
    std::size_t sum = 0;
    for (Bucket& bucket : buckets_) {
        sum += bucket.first;
        bucket.first = sum;
        next.push_back(sum);
    }
    entries_.resize(sum);
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
        forBucketsOf(triangles_[k], [&](std::size_t bucket) {
            entries_[next[bucket]++] = static_cast<std::uint32_t>(k);
        });
    }
}

bool CrossingGrid::isOver(double x, double y) const
{
    // Written so that NaN, and a mesh of no triangles, fail too.
    return x >= bounds_.min().x() && x <= bounds_.max().x() && y >= bounds_.min().y() &&
           y <= bounds_.max().y();
}

std::size_t CrossingGrid::bucketAt(const Node& line) const
{
    return static_cast<std::size_t>(line.y >> bucketShift_) * bucketsX_ +
           static_cast<std::size_t>(line.x >> bucketShift_);
}

/// Calls visit(triangle, weights of its corners) for each triangle that the line crosses. The
/// weights are whole numbers and sum to twice the area seen from above.
template <class Visit>
void CrossingGrid::forCrossedTriangles(const Node& line, std::size_t bucket,
                                       const Visit& visit) const
{
    for (std::size_t k = buckets_[bucket].first; k < buckets_[bucket + 1].first; ++k) {
        const Triangle& triangle = triangles_[entries_[k]];
        const std::int64_t ofC = edgeFunction(triangle.a, triangle.b, line);
        const std::int64_t ofA = edgeFunction(triangle.b, triangle.c, line);
        const std::int64_t ofB = edgeFunction(triangle.c, triangle.a, line);
        if ((ofA | ofB | ofC) < 0) {
            continue;
        }
        if ((ofA == 0 && !ownsItsPoints(triangle.b, triangle.c)) ||
            (ofB == 0 && !ownsItsPoints(triangle.c, triangle.a)) ||
            (ofC == 0 && !ownsItsPoints(triangle.a, triangle.b))) {
            continue;
        }
        visit(triangle, ofA, ofB, ofC);
    }
}

double CrossingGrid::heightOf(const Triangle& triangle, std::int64_t ofA, std::int64_t ofB,
                              std::int64_t ofC)
{
    // From one corner, not as a mean of three: then a level triangle has its own height, to the
    // bit. The rounding of the rest must not lead out of the bounds of the mesh.
    const double z = triangle.za + (static_cast<double>(ofB) * (triangle.zb - triangle.za) +
                                    static_cast<double>(ofC) * (triangle.zc - triangle.za)) /
                                       static_cast<double>(ofA + ofB + ofC);
    const auto [lowest, highest] = std::minmax({triangle.za, triangle.zb, triangle.zc});
    return std::clamp(z, lowest, highest);
}

void CrossingGrid::crossingsAt(double x, double y, std::vector<Crossing>& out) const
{
    out.clear();
    if (!isOver(x, y)) {
        return;
    }
    const Node line = nodeAt(x, y);
    forCrossedTriangles(line, bucketAt(line), [&](const Triangle& triangle, std::int64_t ofA,
                                                  std::int64_t ofB, std::int64_t ofC) {
        out.push_back({heightOf(triangle, ofA, ofB, ofC), triangle.turn});
    });
}

LineWinding CrossingGrid::windingAt(const Vec3& p) const
{
    LineWinding winding;
    if (!isOver(p.x(), p.y())) {
        return winding;
    }
    const Node line = nodeAt(p.x(), p.y());
    forCrossedTriangles(line, bucketAt(line), [&](const Triangle& triangle, std::int64_t ofA,
                                                  std::int64_t ofB, std::int64_t ofC) {
        const double z = heightOf(triangle, ofA, ofB, ofC);
        winding.below += z < p.z() ? triangle.turn : 0;
        winding.upTo += z <= p.z() ? triangle.turn : 0;
        winding.total += triangle.turn;
    });
    return winding;
}

SolidInterval CrossingGrid::heightRangeAt(double x, double y) const
{
    return isOver(x, y) ? buckets_[bucketAt(nodeAt(x, y))].heights : kNoHeights;
}

}  // namespace sandflow
