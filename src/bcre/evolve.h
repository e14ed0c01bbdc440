#pragma once

#include "bcre/columns.h"

namespace sandflow {

/// What eqs. (1)-(3) of the paper need, in SI units and radians.
struct BcreParams {
    double exchangeRate = 100.0;              ///< gamma, 1/(s rad)
    double reposeAngle = 0.6283185307179586;  ///< theta0, rad
    SlopeForm slopeForm = SlopeForm::angle;   ///< theta - theta0, or tan(theta) - tan(theta0)
    double minFlowDepth = 0.02;               ///< R_min, m
    /// xi, m: of a deeper layer only about xi takes part in the exchange (Boutreux, Raphael & de
    /// Gennes 1998); 0: all of it, as in the paper.
    double saturationDepth = 0.0;
    double maxChange = 0.003;                 ///< m, largest |dh| of a span in one evolve()
    bool transport = false;                   ///< the v_d dR/dx term of eq. (2)
    double transportSpeed = 0.3;              ///< v_d, m/s
};

struct BcreReport {
    int substeps = 0;
    double erodedVolume = 0.0;     ///< m3, from h to R by the exchange
    double depositedVolume = 0.0;  ///< m3, from R to h by the exchange
    double outflowVolume = 0.0;    ///< m3 of R that left at sink spans
};

/// First arrow of eq. (4), with h kept as state: where the surface sank below the bed the bed goes
/// with it (never below the floor), and R = H - h.
void followSurface(ColumnGrid& columns);

/// Evolves h and R over dt [s] with the exchange of eq. (3) (and the transport of eq. (2) when
/// switched on), in as many explicit substeps as stability asks. h + R of a span is unchanged by
/// the exchange; the sum over spans is unchanged by transport except for outflow at sink spans (a
/// link that is kNone is a closed wall). Fills dh; with transport also H = h + R.
/// Throws PhysicsError if a stable substep would be absurdly short or h, R are not numbers.
BcreReport evolveBcre(const BcreParams& params, double dt, ColumnGrid& columns);

/// Last arrows of eq. (4): R' = max(R, R_min) where the sand is that deep, h' = H - R', never below
/// the floor. Does not touch dh.
void enforceMinFlowDepth(const BcreParams& params, ColumnGrid& columns);

/// Slope angle theta [rad] of h at every span: upwind magnitude (Godunov / Rouy-Tourin), so that a
/// heap stays round. Exposed for tests and diagnostics.
void upwindSlope(const ColumnGrid& columns, std::vector<double>& theta);

}  // namespace sandflow
