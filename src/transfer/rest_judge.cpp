#include "transfer/rest_judge.h"

#include "dem/contact_law.h"

#include <algorithm>

namespace sandflow {
namespace {

/// Elastic normal forces of all touching neighbours on a resting grain: their sum, and the largest
/// single one that a mobile neighbour exerts.
struct RestForces {
    Vec3 sum = Vec3::Zero();
    double largestMobile = 0.0;
};

template <NormalLaw law, class Real>
RestForces sumRestForces(const LawNumbers<double>& numbers, const Dem<Real>& dem,
                         const GrainRecord<Real>& a)
{
    RestForces out;
    const double mass = dem.massOf(static_cast<double>(a.radius));
    const auto push = [&](double dx, double dy, double dz, double partnerRadius, bool mobile) {
        const double radii = static_cast<double>(a.radius) + partnerRadius;
        const double squared = dx * dx + dy * dy + dz * dz;
        if (squared >= radii * radii || squared == 0.0) {
            return;
        }
        const double distance = std::sqrt(squared);
        const double force =
            evaluateNormal<law>(numbers, radii - distance, 0.0, mass,
                                static_cast<double>(a.radius) * partnerRadius / radii)
                .force;
        out.sum += force / distance * Vec3(dx, dy, dz);
        if (mobile) {
            out.largestMobile = std::max(out.largestMobile, force);
        }
    };
    const auto visit = [&](const SortedCells& cells, const std::vector<GrainRecord<Real>>& records,
                           bool mobile) {
        cells.visitNear(cells.cellOf(Vec3(a.x, a.y, a.z)), 1, [&](const SortedCells::Cell& cell) {
            for (std::uint32_t e = cell.begin; e < cell.end; ++e) {
                const GrainRecord<Real>& b = records[e];
                if (b.id != a.id) {
                    push(a.x - b.x, a.y - b.y, a.z - b.z, static_cast<double>(b.radius), mobile);
                }
            }
        });
    };
    visit(dem.lists().cells(), dem.mobile().record, true);
    visit(dem.frozen().cells(), dem.frozen().records(), false);
    visit(dem.boundary().cells(), dem.boundary().records(), false);
    return out;
}

template <class Real>
RestForces restForces(const LawNumbers<double>& numbers, const Dem<Real>& dem,
                      const GrainRecord<Real>& a)
{
    switch (dem.setup().law.law) {
        case NormalLaw::linear: return sumRestForces<NormalLaw::linear>(numbers, dem, a);
        case NormalLaw::hertz: return sumRestForces<NormalLaw::hertz>(numbers, dem, a);
        case NormalLaw::bellYuMucha: break;
    }
    return sumRestForces<NormalLaw::bellYuMucha>(numbers, dem, a);
}

}  // namespace

RestRules makeRestRules(const SurfaceFlowSpec& spec)
{
    RestRules rules;
    rules.freezeDistance = spec.freezeSpeed * spec.freezeTime;
    rules.freezeTime = spec.freezeTime;
    rules.slowSpeed = spec.freezeSpeed;
    // Above the bed nothing holds a grain that only pauses: it would be woken at once.
    rules.sleepSpeed = 0.05 * spec.freezeSpeed;
    rules.cagedTime = spec.cagedTime;
    return rules;
}

template <class Real>
void updateRestClocks(const RestRules& rules, double interval, Dem<Real>& dem)
{
    const auto n = static_cast<std::int64_t>(dem.mobile().size());
    const double limit = rules.freezeDistance * rules.freezeDistance;
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        const GrainRecord<Real>& g = dem.mobile().record[k];
        GrainMemory& m = dem.mobile().memory[k];
        const double dx = g.x - m.anchorX, dy = g.y - m.anchorY, dz = g.z - m.anchorZ;
        if (dx * dx + dy * dy + dz * dz > limit) {
            m.anchorX = g.x, m.anchorY = g.y, m.anchorZ = g.z;
            m.stillTime = std::min(m.stillTime + static_cast<float>(interval), 0.0f);
        } else {
            m.stillTime += static_cast<float>(interval);
        }
    }
}

