#include "transfer/flight_judge.h"

#include <algorithm>
#include <vector>

namespace sandflow {
namespace {

/// Share of the velocity that gravity adds by which a free grain's may differ. A step rounds each
/// addition, which makes 1e-4 of it in a window; the weight of a grain that is carried makes 1.
constexpr double kTolerance = 0.05;

template <class Real>
Vec3 velocityOf(const GrainRecord<Real>& g)
{
    return {static_cast<double>(g.vx), static_cast<double>(g.vy), static_cast<double>(g.vz)};
}

/// Lets `interval` pass for one grain; |m v| of the flight that ended, or 0.
template <class Real>
double endFlight(const Vec3& gained, double interval, const GrainRecord<Real>& grain,
                 GrainMemory& memory)
{
    const Vec3 velocity = velocityOf(grain);
    const Vec3 before = memory.velocity.template cast<double>();
    const bool wasFree = (velocity - before - gained).norm() < kTolerance * gained.norm();
    double landed = 0.0;
    if (wasFree) {
        memory.freeTime += static_cast<float>(interval);
    } else {
        if (static_cast<double>(memory.freeTime) >= kFlightTime) {
            landed = before.norm() / static_cast<double>(grain.inverseMass);
        }
        memory.freeTime = 0.0f;
    }
    memory.velocity = velocity.cast<float>();
    return landed;
}

}  // namespace

template <class Real>
void startFlight(double elapsed, Dem<Real>& dem)
{
    GrainMemory& memory = dem.mobile().memory.back();
    // As if it had been in flight since then.
    memory.velocity =
        (velocityOf(dem.mobile().record.back()) - elapsed * dem.setup().gravity).template cast<float>();
    memory.freeTime = static_cast<float>(2.0 * kFlightTime);
}

template <class Real>
double endFlights(double interval, Dem<Real>& dem)
{
    constexpr std::int64_t kBlock = 4096;  // each summed by one thread
    const Vec3 gained = interval * dem.setup().gravity;
    const auto n = static_cast<std::int64_t>(dem.mobile().size());
    std::vector<double> landed(static_cast<std::size_t>((n + kBlock - 1) / kBlock), 0.0);
#pragma omp parallel for schedule(static) if (n > kBlock)
    for (std::int64_t b = 0; b < static_cast<std::int64_t>(landed.size()); ++b) {
        for (std::int64_t k = b * kBlock; k < std::min(n, (b + 1) * kBlock); ++k) {
            landed[b] +=
                endFlight(gained, interval, dem.mobile().record[k], dem.mobile().memory[k]);
        }
    }
    double sum = 0.0;
    for (const double part : landed) {
        sum += part;
    }
    return sum;
}

template void startFlight(double, Dem<float>&);
template void startFlight(double, Dem<double>&);
template double endFlights(double, Dem<float>&);
template double endFlights(double, Dem<double>&);

}  // namespace sandflow
