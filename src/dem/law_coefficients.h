#pragma once

#include "scene/normal_law.h"

namespace sandflow {

/// How much of rolling resistance a law has; what it has not is not compiled into its kernel.
enum class RollingLaw { none, spring, springAndDashpot };

/// The numbers of the contact law, as the kernel uses them. delta is the overlap [m], R* and m* the
/// pair-effective radius and mass (fixed partner: m* = m). S is the tangent normal stiffness.
///
///   linear            Fe = k delta                  S = k                      c = 2 beta sqrt(m* k)
///   Hertz             Fe = K sqrt(R*) delta^1.5     S = 1.5 K sqrt(R* delta)   c = beta sqrt(S m*)
///   Bell-Yu-Mucha     Fe = K sqrt(R*) delta^1.5     S as Hertz                 c = D K sqrt(R* delta)
///
///   Fn = Fe + c (d delta / dt), clipped at 0 when clipAttraction
///   kt = tangentialRatio S, ct = tangentialDamping c, |Ft| <= friction Fn (spring shortened to fit)
///   kr = rollingStiffness S R*^2, |M| <= rollingFriction R* Fn (EPSD, Ai et al. 2011, model C)
struct ContactCoefficients {
    NormalLaw law = NormalLaw::linear;
    bool clipAttraction = true;
    double stiffness = 0.0;          ///< linear: k [N/m]; else K = (4/3) E* [N/m2]
    double damping = 0.0;            ///< linear, Hertz: beta [-]; Bell-Yu-Mucha: D [s]
    double friction = 0.0;           ///< mu
    double tangentialRatio = 0.0;    ///< kt / S
    double tangentialDamping = 0.0;  ///< ct / c
    double rollingFriction = 0.0;    ///< mu_r
    double rollingStiffness = 0.0;   ///< kr / (S R*^2); EPSD: 2.25 mu_r^2
    double rollingDamping = 0.0;     ///< eta_r: Cr = eta_r 2 sqrt(Ir kr), off at full mobilisation

    RollingLaw rollingLaw() const
    {
        return rollingFriction <= 0.0  ? RollingLaw::none
               : rollingDamping <= 0.0 ? RollingLaw::spring
                                       : RollingLaw::springAndDashpot;
    }
};

/// Calls make<law, rolling>() with both as constants.
template <class Make>
auto chooseLaw(NormalLaw law, RollingLaw rolling, Make make)
{
    const auto chooseRolling = [&]<NormalLaw known>() {
        switch (rolling) {
        case RollingLaw::none: return make.template operator()<known, RollingLaw::none>();
        case RollingLaw::spring: return make.template operator()<known, RollingLaw::spring>();
        case RollingLaw::springAndDashpot: break;
        }
        return make.template operator()<known, RollingLaw::springAndDashpot>();
    };
    switch (law) {
    case NormalLaw::linear: return chooseRolling.template operator()<NormalLaw::linear>();
    case NormalLaw::hertz: return chooseRolling.template operator()<NormalLaw::hertz>();
    case NormalLaw::bellYuMucha: break;
    }
    return chooseRolling.template operator()<NormalLaw::bellYuMucha>();
}

}  // namespace sandflow
