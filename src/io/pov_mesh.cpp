#include "io/pov_mesh.h"

#include "core/errors.h"
#include "io/pov_decimal.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace sandflow {
namespace {

/// A tenth of a thousandth of a grain: no shading can tell it from the exact place.
constexpr int kLengthDecimals = 4;
/// Mirrored light shows steps of a hundredth.
constexpr int kNormalDecimals = 3;
/// "<,,>,\n" and three numbers.
constexpr std::size_t kLongestRow = 6 + 3 * kLongestDecimal;
/// Around a point with more triangles, as a fan's hub, comparing each with each takes too long.
constexpr std::size_t kManyTriangles = 200;

struct Facet {
    Vec3 normal;    ///< unit
    Vec3 weighted;  ///< normal times twice the area
};

/// The corners of the triangles, sorted by the point they meet in: those of point p are
/// corner[first[p]] to corner[first[p + 1] - 1]; corner 3 t + k is the k-th of triangle t.
struct CornersByPoint {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> corner;
};

CornersByPoint sortCorners(const TriangleMesh& mesh)
{
    CornersByPoint sorted;
    sorted.first.assign(mesh.points.size() + 1, 0);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t point : triangle) {
            ++sorted.first[point + 1];
        }
    }
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        sorted.first[p + 1] += sorted.first[p];
    }
    sorted.corner.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            sorted.corner[next[mesh.triangles[t][k]]++] = static_cast<std::uint32_t>(3 * t + k);
        }
    }
    return sorted;
}

/// The mesh without its triangles of no area; facets gets one entry for each that stays.
TriangleMesh dropEmptyTriangles(const TriangleMesh& mesh, std::vector<Facet>& facets)
{
    TriangleMesh kept;
    kept.points = mesh.points;
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t point : triangle) {
            SAND_CHECK(point < mesh.points.size(), "a triangle has corner {} of {} points", point,
                       mesh.points.size());
        }
        const Vec3& a = mesh.points[triangle[0]];
        const Vec3 weighted =
            (mesh.points[triangle[1]] - a).cross(mesh.points[triangle[2]] - a);
        const double length = weighted.norm();
        SAND_CHECK(std::isfinite(length), "a triangle of a mesh has area {}", length);
        const Vec3 normal = weighted / length;
        // What underflows has no direction either.
        if (length > 0.0 && std::abs(normal.squaredNorm() - 1.0) < 1e-6) {
            kept.triangles.push_back(triangle);
            facets.push_back({normal, weighted});
        }
    }
    return kept;
}

/// The normals at one point, one for each of its corners.
void findCornerNormals(std::span<const std::uint32_t> corners, const std::vector<Facet>& facets,
                       double leastCosine, std::vector<Vec3>& normals)
{
    normals.clear();
    if (corners.size() > kManyTriangles) {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t corner : corners) {
            sum += facets[corner / 3].weighted;
        }
        const Vec3 mean = sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
        for (const std::uint32_t corner : corners) {
            const Vec3& own = facets[corner / 3].normal;
            normals.push_back(own.dot(mean) >= leastCosine ? mean : own);
        }
        return;
    }
    for (const std::uint32_t corner : corners) {
        const Vec3& own = facets[corner / 3].normal;
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t other : corners) {
            if (own.dot(facets[other / 3].normal) >= leastCosine) {
                sum += facets[other / 3].weighted;
            }
        }
        // Of normals within 50 degrees of the own one; they do not cancel.
        normals.push_back(sum.normalized());
    }
}

/// "<x,z,y>," of a vector in the simulator's axes.
template <int Decimals>
char* putVector(char* out, const Vec3& vector)
{
    *out++ = '<';
    out = putDecimal<Decimals>(out, vector.x());
    *out++ = ',';
    out = putDecimal<Decimals>(out, vector.z());
    *out++ = ',';
    out = putDecimal<Decimals>(out, vector.y());
    *out++ = '>';
    return out;
}

/// Appends "KEYWORD{COUNT,\n<..>,\n<..>}\n"; `putRow(out, i)` writes a "<..>", returns its end.
template <class PutRow>
void appendList(std::string& text, std::string_view keyword, std::size_t count, PutRow putRow)
{
    text += fmt::format("{}{{{}", keyword, count);
    std::size_t used = text.size();
    text.resize(used + count * kLongestRow);
    char* out = text.data() + used;
    for (std::size_t i = 0; i < count; ++i) {
        out = putRow(putLiteral(out, ",\n"), i);
    }
    text.resize(static_cast<std::size_t>(out - text.data()));
    text += "}\n";
}

}  // namespace

ShadedMesh shadeMesh(const TriangleMesh& mesh, double creaseAngle)
{
    const double leastCosine = std::cos(creaseAngle * kPi / 180.0);
    std::vector<Facet> facets;
    facets.reserve(mesh.triangles.size());
    const TriangleMesh kept = dropEmptyTriangles(mesh, facets);
    const CornersByPoint sorted = sortCorners(kept);

    ShadedMesh shaded;
    shaded.points.reserve(kept.points.size());
    shaded.normals.reserve(kept.points.size());
    shaded.triangles.resize(kept.triangles.size());
    std::vector<Vec3> normals;
    for (std::size_t p = 0; p < kept.points.size(); ++p) {
        const std::span<const std::uint32_t> corners(sorted.corner.data() + sorted.first[p],
                                                     sorted.first[p + 1] - sorted.first[p]);
        findCornerNormals(corners, facets, leastCosine, normals);
        // Corners that sum the same triangles have the same bits and share a point.
        const std::size_t begin = shaded.points.size();
        for (std::size_t c = 0; c < corners.size(); ++c) {
            std::size_t at = std::max(begin, shaded.points.size() - std::min(
                                                 shaded.points.size(), kManyTriangles));
            while (at < shaded.points.size() && shaded.normals[at] != normals[c]) {
                ++at;
            }
            if (at == shaded.points.size()) {
                shaded.points.push_back(kept.points[p]);
                shaded.normals.push_back(normals[c]);
            }
            shaded.triangles[corners[c] / 3][corners[c] % 3] = static_cast<std::uint32_t>(at);
        }
    }
    return shaded;
}

std::string formatPovMesh(std::string_view name, const TriangleMesh& mesh, double unit)
{
    const ShadedMesh shaded = shadeMesh(mesh);
    SAND_CHECK(!shaded.triangles.empty(), "mesh {} has no triangle with an area", name);
    for (const Vec3& point : shaded.points) {
        for (const double coordinate : point) {
            SAND_CHECK(isDrawable(coordinate / unit), "mesh {} has a coordinate of {} m", name,
                       coordinate);
        }
    }
    std::string text = fmt::format("// {} triangles, lengths in mean grain radii\n"
                                   "#declare {} = mesh2{{\n",
                                   shaded.triangles.size(), name);
    appendList(text, "vertex_vectors", shaded.points.size(), [&](char* out, std::size_t i) {
        return putVector<kLengthDecimals>(out, shaded.points[i] / unit);
    });
    appendList(text, "normal_vectors", shaded.normals.size(), [&](char* out, std::size_t i) {
        return putVector<kNormalDecimals>(out, shaded.normals[i]);
    });
    appendList(text, "face_indices", shaded.triangles.size(), [&](char* out, std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            *out++ = k == 0 ? '<' : ',';
            out = std::to_chars(out, out + 10, shaded.triangles[i][k]).ptr;
        }
        *out++ = '>';
        return out;
    });
    return text + "}\n";
}

}  // namespace sandflow
