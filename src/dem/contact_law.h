#pragma once

#include "core/small_vec.h"
#include "dem/lane_math.h"
#include "dem/law_coefficients.h"

#include <algorithm>
#include <cmath>
#include <limits>

/// The contact law as pure functions: numbers in, force out. The kernel and the tests call these
/// same functions. The law is a template argument, the clip a number: no branch depends on either.
/// Real is a number or a vector of lanes, see lane_math.h.
namespace sandflow {

/// ContactCoefficients in the kernel's precision, with the products that all contacts share.
template <class Real>
struct LawNumbers {
    Real stiffness{};          ///< linear: k [N/m]; else K = (4/3) E* [N/m2]
    Real damping{};            ///< linear: 2 beta sqrt(k); Hertz: beta; Bell-Yu-Mucha: D [s]
    Real forceFloor{};         ///< 0 where attraction is clipped, else -infinity
    Real friction{};           ///< mu
    Real tangentialRatio{};    ///< kt / S
    Real tangentialDamping{};  ///< ct / c
    Real rollingFriction{};    ///< mu_r
    Real rollingStiffness{};   ///< kr / (S R*^2)
    Real rollingDamping{};     ///< 2 eta_r

    LawNumbers() = default;
    explicit LawNumbers(const ContactCoefficients& law)
        : stiffness(static_cast<Real>(law.stiffness)),
          damping(static_cast<Real>(law.law == NormalLaw::linear
                                        ? 2.0 * law.damping * std::sqrt(law.stiffness)
                                        : law.damping)),
          forceFloor(static_cast<Real>(
              law.clipAttraction ? 0.0 : -std::numeric_limits<double>::infinity())),
          friction(static_cast<Real>(law.friction)),
          tangentialRatio(static_cast<Real>(law.tangentialRatio)),
          tangentialDamping(static_cast<Real>(law.tangentialDamping)),
          rollingFriction(static_cast<Real>(law.rollingFriction)),
          rollingStiffness(static_cast<Real>(law.rollingStiffness)),
          rollingDamping(static_cast<Real>(2.0 * law.rollingDamping))
    {
    }
};

template <class Real>
struct NormalForce {
    Real force{};             ///< N, > 0 pushes the pair apart; never below 0 when clipped
    Real tangentStiffness{};  ///< S = dFe / d delta, N/m
    Real dashpot{};           ///< c, N s/m
};

template <class Real>
struct Tangential {
    Vec<Real> force;   ///< N, on the grain whose slip velocity was given
    Vec<Real> spring;  ///< m, to be kept for the next step
};

template <class Real>
struct Rolling {
    Vec<Real> torque;  ///< N m, on the grain whose spin counts positive; the partner gets -torque
    Vec<Real> spring;  ///< m, to be kept for the next step
};

/// Normal force of a touching pair.
/// overlap [m] must not be negative; closingSpeed [m/s] is d overlap / dt, > 0 on approach;
/// effectiveMass [kg] and effectiveRadius [m] are m* and R* (fixed partner: m* = m).
template <NormalLaw law, class Real>
inline NormalForce<Real> evaluateNormal(const LawNumbers<Real>& numbers, Real overlap,
                                        Real closingSpeed, Real effectiveMass,
                                        [[maybe_unused]] Real effectiveRadius)
{
    using std::max;
    NormalForce<Real> normal;
    Real elastic;
    if constexpr (law == NormalLaw::linear) {
        // Fe = k delta, c = 2 beta sqrt(m* k)
        elastic = numbers.stiffness * overlap;
        normal.tangentStiffness = numbers.stiffness;
        normal.dashpot = numbers.damping * root(effectiveMass);
    } else {
        // Fe = K sqrt(R* delta) delta, S = 1.5 K sqrt(R* delta)
        const Real rising = numbers.stiffness * root(effectiveRadius * overlap);
        elastic = rising * overlap;
        normal.tangentStiffness = Real(1.5) * rising;
        if constexpr (law == NormalLaw::hertz) {
            normal.dashpot = numbers.damping * root(normal.tangentStiffness * effectiveMass);
        } else {
            normal.dashpot = numbers.damping * rising;
        }
    }
    normal.force = max(elastic + normal.dashpot * closingSpeed, numbers.forceFloor);
    return normal;
}

/// Tangential spring and dashpot under a Coulomb cap (Cundall & Strack 1979).
/// spring [m] is the stored tangential displacement, already turned into the present tangent plane;
/// slip [m/s] the tangential velocity of this grain's surface against the partner's; normalForce
/// [N], tangentStiffness S [N/m] and dashpot c [N s/m] as evaluateNormal gave them; dt [s].
///
/// The spring is advanced by slip dt first, so it belongs to the same instant as the positions.
/// A contact that pulls (unclipped law at separation) carries no friction.
template <class Real>
inline Tangential<Real> evaluateTangential(const LawNumbers<Real>& numbers,
                                           const Vec<Real>& spring, const Vec<Real>& slip,
                                           Real normalForce, Real tangentStiffness, Real dashpot,
                                           Real dt)
{
    using std::max;
    const Real kt = numbers.tangentialRatio * tangentStiffness;
    const Real ct = numbers.tangentialDamping * dashpot;
    const Real cap = numbers.friction * max(normalForce, Real(0));

    // Ft = -(kt s + ct v), |Ft| <= mu Fn
    const Vec<Real> stretched = spring + dt * slip;
    const Vec<Real> trial = -(kt * stretched + ct * slip);
    const Real squared = dot(trial, trial);
    const Real share = select(squared > cap * cap, cap * inverseRoot(squared), Real(1));

    // Sliding shortens the spring in the same proportion, which settles at the usual
    // s = -(Ft + ct v) / kt while that points along the slip. Where ct v exceeds the cap the usual
    // spring would point backwards: energy from nothing, doubling that of some Hertz impacts.
    return {share * trial, share * stretched};
}

/// Rolling resistance by an elastic-plastic spring and dashpot (Ai et al. 2011, model C).
/// All as lengths: rollingVelocity [m/s] is R* (omega_i - omega_j) without its part along the
/// normal, spring [m] its integral, already turned into the present tangent plane.
/// rollingMass [kg] is Ir / R*^2 with 1/Ir = sum of 1/(I + m R^2) over the grains that are free to
/// turn. The torque is the one on grain i; it never exceeds mu_r R* Fn.
template <RollingLaw law = RollingLaw::springAndDashpot, class Real>
inline Rolling<Real> evaluateRolling(const LawNumbers<Real>& numbers, const Vec<Real>& spring,
                                     const Vec<Real>& rollingVelocity, Real normalForce,
                                     Real tangentStiffness, Real effectiveRadius,
                                     [[maybe_unused]] Real rollingMass, Real dt)
{
    using std::max;
    // M = -kr theta - Cr omega with theta = s / R*: M / R* = -(kr / R*^2) s - (Cr / R*^2) v
    const Real kr = numbers.rollingStiffness * tangentStiffness;
    const Real cap = numbers.rollingFriction * max(normalForce, Real(0));

    const Vec<Real> stretched = spring + dt * rollingVelocity;
    const Vec<Real> elastic = kr * stretched;
    const Real squared = dot(elastic, elastic);
    const auto mobilised = squared > cap * cap;
    const Real share = select(mobilised, cap * inverseRoot(squared), Real(1));
    const Vec<Real> kept = share * stretched;
    if constexpr (law != RollingLaw::springAndDashpot) {
        return {-((effectiveRadius * share) * elastic), kept};
    }

    // Cr = 2 eta_r sqrt(Ir kr), off at full mobilisation.
    const Real cr =
        select(mobilised, Real(0), numbers.rollingDamping * root(rollingMass * kr));
    // Two fast spinning grains that meet would load the dashpot to a hundred times the cap before
    // the spring is mobilised, so the cap holds for both together.
    const Vec<Real> trial = -(share * elastic + cr * rollingVelocity);
    const Real both = dot(trial, trial);
    const Real held = select(both > cap * cap, cap * inverseRoot(both), Real(1));
    return {(effectiveRadius * held) * trial, kept};
}

}  // namespace sandflow
