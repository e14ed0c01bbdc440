#include "mesh/sample_surface.h"

#include "core/errors.h"
#include "mesh/sample_grid.h"
#include "mesh/scattered_order.h"
#include "mesh/surface_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sandflow {
namespace {

/// Places tried per gap^2 of area. More saturate the surface better and leave less to the
/// certificate, whose samples are less even; the time grows with it.
constexpr double kTriesPerSquareGap = 12.0;

/// Samples per gap^2 of area that come of it, from measurements on smooth meshes.
constexpr double kUsualDensity = 0.74;

/// Cosine between normals that count as similar: 60 degrees. Less would let one face of a sharp
/// edge do for the other, more would crowd strongly curved parts with samples.
constexpr double kSimilarCosine = 0.5;

/// Below the cosine of any two unit vectors, and of a missing normal.
constexpr double kAnyCosine = -2.0;

/// Longest edge, in gaps, of a piece that is given up as uncovered. Its corners are within 2/3 of
/// that from its centroid: so the new sample covers it, and is 0.9 gap or more from the others.
constexpr double kSmallestPiece = 0.15;

/// The certificate works with a slightly smaller gap, so that rounding can never break it.
constexpr double kRoundingMargin = 1e-6;

/// Where coordinates have 1e-8 gap left: halving a triangle 50 times then stays within the margin.
constexpr double kFarthestInGaps = 1e8;

constexpr double kWidestInGaps = 2e6;  ///< what a SampleGrid can tell apart, 2^21

/// Unit normal, or zero for a triangle without area.
Vec3 normalOf(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 doubleArea = (b - a).cross(c - a);
    const double length = doubleArea.norm();
    return length > 0.0 ? Vec3(doubleArea / length) : Vec3(Vec3::Zero());
}

double longestEdgeOf(const TriangleMesh& mesh)
{
    double longest2 = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        longest2 = std::max({longest2, (mesh.points[a] - mesh.points[b]).squaredNorm(),
                             (mesh.points[b] - mesh.points[c]).squaredNorm(),
                             (mesh.points[c] - mesh.points[a]).squaredNorm()});
    }
    return std::sqrt(longest2);
}

/// Conditions are written so that what is not a number is refused too.
void refuseWhatIsTooMuch(const TriangleMesh& mesh, double gap)
{
    const Eigen::AlignedBox3d box = boundsOf(mesh);
    const double farthest =
        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    if (!(farthest <= kFarthestInGaps * gap)) {
        throw InputError(fmt::format(
            "A mesh that reaches {} m from the origin cannot be covered with particles {} m apart; "
            "move it closer, to within {} m.",
            farthest, gap, kFarthestInGaps * gap));
    }
    const double width = box.sizes().maxCoeff();
    if (!(width <= kWidestInGaps * gap)) {
        throw InputError(fmt::format(
            "A mesh {} m wide cannot be covered with particles {} m apart, only one of up to {} m; "
            "make it smaller or the grains larger.",
            width, gap, kWidestInGaps * gap));
    }
    // A line of that length needs one sample every two gaps at least.
    const double area = areaOf(mesh);
    const double needed =
        std::max(kUsualDensity * area / (gap * gap), longestEdgeOf(mesh) / (2.0 * gap));
    if (!(needed <= static_cast<double>(kMostSurfaceSamples))) {
        throw InputError(
            fmt::format("A mesh of {:.4g} m2 takes about {:.2g} particles to cover at {:.4g} m "
                        "apart, more than "
                        "the {} allowed; make it smaller or the grains larger.",
                        area, needed, gap, kMostSurfaceSamples));
    }
}

/// The samples while they are being made.
class SurfaceCover {
public:
    SurfaceCover(const TriangleMesh& mesh, double gap)
        : mesh_(mesh),
          gap2_(gap * gap),
          certified2_(gap2_ * (1.0 - 2.0 * kRoundingMargin)),
          smallest2_(gap2_ * kSmallestPiece * kSmallestPiece),
          samples_(boundsOf(mesh).min(), gap)
    {
    }

    void throwDarts(std::uint64_t seed);
    void certify();

    SurfaceSamples take() { return {std::move(samples_.points), std::move(samples_.normals)}; }

private:
    struct Piece {
        Vec3 a;
        Vec3 b;
        Vec3 c;
    };

    void tryDart(const SurfacePlace& place);
    void certifyTriangle(const std::array<std::uint32_t, 3>& triangle);
    bool isCovered(const Piece& piece, const Vec3& normal, double leastCosine);
    bool coversAlone(std::uint32_t sample, const Piece& piece, const Vec3& normal,
                     double leastCosine) const;
    void add(const Vec3& point, const Vec3& normal);

    const TriangleMesh& mesh_;
    double gap2_;        ///< m2
    double certified2_;  ///< m2, a little less
    double smallest2_;   ///< m2
    SampleGrid samples_;
    std::vector<Piece> pieces_;    ///< of one triangle, still to be covered, the next one last
    std::uint32_t lastCover_ = 0;  ///< the sample that covered the last piece
};