template <class Real>
bool isAtRest(const RestRules& rules, const Dem<Real>& dem, std::size_t k)
{
    // The clock adds up windows in float; what that rounds off must not cost another window.
    const double still = static_cast<double>(dem.mobile().memory[k].stillTime) * (1.0 + 1e-5);
    const GrainRecord<Real>& g = dem.mobile().record[k];
    const double speed2 = static_cast<double>(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz);
    if (speed2 > rules.slowSpeed * rules.slowSpeed) {
        return false;
    }
    if (still >= rules.cagedTime) {
        return true;
    }
    const GrainLoad& load = dem.mobile().load[k];
    const double weight =
        dem.setup().gravity.norm() / static_cast<double>(dem.mobile().record[k].inverseMass);
    return still >= rules.freezeTime && load.contacts >= static_cast<float>(rules.contacts) &&
           static_cast<double>(load.netForce) <
               rules.netForceShare * (weight + static_cast<double>(load.load));
}

template <class Real>
void judgeNewlyFrozen(const RestRules& rules, Dem<Real>& dem)
{
    const LawNumbers<double> numbers(dem.setup().law);
    const double gravity = dem.setup().gravity.norm();
    const auto n = static_cast<std::int64_t>(dem.frozen().size());
#pragma omp parallel for schedule(dynamic, 256)
    for (std::int64_t k = 0; k < n; ++k) {
        FrozenInfo& info = dem.frozen().info(k);
        if (info.judged) {
            continue;
        }
        GrainRecord<Real>& g = dem.frozen().record(k);
        const RestForces forces = restForces(numbers, dem, g);
        info.restForce = forces.sum.cast<float>();
        info.judged = true;
        const double weight = gravity * dem.massOf(static_cast<double>(g.radius));
        g.wakeForce = static_cast<float>(
            info.state == GrainState::asleep
                ? (1.0 + rules.wakeForceShare) * forces.largestMobile + rules.wakeWeights * weight
                : rules.impactShare * forces.largestMobile + rules.impactWeights * weight);
    }
}

template <class Real>
void markWoken(const RestRules& rules, Dem<Real>& dem)
{
    for (const std::uint32_t k : dem.wakeRequests()) {
        dem.frozen().info(k).wakes = true;
    }
    const LawNumbers<double> numbers(dem.setup().law);
    const double gravity = dem.setup().gravity.norm();
    const auto n = static_cast<std::int64_t>(dem.frozen().size());
#pragma omp parallel for schedule(dynamic, 256)
    for (std::int64_t k = 0; k < n; ++k) {
        FrozenInfo& info = dem.frozen().info(k);
        if (info.state != GrainState::asleep || info.wakes) {
            continue;
        }
        const GrainRecord<Real>& g = dem.frozen().record(k);
        const Vec3 rest = info.restForce.cast<double>();
        const double change = (restForces(numbers, dem, g).sum - rest).norm();
        info.wakes = change > rules.wakeForceShare * rest.norm() +
                                  rules.wakeWeights * gravity *
                                      dem.massOf(static_cast<double>(g.radius));
    }
}

template void updateRestClocks(const RestRules&, double, Dem<float>&);
template void updateRestClocks(const RestRules&, double, Dem<double>&);
template bool isAtRest(const RestRules&, const Dem<float>&, std::size_t);
template bool isAtRest(const RestRules&, const Dem<double>&, std::size_t);
template void judgeNewlyFrozen(const RestRules&, Dem<float>&);
template void judgeNewlyFrozen(const RestRules&, Dem<double>&);
template void markWoken(const RestRules&, Dem<float>&);
template void markWoken(const RestRules&, Dem<double>&);

}  // namespace sandflow
