#include "solids/rough_cover.h"

#include "core/errors.h"
#include "core/hash.h"
#include "solids/axis_frame.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace sandflow {

namespace {

/// rho / a. More hides the lattice better but needs more particles for the same gap, and lets two
/// centres come as close as a - 2 rho; at 1/4 that is half the spacing.
constexpr double kJitterShare = 0.25;

constexpr double kCircumradius = 0.57735026918962573;  ///< 1/sqrt(3): of a triangle of edge 1
constexpr double kRowHeight = 0.86602540378443865;     ///< sqrt(3)/2: of the same triangle

/// Lattice spacings along the edge of a patch: about 74 particles each, a few times the reach of a
/// grain.
constexpr int kPatchEdge = 8;

/// Patch row of lattice row j: the one rule that says which patch a row belongs to.
double patchRowOf(std::int64_t j)
{
    return std::floor(static_cast<double>(j) * (kRowHeight / kPatchEdge));
}

std::int32_t patchIndex(double position, double patchSize)
{
    const double index = std::floor(position / patchSize);
    constexpr double kLimit = std::numeric_limits<std::int32_t>::max();
    // Written so that NaN fails too.
    if (!(std::abs(index) < kLimit)) {
        throw PhysicsError(
            fmt::format("A grain is {} m from the point of a rough plane, too far for its cover; "
                        "set a domain that lets stray grains exit.",
                        position));
    }
    return static_cast<std::int32_t>(index);
}

/// Uniform in the open unit disc, by (seed, i, j) alone. Rejection, not polar coordinates: without
/// sine and cosine the bits are the same on every machine.
Vec2 drawInDisc(std::uint64_t seed, std::int64_t i, std::int64_t j)
{
    std::uint64_t state =
        extendHash(extendHash(seed, static_cast<std::uint64_t>(i)), static_cast<std::uint64_t>(j));
    while (true) {
        const std::uint64_t first = mixBits(state);
        state = extendHash(state, first);
        const Vec2 candidate(2.0 * unitFromBits(first) - 1.0, 2.0 * unitFromBits(state) - 1.0);
        if (candidate.squaredNorm() < 1.0) {
            return candidate;
        }
    }
}

}  // namespace

RoughCover::RoughCover(const Primitive& plane, double gap, std::uint64_t seed)
    : origin_(plane.point),
      u_(makePerpendicular(plane.axis)),
      v_(plane.axis.cross(u_).normalized()),
      // gap = a / sqrt(3) + rho with rho = kJitterShare a
      spacing_(gap / (kCircumradius + kJitterShare)),
      jitter_(kJitterShare * spacing_),
      patchSize_(kPatchEdge * spacing_),
      seed_(seed)
{
    SAND_CHECK(plane.kind == Primitive::Kind::halfSpace, "only planes have a cover of particles");
    SAND_CHECK(gap > 0.0 && std::isfinite(gap), "gap = {} m", gap);
}

std::pair<std::int32_t, std::int32_t> RoughCover::patchOf(const Vec3& p) const
{
    const Vec3 offset = p - origin_;
    return {patchIndex(u_.dot(offset), patchSize_), patchIndex(v_.dot(offset), patchSize_)};
}

// Row j of the lattice lies at v = j a sqrt(3)/2 and is shifted by half a spacing if j is odd:
//
//     j = 2    o   o   o   o          u = (i + (j odd) / 2) a
//     j = 1      o   o   o   o
//     j = 0    o   o   o   o
//
// so a patch of kPatchEdge spacings holds exactly the points i = kPatchEdge u .. + kPatchEdge - 1
// of each row that belongs to it.
void RoughCover::appendPatch(std::int32_t u, std::int32_t v, std::vector<Vec3>& centres) const
{
    const double patchRow = v;
    // One row early: the division may round either way; patchRowOf decides.
    std::int64_t j =
        static_cast<std::int64_t>(std::floor(patchRow * (kPatchEdge / kRowHeight))) - 1;
    while (patchRowOf(j) < patchRow) {
        ++j;
    }
    for (; patchRowOf(j) == patchRow; ++j) {
        const double rowShift = j % 2 == 0 ? 0.0 : 0.5;
        const std::int64_t first = static_cast<std::int64_t>(u) * kPatchEdge;
        for (std::int64_t i = first; i < first + kPatchEdge; ++i) {
            const Vec2 moved = jitter_ * drawInDisc(seed_, i, j);
            const double s = (static_cast<double>(i) + rowShift) * spacing_ + moved.x();
            const double t = static_cast<double>(j) * (kRowHeight * spacing_) + moved.y();
            centres.push_back(origin_ + s * u_ + t * v_);
        }
    }
}

}  // namespace sandflow
