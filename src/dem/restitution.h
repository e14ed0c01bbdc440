#pragma once

#include "scene/scene.h"

namespace sandflow {

/// A head-on collision of a pair in its own units: length L, time T = L/V, V the impact speed.
///
///   linear          L = V sqrt(m*/k)                x" = -x     - 2 b x'
///   Hertz           L = (m* V^2 / K sqrt(R*))^0.4   x" = -x^1.5 - b sqrt(1.5) x^0.25 x'
///   Bell-Yu-Mucha   L as Hertz                      x" = -x^1.5 - b sqrt(x) x'
///
/// b is beta for the first two, so their collisions are alike at every speed; for Bell-Yu-Mucha
/// b = D V / L, which grows as V^0.2.
struct Collision {
    double restitution = 1.0;  ///< speed out / speed in
    double peakOverlap = 0.0;  ///< in L
    double duration = 0.0;     ///< in T, until the force (clipped) or the overlap is back at 0
};

/// Integrates that collision (adaptive Runge-Kutta 8(9), 1e-12 a step) from first touch to the end.
/// damping b >= 0 [-]. Overdamped and unclipped, a pair creeps apart for ever: restitution 0,
/// duration infinite.
Collision integrateCollision(NormalLaw law, bool clipAttraction, double damping);

/// The b at which that collision has the given restitution. Closed form for the unclipped linear
/// and Hertz laws, Brent on the closed form of the clipped linear law (Schwager & Poeschel 2007),
/// Brent on integrateCollision for the others. restitution outside [kLeastRestitution, 1] throws
/// InputError.
double solveDamping(NormalLaw law, bool clipAttraction, double restitution);

/// Below this the dashpot outweighs the spring and would rule the time step.
inline constexpr double kLeastRestitution = 0.01;

/// Length L [m] of the collision above. stiffness: linear k [N/m], else K = (4/3) E* [N/m2];
/// effectiveMass [kg], effectiveRadius [m], speed [m/s].
double collisionLength(NormalLaw law, double stiffness, double effectiveMass,
                       double effectiveRadius, double speed);

/// Restitution of the clipped linear law: e = exp(-2 beta acos(beta) / sqrt(1 - beta^2)).
double clippedLinearRestitution(double beta);

}  // namespace sandflow