void SurfaceCover::throwDarts(std::uint64_t seed)
{
    const double area = areaOf(mesh_);
    if (area == 0.0) {
        return;
    }
    const auto tries = static_cast<std::uint64_t>(std::ceil(kTriesPerSquareGap * (area / gap2_)));
    const SurfacePlaces places(mesh_, tries, seed);
    const ScatteredOrder order(tries, seed);
    for (std::uint64_t k = 0; k < tries; ++k) {
        tryDart(places.at(order.at(k)));
    }
}

void SurfaceCover::tryDart(const SurfacePlace& place)
{
    const auto& [a, b, c] = mesh_.triangles[place.triangle];
    const Vec3 normal = normalOf(mesh_.points[a], mesh_.points[b], mesh_.points[c]);
    const auto isInTheWay = [&](std::uint32_t s) {
        return (samples_.points[s] - place.point).squaredNorm() < gap2_ &&
               samples_.normals[s].dot(normal) > kSimilarCosine;
    };
    if (samples_.findNear(place.point, isInTheWay) == SampleGrid::kNone) {
        add(place.point, normal);
    }
}

void SurfaceCover::certify()
{
    for (const auto& triangle : mesh_.triangles) {
        certifyTriangle(triangle);
    }
}

/// A ball is convex: it covers a piece if it holds the three corners. A piece that no ball covers
/// is halved across its longest edge, which soon makes all edges shorter.
void SurfaceCover::certifyTriangle(const std::array<std::uint32_t, 3>& triangle)
{
    const Piece whole = {mesh_.points[triangle[0]], mesh_.points[triangle[1]],
                         mesh_.points[triangle[2]]};
    const Vec3 normal = normalOf(whole.a, whole.b, whole.c);
    const bool isFlat = normal.squaredNorm() > 0.5;
    const double leastCosine = isFlat ? kSimilarCosine : kAnyCosine;

    pieces_.assign(1, whole);
    while (!pieces_.empty()) {
        Piece piece = pieces_.back();
        pieces_.pop_back();
        if (isCovered(piece, normal, leastCosine)) {
            continue;
        }
        // Turned so that a-b is the longest edge.
        double ab2 = (piece.b - piece.a).squaredNorm();
        const double bc2 = (piece.c - piece.b).squaredNorm();
        const double ca2 = (piece.a - piece.c).squaredNorm();
        if (bc2 > ab2 && bc2 >= ca2) {
            piece = {piece.b, piece.c, piece.a};
            ab2 = bc2;
        } else if (ca2 > ab2) {
            piece = {piece.c, piece.a, piece.b};
            ab2 = ca2;
        }
        if (ab2 < smallest2_) {
            add((piece.a + piece.b + piece.c) / 3.0, isFlat ? normal : Vec3(Vec3::UnitZ()));
            continue;
        }
        const Vec3 middle = 0.5 * (piece.a + piece.b);
        pieces_.push_back({middle, piece.b, piece.c});
        pieces_.push_back({piece.a, middle, piece.c});
    }
}

bool SurfaceCover::isCovered(const Piece& piece, const Vec3& normal, double leastCosine)
{
    // Neighbouring pieces mostly share a ball: for triangles much smaller than the gap this is all.
    if (lastCover_ < samples_.size() && coversAlone(lastCover_, piece, normal, leastCosine)) {
        return true;
    }
    if ((piece.b - piece.a).squaredNorm() > 4.0 * gap2_) {
        return false;  // longer than any ball is wide
    }
    const std::uint32_t found = samples_.findNear(
        piece.a, [&](std::uint32_t s) { return coversAlone(s, piece, normal, leastCosine); });
    if (found == SampleGrid::kNone) {
        return false;
    }
    lastCover_ = found;
    return true;
}

bool SurfaceCover::coversAlone(std::uint32_t sample, const Piece& piece, const Vec3& normal,
                               double leastCosine) const
{
    const Vec3& centre = samples_.points[sample];
    return (piece.a - centre).squaredNorm() <= certified2_ &&
           (piece.b - centre).squaredNorm() <= certified2_ &&
           (piece.c - centre).squaredNorm() <= certified2_ &&
           samples_.normals[sample].dot(normal) > leastCosine;
}

void SurfaceCover::add(const Vec3& point, const Vec3& normal)
{
    if (samples_.size() == kMostSurfaceSamples) {
        throw InputError(fmt::format(
            "A mesh of {:.4g} m2 takes more than the {} particles allowed to cover at {:.4g} m "
            "apart; make it smaller or the grains larger.",
            areaOf(mesh_), kMostSurfaceSamples, std::sqrt(gap2_)));
    }
    samples_.add(point, normal);
}

}  // namespace

SurfaceSamples sampleSurface(const TriangleMesh& mesh, double gap, std::uint64_t seed)
{
    SAND_CHECK(gap > 0.0 && std::isfinite(gap), "gap = {} m", gap);
    if (mesh.triangles.empty()) {
        return {};
    }
    refuseWhatIsTooMuch(mesh, gap);
    SurfaceCover cover(mesh, gap);
    cover.throwDarts(seed);
    cover.certify();
    return cover.take();
}

}  // namespace sandflow
