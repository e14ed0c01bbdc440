#pragma once

#include "dem/dem.h"

namespace sandflow {

/// Flights and where they end: the momentum that sand brings to the heap, against which that lost
/// to trapping is held. A grain is in flight from its emission on, and again when it has touched
/// nothing for so long that it fell by more than a diameter; its flight ends with its first contact
/// with anything.
inline constexpr double kFlightTime = 0.05;  // s; a hop on the way down a slope is shorter

/// The mobile grain that came last was emitted, `elapsed` [s] after the last endFlights().
template <class Real>
void startFlight(double elapsed, Dem<Real>& dem);

/// Looks at every mobile grain, `interval` [s] after the last time: one whose velocity changed by
/// gravity alone was free. Returns the sum of |m v| [kg m/s] of the flights that ended, each with
/// the velocity last seen in flight, which gravity may have raised by g x interval since: a little
/// less than it was. The same for any number of threads.
template <class Real>
double endFlights(double interval, Dem<Real>& dem);

}  // namespace sandflow
