#include "mesh/sample_surface.h"

#include "core/errors.h"
#include "core/hash.h"
#include "mesh/flat_piece.h"
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

/// Diameter, in gaps, of a piece that is given up as uncovered and gets a sample of its own, which
/// is less than that from its corners: so it covers the piece, and the others are farther than 0.85
/// gap from it. Smaller would look longer for the places that need a sample.
constexpr double kSmallestPiece = 0.15;

/// Darts are thrown in batches, in the order of the triangles and only shuffled within: what is
/// near in space is near in time, which for large meshes takes about half the time of all at
/// random. About 4,000 samples each, so that borders between batches are few.
constexpr std::uint64_t kBatch = 1 << 16;

/// The certificate works with a slightly smaller gap, so that rounding can never break it.
constexpr double kRoundingMargin = 1e-6;

/// Where coordinates have 1e-8 gap left: cutting a triangle 50 times then stays within the margin.
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
    void tryDart(const SurfacePlace& place);
    void certifyTriangle(const std::array<std::uint32_t, 3>& triangle);
    bool isCovered(const FlatPiece& piece, const Vec3& normal, double leastCosine);
    bool coversAlone(std::uint32_t sample, const FlatPiece& piece, const Vec3& normal,
                     double leastCosine) const;
    void add(const Vec3& point, const Vec3& normal);

    const TriangleMesh& mesh_;
    double gap2_;        ///< m2
    double certified2_;  ///< m2, a little less
    double smallest2_;   ///< m2
    SampleGrid samples_;
    std::vector<FlatPiece> pieces_;  ///< of one triangle, still to be covered, the next one last
    std::uint32_t lastCover_ = 0;    ///< the sample that covered the last piece
};

void SurfaceCover::throwDarts(std::uint64_t seed)
{
    const double area = areaOf(mesh_);
    if (area == 0.0) {
        return;
    }
    const auto tries = static_cast<std::uint64_t>(std::ceil(kTriesPerSquareGap * (area / gap2_)));
    const SurfacePlaces places(mesh_, tries, seed);
    for (std::uint64_t first = 0; first < tries; first += kBatch) {
        const std::uint64_t count = std::min(kBatch, tries - first);
        const ScatteredOrder order(count, extendHash(seed, first));
        for (std::uint64_t k = 0; k < count; ++k) {
            tryDart(places.at(first + order.at(k)));
        }
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

/// A ball is convex: it covers a piece if it holds the corners. A piece that no ball covers is
/// halved across its longer side.
void SurfaceCover::certifyTriangle(const std::array<std::uint32_t, 3>& triangle)
{
    const Vec3& a = mesh_.points[triangle[0]];
    const Vec3& b = mesh_.points[triangle[1]];
    const Vec3& c = mesh_.points[triangle[2]];
    const Vec3 normal = normalOf(a, b, c);
    const bool isFlat = normal.squaredNorm() > 0.5;
    const double leastCosine = isFlat ? kSimilarCosine : kAnyCosine;

    const FlatPiece whole(a, b, c);
    if (isCovered(whole, normal, leastCosine)) {
        return;  // as most small triangles are: what follows is not for them
    }
    const auto [along, across] = sidesOf(a, b, c);
    pieces_.assign(1, whole);
    while (!pieces_.empty()) {
        const FlatPiece piece = pieces_.back();
        pieces_.pop_back();
        if (isCovered(piece, normal, leastCosine)) {
            continue;
        }
        const Extent length = piece.extentAlong(along);
        const Extent width = piece.extentAlong(across);
        if (length.size() * length.size() + width.size() * width.size() < smallest2_) {
            add(piece.middle(), isFlat ? normal : Vec3(Vec3::UnitZ()));
            continue;
        }
        const bool isLong = length.size() >= width.size();
        const auto [lower, upper] =
            isLong ? piece.cutAt(along, length.middle()) : piece.cutAt(across, width.middle());
        pieces_.push_back(upper);
        pieces_.push_back(lower);
    }
}

bool SurfaceCover::isCovered(const FlatPiece& piece, const Vec3& normal, double leastCosine)
{
    // Neighbouring pieces mostly share a ball: for triangles much smaller than the gap this is all.
    if (lastCover_ < samples_.size() && coversAlone(lastCover_, piece, normal, leastCosine)) {
        return true;
    }
    if ((piece.corner(1) - piece.corner(0)).squaredNorm() > 4.0 * gap2_) {
        return false;  // longer than any ball is wide
    }
    const std::uint32_t found = samples_.findNear(piece.corner(0), [&](std::uint32_t s) {
        return coversAlone(s, piece, normal, leastCosine);
    });
    if (found == SampleGrid::kNone) {
        return false;
    }
    lastCover_ = found;
    return true;
}

bool SurfaceCover::coversAlone(std::uint32_t sample, const FlatPiece& piece, const Vec3& normal,
                               double leastCosine) const
{
    return piece.isWithin(certified2_, samples_.points[sample]) &&
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
