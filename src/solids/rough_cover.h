#pragma once

#include "solids/primitive.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sandflow {

/// The particles that make a plane rough lie this far below it, in their own radii, so that grains
/// come to rest on the plane itself and no gap shows (centres at 0.8 to 1.2 radii, 1.0 on average).
inline constexpr double kRoughCoverDepth = 0.6;

/// Fixed particles that make a plane rough, made on demand patch by patch, so that an infinite
/// floor costs nothing where no sand lies. Centres lie on the plane, on a triangular lattice of
/// spacing a, each moved by less than rho in the plane by a hash of its lattice indices: any
/// surface point is within a/sqrt(3) + rho = gap of a centre, whatever the hash says.
class RoughCover {
public:
    /// plane: a half-space; gap in m (0.85 r by default elsewhere); seed fixed per scene.
    RoughCover(const Primitive& plane, double gap, std::uint64_t seed);

    /// Edge of a square patch in the plane, m.
    double patchSize() const { return patchSize_; }

    /// Patch indices of the foot point of p. Throws PhysicsError beyond 2^31 patches or for NaN.
    std::pair<std::int32_t, std::int32_t> patchOf(const Vec3& p) const;

    /// Centres of the particles of one patch (each belongs to exactly one patch, by where it was
    /// before it was moved: it may stand out of the patch by jitter()), appended in a fixed order.
    void appendPatch(std::int32_t u, std::int32_t v, std::vector<Vec3>& centres) const;

    double spacing() const { return spacing_; }  ///< a, m
    double jitter() const { return jitter_; }    ///< rho, m
    double gap() const { return spacing_ / 1.7320508075688772 + jitter_; }

private:
    Vec3 origin_, u_, v_;
    double spacing_, jitter_, patchSize_;
    std::uint64_t seed_;
};

}  // namespace sandflow
