#pragma once

#include "dem/law_coefficients.h"
#include "scene/scene.h"

#include <string>

namespace sandflow {

/// The loads that stiffness and step must stand.
struct LoadCase {
    double fastestSpeed = 0.0;    ///< m/s, of any grain at impact on a fixed one
    double deepestColumn = 0.0;   ///< m of sand above the lowest grain
    double minRadius = 0.0;       ///< m
    double maxRadius = 0.0;       ///< m
    double density = 0.0;         ///< kg/m3
    double gravity = kGravity;    ///< m/s2
};

/// Where a number came from, to be printed.
struct StiffnessReport {
    double impactOverlap = 0.0;  ///< in r: predicted, fastest grain against a fixed one
    double loadOverlap = 0.0;    ///< in r: predicted, deepest grain under its column
    bool automatic = false;
    std::string reason;          ///< one sentence
};

/// Coefficients of a scene's grains. Stiffness `auto` is the smallest that keeps both predicted
/// overlaps <= scene.contact.maxOverlap; a given stiffness beyond that throws InputError saying what
/// would be enough. Damping is solved so that the law as it runs (clipped or not) has exactly
/// scene.contact.restitution: closed form or Brent for the linear law, Brent over an integrated
/// collision for Hertz (independent of speed) and Bell-Yu-Mucha (at referenceSpeed).
ContactCoefficients makeContactCoefficients(const Scene& scene, const LoadCase& load,
                                            StiffnessReport& report);

/// Restitution of the law as it runs for a pair (m*, R*) at impact speed v, by integrating the
/// collision (adaptive, 1e-10); the reference for tests.
double integrateRestitution(const ContactCoefficients& law, double effectiveMass,
                            double effectiveRadius, double speed);

/// Peak overlap [m] of that collision.
double integratePeakOverlap(const ContactCoefficients& law, double effectiveMass,
                            double effectiveRadius, double speed);

struct StepReport {
    double bound = 0.0;       ///< s, stability bound of symplectic Euler
    double step = 0.0;        ///< s, what to use
    std::string reason;       ///< "translation (springs and dashpots at 12 contacts)", "rotation",
                              ///< "fastest grain", "given"
};

/// Largest stable step of symplectic Euler for packed grains, from the worst Bloch mode at
/// coordination Z = 12 of the smallest grain at tangent stiffness S (see implementation for the
/// derivation), of rotation likewise, and of the fastest grain (v dt <= 0.1 r_min).
/// overlap [m] sets S for Hertz and Bell-Yu-Mucha; the linear law ignores it. A given step beyond
/// the bound throws InputError with the reason.
StepReport stableStep(const ContactCoefficients& law, const LoadCase& load, double overlap,
                      double safety, const std::optional<double>& given);

}  // namespace sandflow
