#pragma once

#include "dem/contact_coefficients.h"

namespace sandflow {

/// Contacts of a grain in the densest packing of equal spheres.
inline constexpr double kDenseCoordination = 12.0;

/// A fast grain may cross this share of the smallest radius in one step, so that it is met in time
/// and its contact is entered at a small overlap.
inline constexpr double kTravelPerStep = 0.1;

/// Largest stable step [s] of symplectic Euler with an explicit dashpot for x" = -w^2 x - c x'.
///
///   v+ = v - dt (w^2 x + c v),  x+ = x + dt v+
///
/// has the characteristic polynomial l^2 - (2 - dt^2 w^2 - dt c) l + (1 - dt c); both roots lie in
/// the unit circle for dt^2 w^2 + 2 c dt < 4 (Jury), that is for
///
///   dt < 4 / (c + sqrt(c^2 + 4 w^2)).
///
/// frequencySquared w^2 [1/s2], damping c [1/s]; infinite where both vanish.
double boundSymplecticEuler(double frequencySquared, double damping);

/// Largest stable steps [s] of the three kinds of stiffest motion of packed equal grains.
struct ModeBounds {
    double translation = 0.0;  ///< neighbours move against each other
    double rotation = 0.0;     ///< all turn alike and so slip on each other
    double rolling = 0.0;      ///< neighbours turn against each other; infinite without it
};

/// Bounds for grains of given mass [kg] and radius [m] with `coordination` contacts spread evenly
/// over all directions, at overlap [m] (the linear law ignores it).
///
/// A contact's normal part n n^T averages to 1/3 over directions, its tangential part to 2/3.
///   translation, neighbours in anti-phase: relative displacement 2 u at every contact,
///     w^2 = (2 Z / 3)(S + 2 kt) / m,   c = (2 Z / 3)(cn + 2 ct) / m
///   rotation, all spins alike: slip 2 R omega x n, arm R,
///     w^2 = (4 Z / 3) kt R^2 / I,      c = (4 Z / 3) ct R^2 / I
///   rolling, spins in anti-phase: relative turn 2 omega off the normal,
///     w^2 = (4 Z / 3) kr / I,          c = (4 Z / 3) Cr / I
/// with I = 0.4 m R^2. These are the extreme Bloch modes of the simple and body-centred cubic
/// lattice and bound those of the face-centred one from the safe side.
ModeBounds boundModes(const ContactCoefficients& law, double mass, double radius, double overlap,
                      double coordination);

}  // namespace sandflow
