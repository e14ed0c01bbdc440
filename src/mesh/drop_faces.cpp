#include "mesh/drop_faces.h"

#include "core/hash.h"
#include "mesh/mesh_orientation.h"
#include "mesh/mesh_topology.h"

#include <algorithm>
#include <cstdlib>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sandflow {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Removes the marked triangles.
std::size_t dropMarked(const std::vector<char>& marked, TriangleMesh& mesh)
{
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (marked[t] == 0) {
            mesh.triangles[kept++] = mesh.triangles[t];
        }
    }
    const std::size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    return dropped;
}

/// The same triangle, beginning with its lowest corner.
Triangle rotated(const Triangle& t)
{
    const auto lowest = std::min_element(t.begin(), t.end());
    Triangle result = t;
    std::rotate(result.begin(), result.begin() + (lowest - t.begin()), result.end());
    return result;
}

Triangle reversed(const Triangle& t)
{
    return {t[0], t[2], t[1]};
}

/// Triangles in an order that puts equal ones next to each other, the earlier first.
std::vector<std::pair<Triangle, std::size_t>> sortTriangles(const TriangleMesh& mesh)
{
    std::vector<std::pair<Triangle, std::size_t>> sorted;
    sorted.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        sorted.emplace_back(rotated(mesh.triangles[t]), t);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

/// How often some edges are passed one way more than the other.
class EdgeBalance {
public:
    /// The edges of these triangles are looked at, and no others.
    EdgeBalance(const TriangleMesh& mesh, const std::vector<std::size_t>& watched)
    {
        for (const std::size_t t : watched) {
            const Triangle& triangle = mesh.triangles[t];
            for (std::size_t k = 0; k < 3; ++k) {
                balance_[keyOf(triangle[k], triangle[(k + 1) % 3])] = 0;
            }
        }
    }

    /// How far the three edges of a triangle are from balance in all.
    int imbalance(const Triangle& t) const
    {
        int sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            sum += std::abs(balance_.at(keyOf(t[k], t[(k + 1) % 3])));
        }
        return sum;
    }

    void add(const Triangle& t, int times)
    {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            const auto found = balance_.find(keyOf(a, b));
            if (found != balance_.end()) {
                found->second += a < b ? times : -times;
            }
        }
    }

private:
    struct MixKey {
        std::size_t operator()(std::uint64_t key) const { return mixBits(key); }
    };

    static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b)
    {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    }

    std::unordered_map<std::uint64_t, int, MixKey> balance_;
};

/// Unmarks triangles that bring edges of the rest into balance: without them the surface would be
/// open. Decimated scans have faces twice on purpose, in folds that are as thin as a face.
void unmarkNeeded(const TriangleMesh& mesh, std::vector<char>& marked)
{
    std::vector<std::size_t> left;
    for (std::size_t t = 0; t < marked.size(); ++t) {
        if (marked[t] != 0) {
            left.push_back(t);
        }
    }
    if (left.empty()) {
        return;
    }
    EdgeBalance balance(mesh, left);
    for (std::size_t t = 0; t < marked.size(); ++t) {
        if (marked[t] == 0) {
            balance.add(mesh.triangles[t], 1);
        }
    }
    // One may make room for the next; chains of more than a few are not looked for.
    constexpr int kMaxRounds = 16;
    bool changed = true;
    for (int round = 0; changed && round < kMaxRounds; ++round) {
        const std::size_t before = left.size();
        std::erase_if(left, [&](std::size_t t) {
            const Triangle& triangle = mesh.triangles[t];
            const int imbalance = balance.imbalance(triangle);
            balance.add(triangle, 1);
            const bool needed = balance.imbalance(triangle) < imbalance;
            if (needed) {
                marked[t] = 0;
            } else {
                balance.add(triangle, -1);
            }
            return needed;
        });
        changed = left.size() < before;
    }
}

bool isFlat(const TriangleMesh& mesh, const Triangle& t, double tolerance)
{
    const Vec3 ab = mesh.points[t[1]] - mesh.points[t[0]];
    const Vec3 ac = mesh.points[t[2]] - mesh.points[t[0]];
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    return ab.cross(ac).norm() <= tolerance * longest;
}

}  // namespace

std::size_t dropCollapsed(TriangleMesh& mesh)
{
    return std::erase_if(mesh.triangles, [](const Triangle& t) {
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    });
}

std::size_t dropRepeated(TriangleMesh& mesh)
{
    const auto sorted = sortTriangles(mesh);
    std::vector<char> marked(mesh.triangles.size(), 0);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        marked[sorted[i].second] = sorted[i].first == sorted[i - 1].first ? 1 : 0;
    }
    unmarkNeeded(mesh, marked);
    return dropMarked(marked, mesh);
}

std::size_t dropFlat(double tolerance, TriangleMesh& mesh)
{
    std::vector<char> marked(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        marked[t] = isFlat(mesh, mesh.triangles[t], tolerance) ? 1 : 0;
    }
    unmarkNeeded(mesh, marked);
    return dropMarked(marked, mesh);
}

std::size_t dropBackFaces(TriangleMesh& mesh)
{
    const auto sorted = sortTriangles(mesh);
    std::vector<char> marked(mesh.triangles.size(), 0);
    for (const auto& [triangle, t] : sorted) {
        const auto wanted = std::pair(rotated(reversed(triangle)), std::size_t{0});
        const auto twin = std::lower_bound(sorted.begin(), sorted.end(), wanted);
        if (twin == sorted.end() || twin->first != wanted.first) {
            return 0;
        }
        marked[t] = twin->second < t ? 1 : 0;
    }
    TriangleMesh single = mesh;
    const std::size_t dropped = dropMarked(marked, single);
    alignNeighbours(single);
    const MeshEdges edges = findEdges(single);
    const bool fits = std::all_of(edges.edges.begin(), edges.edges.end(),
                                  [](const MeshEdge& e) { return e.forward == e.backward; });
    if (!fits) {
        return 0;
    }
    mesh.triangles = std::move(single.triangles);
    return dropped;
}

}  // namespace sandflow
