#include "mesh/mesh_topology.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace sandflow {
namespace {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    std::uint32_t find(std::uint32_t i)
    {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }

    /// The lower root stays, so the result does not depend on anything but the sets.
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

struct Side {
    std::uint32_t lo;
    std::uint32_t hi;
    bool backward;
    std::uint32_t triangle;

    auto key() const { return std::tie(hi, backward, triangle); }
};

template <typename Visit>
void forEachSide(const TriangleMesh& mesh, Visit visit)
{
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[t][k];
            const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
            visit(Side{std::min(a, b), std::max(a, b), a > b, static_cast<std::uint32_t>(t)});
        }
    }
}

}  // namespace

MeshEdges findEdges(const TriangleMesh& mesh)
{
    // Sides by their lower point, by counting; then each point's few sides by the rest of their
    // key.
    std::vector<std::size_t> first(mesh.points.size() + 1, 0);
    forEachSide(mesh, [&](const Side& side) { ++first[side.lo + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Side> sides(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    forEachSide(mesh, [&](const Side& side) { sides[next[side.lo]++] = side; });
    for (std::size_t p = 0; p + 1 < first.size(); ++p) {
        std::sort(sides.begin() + static_cast<std::ptrdiff_t>(first[p]),
                  sides.begin() + static_cast<std::ptrdiff_t>(first[p + 1]),
                  [](const Side& a, const Side& b) { return a.key() < b.key(); });
    }
    MeshEdges found;
    found.sides.reserve(sides.size());
    found.edges.reserve(sides.size() / 2);
    for (const Side& side : sides) {
        if (found.edges.empty() || found.edges.back().lo != side.lo ||
            found.edges.back().hi != side.hi) {
            found.edges.push_back({side.lo, side.hi, 0, 0, found.sides.size()});
        }
        ++(side.backward ? found.edges.back().backward : found.edges.back().forward);
        found.sides.push_back(side.triangle);
    }
    return found;
}

MeshComponents findComponents(const TriangleMesh& mesh)
{
    DisjointSets sets(mesh.points.size());
    for (const auto& triangle : mesh.triangles) {
        sets.join(triangle[0], triangle[1]);
        sets.join(triangle[0], triangle[2]);
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> numberOf(mesh.points.size(), kNone);
    MeshComponents components;
    components.ofTriangle.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        std::uint32_t& number = numberOf[sets.find(triangle[0])];
        if (number == kNone) {
            number = components.count++;
        }
        components.ofTriangle.push_back(number);
    }
    return components;
}

std::vector<double> findHoles(const TriangleMesh& mesh, const MeshEdges& edges,
                              const MeshComponents& components)
{
    DisjointSets sets(mesh.points.size());
    for (const MeshEdge& edge : edges.edges) {
        if (edge.sides() == 1) {
            sets.join(edge.lo, edge.hi);
        }
    }
    std::map<std::uint32_t, Eigen::AlignedBox3d> boxes;
    for (const MeshEdge& edge : edges.edges) {
        if (edge.sides() == 1) {
            Eigen::AlignedBox3d& box = boxes[sets.find(edge.lo)];
            box.extend(mesh.points[edge.lo]);
            box.extend(mesh.points[edge.hi]);
        }
    }
    std::vector<double> widest(components.count, 0.0);
    for (const MeshEdge& edge : edges.edges) {
        if (edge.sides() == 1) {
            double& width = widest[components.ofTriangle[edges.sides[edge.firstSide]]];
            width = std::max(width, boxes[sets.find(edge.lo)].diagonal().norm());
        }
    }
    return widest;
}

}  // namespace sandflow
