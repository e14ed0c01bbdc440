#pragma once

#include "dem/contact_law.h"

/// From two grains to force and torques on both: the geometry and kinematics around contact_law.h.
/// Real is a number or a vector of lanes, see lane_math.h. Everything is exactly antisymmetric:
/// seen from the partner, with the normal turned and the springs negated, the same bits come out
/// with the sign turned. That is why a pair may be computed once for both, or by each for itself.
namespace sandflow {

/// What a contact needs of one side.
template <class Real>
struct ContactSide {
    Real radius{};       ///< m
    Real inverseMass{};  ///< 1/kg, 0: fixed
    Vec<Real> velocity;  ///< m/s
    Vec<Real> spin;      ///< rad/s
};

template <class Real>
struct ContactGeometry {
    Vec<Real> normal;        ///< from the partner to the grain
    Real overlap{};          ///< m
    Real arm{};              ///< m, from the grain's centre to the contact point
    Real partnerArm{};       ///< m
    Real effectiveRadius{};  ///< m, R*
    Real radiusRatio{};      ///< (R_i + R_j)^2 / R_i R_j: 4 for equal grains; 1 at a wall
};

template <class Real>
struct ContactSprings {
    Vec<Real> tangential, rolling;  ///< m; zero in a new contact
};

template <class Real>
struct ContactForce {
    Vec<Real> force;          ///< N, on the grain; the partner gets -force
    Vec<Real> torque;         ///< N m, on the grain
    Vec<Real> partnerTorque;  ///< N m
    Real normal{};            ///< N
};

/// Two overlapping spheres `apart` [m] from each other (grain minus partner), not concentric.
template <class Real>
inline ContactGeometry<Real> measureContact(const Vec<Real>& apart, Real radius, Real partnerRadius)
{
    ContactGeometry<Real> at;
    const Real radii = radius + partnerRadius;
    const Real squared = dot(apart, apart);
    // The overlap is a small difference, so here the root is exact.
    using std::sqrt;
    at.overlap = radii - sqrt(squared);
    at.normal = inverseRoot(squared) * apart;
    const Real half = Real(0.5) * at.overlap;
    at.arm = radius - half;
    at.partnerArm = partnerRadius - half;
    const Real product = radius * partnerRadius;
    const Real inverse = Real(1) / (radii * product);  // one quotient for both
    at.effectiveRadius = product * product * inverse;
    at.radiusRatio = radii * radii * radii * inverse;
    return at;
}

/// Springs are turned into the present tangent plane by projection; over a turn by an angle a in
/// steps of a/n this shortens them by a factor cos(a/n)^n, which is 1 - a^2/2n: nothing at n of
/// hundreds.
template <NormalLaw law, RollingLaw rolling, class Real>
inline ContactForce<Real> evaluateContact(const LawNumbers<Real>& numbers,
                                          const ContactGeometry<Real>& at,
                                          const ContactSide<Real>& grain,
                                          const ContactSide<Real>& partner, Real dt,
                                          ContactSprings<Real>& springs)
{
    const Vec<Real>& n = at.normal;
    const Vec<Real> velocity = grain.velocity - partner.velocity;
    const Real opening = dot(velocity, n);
    const Vec<Real> spin = at.arm * grain.spin + at.partnerArm * partner.spin;
    // Velocity of the grain's surface against the partner's: v - arm (omega x n) on either side.
    const Vec<Real> slip = velocity - opening * n - cross(spin, n);

    const Real rootMass = inverseRoot(grain.inverseMass + partner.inverseMass);
    const Real effectiveMass = rootMass * rootMass;
    const NormalForce<Real> fn = evaluateNormal<law>(numbers, at.overlap, -opening, effectiveMass,
                                                     at.effectiveRadius);
    const Tangential<Real> ft =
        evaluateTangential(numbers, projectOff(springs.tangential, n), slip, fn.force,
                           fn.tangentStiffness, fn.dashpot, dt);
    springs.tangential = ft.spring;

    ContactForce<Real> out;
    out.force = fn.force * n + ft.force;
    out.normal = fn.force;
    // -arm n x Ft on either side: the partner's arm and its force both point the other way.
    const Vec<Real> twist = cross(n, ft.force);
    if constexpr (rolling != RollingLaw::none) {
        const Vec<Real> turning = at.effectiveRadius * projectOff(grain.spin - partner.spin, n);
        // 1/Ir = sum of 1/(7/5 m R^2), with R_i R_j for either R^2: exact for equal sizes, and the
        // same number seen from both sides.
        const Real rollingMass = Real(1.4) * effectiveMass * at.radiusRatio;
        const Rolling<Real> roll =
            evaluateRolling<rolling>(numbers, projectOff(springs.rolling, n), turning, fn.force,
                                     fn.tangentStiffness, at.effectiveRadius, rollingMass, dt);
        springs.rolling = roll.spring;
        out.torque = roll.torque - at.arm * twist;
        out.partnerTorque = -roll.torque - at.partnerArm * twist;
    } else {
        out.torque = -at.arm * twist;
        out.partnerTorque = -at.partnerArm * twist;
    }
    return out;
}

}  // namespace sandflow
