#include "transfer/impact_zones.h"

#include "transfer/flight_judge.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sandflow {
namespace {

constexpr double kSolidFraction = 0.6;  // of sand at rest
constexpr int kPathPoints = 8;          // per interval: less than a diameter apart up to 5 m/s

/// s, after which a force is usual.
constexpr double kUsual = 0.3;

/// Of the weight of the sand above: heaps stand at the limit of what they bear, so little more moves
/// them.
constexpr double kNoticed = 0.2;

/// In d: H is a mean over a column, single grains and the top of a heap stand out of it.
constexpr double kStandsOut = 2.0;

/// Where a grain in free fall may meet the surface within the interval: the span, or kNone.
template <class Real>
std::int32_t findLanding(double interval, const ColumnGrid& columns, const DemSetup& setup,
                         const GrainRecord<Real>& g, Vec3& at)
{
    const double above = static_cast<double>(g.radius) + kStandsOut * 2.0 * setup.meanRadius;
    const Vec3 start(g.x, g.y, g.z);
    const Vec3 velocity(static_cast<double>(g.vx), static_cast<double>(g.vy),
                        static_cast<double>(g.vz));
    for (int n = 1; n <= kPathPoints; ++n) {
        const double t = interval * n / kPathPoints;
        at = start + velocity * t + 0.5 * t * t * setup.gravity;
        const std::int32_t span = columns.spanAt(at.x(), at.y(), at.z());
        if (span != ColumnGrid::kNone && at.z() - above < columns.H[span]) {
            return span;
        }
    }
    return ColumnGrid::kNone;
}

/// P [m].
double pressed(double force, double weight)
{
    return std::cbrt(3.0 * std::max(0.0, force) / (2.0 * kPi * kNoticed * weight));
}

}  // namespace

double ImpactWatch::Strike::heaved(double weight) const
{
    return std::pow(energy / (2.0 / 3.0 * kPi * weight), 0.25);
}

void ImpactWatch::Strike::add(const Strike& other)
{
    energy += other.energy;
    widest = std::max(widest, other.widest);
    moment += other.moment;
    momentum += other.momentum;
}

/// Adds up strikes that are within each other's reach, until none is.
auto ImpactWatch::gather(double weight, const std::vector<Strike>& bySpan) -> std::vector<Strike>
{
    std::vector<Strike> gathered;
    for (Strike sum : bySpan) {
        for (std::size_t k = 0; k < gathered.size();) {
            const double reach = std::max(sum.heaved(weight), gathered[k].heaved(weight));
            if ((sum.centre() - gathered[k].centre()).norm() < reach) {
                sum.add(gathered[k]);
                gathered.erase(gathered.begin() + static_cast<std::ptrdiff_t>(k));
                k = 0;  // it reaches farther now
            } else {
                ++k;
            }
        }
        gathered.push_back(sum);
    }
    return gathered;
}

double ImpactWatch::usualNear(const Vec3& centre, double reach) const
{
    double sum = 0.0;
    for (const UsualForce& usual : usual_) {
        sum += (usual.at - centre).norm() < reach ? usual.force : 0.0;
    }
    return sum;
}

template <class Real>
std::vector<ImpactZone> ImpactWatch::foresee(double interval, const ColumnGrid& columns,
                                             const Dem<Real>& dem)
{
    std::map<std::int32_t, Strike> bySpan;
    for (std::size_t k = 0; k < dem.mobile().size(); ++k) {
        if (static_cast<double>(dem.mobile().memory[k].freeTime) < kFlightTime) {
            continue;
        }
        const GrainRecord<Real>& g = dem.mobile().record[k];
        Vec3 at;
        const std::int32_t span = findLanding(interval, columns, dem.setup(), g, at);
        if (span == ColumnGrid::kNone) {
            continue;
        }
        const double mass = 1.0 / static_cast<double>(g.inverseMass);
        const double speed2 = static_cast<double>(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz);
        const double energy = 0.5 * mass * speed2;
        if (energy > 0.0) {
            bySpan[span].add({energy, static_cast<double>(g.radius),
                              energy * Vec3(at.x(), at.y(), columns.H[span]),
                              mass * std::sqrt(speed2)});
        }
    }

    std::vector<Strike> struck;
    for (const auto& [span, strike] : bySpan) {
        struck.push_back(strike);
    }
    const double weight = kSolidFraction * dem.setup().density *
                          dem.setup().gravity.norm();  // N/m3
    struck = gather(weight, struck);
    std::vector<ImpactZone> zones;
    for (const Strike& strike : struck) {
        const double force = strike.momentum / interval;
        const double heaved = strike.heaved(weight);
        const double added =
            force - usualNear(strike.centre(), std::max(heaved, pressed(force, weight)));
        if (heaved > 2.0 * dem.setup().meanRadius) {
            zones.push_back(
                {strike.centre(), strike.widest + std::max(heaved, pressed(added, weight))});
        }
    }

    const double stays = std::exp(-interval / kUsual);
    for (UsualForce& usual : usual_) {
        usual.force *= stays;
    }
    for (const Strike& strike : struck) {
        usual_.push_back({strike.centre(), (1.0 - stays) * strike.momentum / interval});
    }
    std::erase_if(usual_, [&](const UsualForce& usual) {
        return pressed(usual.force, weight) < dem.setup().meanRadius;
    });
    return zones;
}

template <class Real>
void wakeZones(const std::vector<ImpactZone>& zones, Dem<Real>& dem)
{
    const SortedCells& cells = dem.frozen().cells();
    for (const ImpactZone& zone : zones) {
        const auto reach = static_cast<std::int32_t>(std::ceil(zone.radius / cells.cellSize()));
        cells.visitNear(cells.cellOf(zone.centre), reach, [&](const SortedCells::Cell& cell) {
            for (std::uint32_t e = cell.begin; e < cell.end; ++e) {
                const GrainRecord<Real>& g = dem.frozen().record(e);
                if (zone.holds(Vec3(g.x, g.y, g.z))) {
                    dem.frozen().info(e).wakes = true;
                }
            }
        });
    }
}

template std::vector<ImpactZone> ImpactWatch::foresee(double, const ColumnGrid&, const Dem<float>&);
template std::vector<ImpactZone> ImpactWatch::foresee(double, const ColumnGrid&, const Dem<double>&);
template void wakeZones(const std::vector<ImpactZone>&, Dem<float>&);
template void wakeZones(const std::vector<ImpactZone>&, Dem<double>&);

}  // namespace sandflow
