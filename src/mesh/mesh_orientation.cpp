#include "mesh/mesh_orientation.h"

#include "mesh/mesh_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace sandflow {
namespace {

void turn(std::array<std::uint32_t, 3>& triangle)
{
    std::swap(triangle[1], triangle[2]);
}

struct Neighbour {
    std::uint32_t triangle;
    bool sameWay;  ///< both run along the edge the same way: one of them faces wrongly
};

/// Across edges with exactly two sides.
std::vector<std::array<Neighbour, 3>> findNeighbours(const TriangleMesh& mesh,
                                                     const MeshEdges& edges,
                                                     std::vector<int>& counts)
{
    std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
    counts.assign(mesh.triangles.size(), 0);
    for (const MeshEdge& edge : edges.edges) {
        if (edge.sides() == 2) {
            const std::uint32_t a = edges.sides[edge.firstSide];
            const std::uint32_t b = edges.sides[edge.firstSide + 1];
            const bool sameWay = edge.forward != 1;
            neighbours[a][static_cast<std::size_t>(counts[a]++)] = {b, sameWay};
            neighbours[b][static_cast<std::size_t>(counts[b]++)] = {a, sameWay};
        }
    }
    return neighbours;
}

/// A component as an object of its own.
struct Part {
    std::vector<std::uint32_t> triangles;
    Eigen::AlignedBox3d box;
    double volume = 0.0;
    bool closed = true;
    bool turned = false;
};

std::vector<Part> splitParts(const TriangleMesh& mesh)
{
    const MeshComponents components = findComponents(mesh);
    const std::vector<double> holes = findHoles(mesh, findEdges(mesh), components);
    std::vector<Part> parts(components.count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Part& part = parts[components.ofTriangle[t]];
        part.triangles.push_back(t);
        for (const std::uint32_t corner : mesh.triangles[t]) {
            part.box.extend(mesh.points[corner]);
        }
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        Part& part = parts[p];
        constexpr double kWidestHole = 0.25;
        part.closed = holes[p] <= kWidestHole * part.box.diagonal().norm();
        const Vec3 middle = part.box.center();
        for (const std::uint32_t t : part.triangles) {
            const auto& [a, b, c] = mesh.triangles[t];
            part.volume += (mesh.points[a] - middle)
                               .dot((mesh.points[b] - middle).cross(mesh.points[c] - middle)) /
                           6.0;
        }
    }
    return parts;
}

/// How often a part goes round p: the solid angle of its triangles (Van Oosterom and Strackee 1983,
/// eq. 8) over that of the whole sphere. About 0 outside, +-1 inside a closed part.
double windingNumber(const TriangleMesh& mesh, const Part& part, const Vec3& p)
{
    double angle = 0.0;
    for (const std::uint32_t t : part.triangles) {
        const Vec3 a = mesh.points[mesh.triangles[t][0]] - p;
        const Vec3 b = mesh.points[mesh.triangles[t][1]] - p;
        const Vec3 c = mesh.points[mesh.triangles[t][2]] - p;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return angle / (4.0 * kPi);
}

/// Finds out which parts lie in which, as long as that does not take more than about a second:
/// files with many thousands of nested parts are not worth minutes.
class Nesting {
public:
    Nesting(const TriangleMesh& mesh, const std::vector<Part>& parts) : mesh_(mesh), parts_(parts)
    {
    }

    /// Judging by a single corner of the inner part is right unless the two cut each other. False
    /// when there is no time left.
    bool contains(std::size_t outer, std::size_t inner)
    {
        const Part& around = parts_[outer];
        work_ += 1;
        if (outer == inner || !around.closed || exhausted() ||
            !around.box.contains(parts_[inner].box)) {
            return false;
        }
        constexpr std::size_t kWorkPerTriangle = 20;
        work_ += kWorkPerTriangle * around.triangles.size();
        const Vec3& corner = mesh_.points[mesh_.triangles[parts_[inner].triangles[0]][0]];
        return !exhausted() && std::abs(windingNumber(mesh_, around, corner)) > 0.5;
    }

    bool exhausted() const { return work_ > kMaxWork; }

private:
    static constexpr std::size_t kMaxWork = 200'000'000;  ///< comparisons of boxes

    const TriangleMesh& mesh_;
    const std::vector<Part>& parts_;
    std::size_t work_ = 0;
};

}  // namespace

std::size_t alignNeighbours(TriangleMesh& mesh)
{
    std::vector<int> counts;
    const std::vector<std::array<Neighbour, 3>> neighbours =
        findNeighbours(mesh, findEdges(mesh), counts);
    std::vector<char> side(mesh.triangles.size(), 0);  // +1 and -1 face opposite ways
    std::size_t turned = 0;
    std::vector<std::uint32_t> patch;
    for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (side[seed] != 0) {
            continue;
        }
        patch.assign(1, seed);
        side[seed] = 1;
        bool consistent = true;
        std::size_t minus = 0;
        for (std::size_t at = 0; at < patch.size(); ++at) {
            const std::uint32_t t = patch[at];
            minus += side[t] < 0 ? 1 : 0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(counts[t]); ++k) {
                const Neighbour& next = neighbours[t][k];
                const char wanted =
                    static_cast<char>(next.sameWay ? -side[t] : static_cast<int>(side[t]));
                if (side[next.triangle] == 0) {
                    side[next.triangle] = wanted;
                    patch.push_back(next.triangle);
                }
                consistent = consistent && side[next.triangle] == wanted;
            }
        }
        if (!consistent || minus == 0) {
            continue;
        }
        const char lesser = 2 * minus <= patch.size() ? -1 : 1;
        for (const std::uint32_t t : patch) {
            if (side[t] == lesser) {
                turn(mesh.triangles[t]);
                ++turned;
            }
        }
    }
    return turned;
}

TurnedParts turnInsideOut(TriangleMesh& mesh)
{
    std::vector<Part> parts = splitParts(mesh);
    // Volumes below this are rounding: a flat flake has no inside.
    constexpr double kLeastVolume = 1e-9;
    const auto isInsideOut = [](const Part& part) {
        const double diagonal = part.box.diagonal().norm();
        return part.closed && part.volume < -kLeastVolume * diagonal * diagonal * diagonal;
    };
    Nesting nesting(mesh, parts);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        // One inside another is a cavity, unless that one is turned, and it with it.
        bool outermost = isInsideOut(parts[p]);
        for (std::size_t q = 0; q < parts.size() && outermost; ++q) {
            outermost = !nesting.contains(q, p);
        }
        if (!outermost || nesting.exhausted()) {
            continue;
        }
        parts[p].turned = true;
        for (std::size_t q = 0; q < parts.size(); ++q) {
            parts[q].turned = parts[q].turned || nesting.contains(p, q);
        }
    }
    TurnedParts result;
    result.complete = !nesting.exhausted();
    for (const Part& part : parts) {
        if (part.turned && result.complete) {
            for (const std::uint32_t t : part.triangles) {
                turn(mesh.triangles[t]);
            }
            ++result.turned;
        }
    }
    return result;
}

}  // namespace sandflow
