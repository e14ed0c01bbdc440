#include "study/soundness_watch.h"

#include "emit/emitter.h"
#include "emit/settled_packing.h"
#include "measure/grain_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandflow {
namespace {

/// Speeds are compared at the end of frames, of which a grain may have bounced in; beyond this share
/// of the speed of its fall it cannot have come by that.
constexpr double kSpeedAllowance = 1.1;

/// Of all grains' m g d. Rounding in float is far below; what a grain gains that slips from one
/// contact to the next is below as well.
constexpr double kEnergyAllowance = 0.02;

/// Stiffness is chosen for single blows and mean loads; a grain that is struck while others hold it
/// gives way by more. Beyond half as much again the choice was wrong.
constexpr double kOverlapAllowance = 1.5;

constexpr std::size_t kFramesAtRest = 10;

double sphereMass(double radius, double density)
{
    return 4.0 / 3.0 * kPi * radius * radius * radius * density;
}

/// Energy of motion and height [J/kg] of the best placed grain of an emitter at its start.
double startingEnergyOf(const EmitterSpec& emitter, const Scene& scene)
{
    Vec3 low = emitter.position, high = emitter.position;
    double speed = emitter.velocity.norm();
    switch (emitter.kind) {
    case EmitterKind::jet:
        low -= Vec3::Constant(emitter.radius), high += Vec3::Constant(emitter.radius);
        speed = emitter.speed;
        break;
    case EmitterKind::slot:
        low -= Vec3::Constant(0.5 * emitter.size.norm());
        high += Vec3::Constant(0.5 * emitter.size.norm());
        speed = emitter.speed;
        break;
    case EmitterKind::block:
    case EmitterKind::fill:
        low = emitter.min, high = emitter.max;
        break;
    case EmitterKind::pile: {
        const double height = coneHeight(emitter.slopeAngle, emitter.count, scene.grains);
        const double base = height / std::tan(emitter.slopeAngle * kPi / 180.0);
        low -= Vec3(base, base, 0.0), high += Vec3(base, base, height);
        break;
    }
    case EmitterKind::single:
        break;
    }
    const Vec3 up = -scene.gravity;
    return up.cwiseMax(0.0).dot(high) + up.cwiseMin(0.0).dot(low) + 0.5 * speed * speed;
}

/// Largest speed gained by a blow of the heaviest grain on the lightest, over the speed of the blow.
double speedGain(const RunPlan& plan)
{
    const double ratio = std::pow(plan.load.maxRadius / plan.load.minRadius, 3.0);
    return 2.0 * ratio / (1.0 + ratio);
}

/// Elastic energy [J] of a normal spring.
double elasticEnergy(const ContactCoefficients& law, double overlap, double effectiveRadius)
{
    if (overlap <= 0.0) {
        return 0.0;
    }
    return law.law == NormalLaw::linear
               ? 0.5 * law.stiffness * overlap * overlap
               : 0.4 * law.stiffness * std::sqrt(effectiveRadius) * std::pow(overlap, 2.5);
}

/// Elastic energy [J] of the normal springs between grains and against smooth solids. The particles
/// of rough ones are not known here; few grains touch them.
double sumElasticEnergy(const Snapshot& sand, const ContactCoefficients& law,
                        const SolidSet& solids)
{
    if (sand.size() == 0) {
        return 0.0;
    }
    const GrainGrid grid(sand, 2.0 * findLargestRadius(sand));
    double sum = 0.0;
    for (std::size_t a = 0; a < sand.size(); ++a) {
        grid.visitNear(a, [&](std::size_t b) {
            const double ra = sand.radius[a], rb = sand.radius[b];
            const double overlap = ra + rb - (sand.position[a] - sand.position[b]).norm();
            sum += b > a ? elasticEnergy(law, overlap, ra * rb / (ra + rb)) : 0.0;
            return true;
        });
        for (const Primitive& wall : solids.primitives()) {
            if (!wall.rough && wall.existsAt(sand.time)) {
                const double r = sand.radius[a];
                sum += elasticEnergy(law, r - nearestSurface(wall, sand.position[a]).distance, r);
            }
        }
    }
    return sum;
}

}  // namespace

SoundnessWatch::SoundnessWatch(const Scene& scene)
    : scene_(scene),
      unitEnergy_(sphereMass(scene.grains.radius, scene.grains.density) * scene.gravity.norm() *
                  scene.diameter()),
      startingEnergy_(-1e30),
      lastEmission_(lastEmissionTime(scene)),
      lowest_(1e30)
{
    for (const EmitterSpec& emitter : scene.emitters) {
        startingEnergy_ = std::max(startingEnergy_, startingEnergyOf(emitter, scene));
    }
}

void SoundnessWatch::look(const Simulation& sand, const FrameReport& report)
{
    sand.takeSnapshot(now_);
    inSolids_ = std::max(inSolids_, sand.countLeaks());
    const Ledger& count = report.ledger;
    lost_ = std::max<std::uint64_t>(lost_, count.emitted - count.exited - now_.size());
    deepestOverlap_ =
        std::max(deepestOverlap_, report.deepestOverlap / sand.plan().load.minRadius);
    lookAtSpeeds(speedGain(sand.plan()));
    lookAtEnergy(sand, report);
    motion_.push_back(motionOfMost() / unitEnergy_);
    if (motion_.size() > kFramesAtRest) {
        motion_.pop_front();
    }
}

/// Energy of motion per grain [J], without the one grain in a hundred that has most: one that is
/// still in the air or rolls by is no jitter.
double SoundnessWatch::motionOfMost() const
{
    std::vector<double> energy;
    for (std::size_t n = 0; n < now_.size(); ++n) {
        const double r = now_.radius[n];
        energy.push_back(sphereMass(r, scene_.grains.density) *
                         (0.5 * now_.velocity[n].cast<double>().squaredNorm() +
                          0.2 * r * r * now_.spin[n].cast<double>().squaredNorm()));
    }
    if (energy.empty()) {
        return 0.0;
    }
    const std::size_t most = energy.size() - energy.size() / 100 - 1;
    std::nth_element(energy.begin(), energy.begin() + most, energy.end());
    return std::accumulate(energy.begin(), energy.begin() + most + 1, 0.0) /
           static_cast<double>(energy.size());
}

void SoundnessWatch::lookAtSpeeds(double gain)
{
    double fastest = 0.0;
    for (std::size_t n = 0; n < now_.size(); ++n) {
        const Vec3 v = now_.velocity[n].cast<double>();
        if (!now_.position[n].allFinite() || !v.allFinite() || !now_.spin[n].allFinite()) {
            ++notFinite_;
            continue;
        }
        fastest = std::max(fastest, v.norm());
        lowest_ = std::min(lowest_, heightEnergy(now_.position[n]));
    }
    const double allowed = gain * std::sqrt(2.0 * std::max(1e-12, startingEnergy_ - lowest_));
    fastestShare_ = std::max(fastestShare_, fastest / allowed);
}

void SoundnessWatch::lookAtEnergy(const Simulation& sand, const FrameReport& report)
{
    if (notFinite_ > 0 || report.time < lastEmission_ || report.heldBack > 0 ||
        report.ledger.exited > 0) {
        return;
    }
    double energy = report.kineticEnergy + sumElasticEnergy(now_, sand.plan().law, sand.solids());
    for (std::size_t n = 0; n < now_.size(); ++n) {
        energy += sphereMass(now_.radius[n], scene_.grains.density) * heightEnergy(now_.position[n]);
    }
    leastEnergy_ = energyKnown_ ? std::min(leastEnergy_, energy) : energy;
    energyKnown_ = true;
    energyRise_ = std::max(energyRise_, energy - leastEnergy_);
}

double SoundnessWatch::energyAtRest() const
{
    if (motion_.empty()) {
        return 0.0;
    }
    std::vector<double> sorted(motion_.begin(), motion_.end());
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    return sorted[sorted.size() / 2];
}

void SoundnessWatch::addChecks(std::vector<Check>& checks) const
{
    const auto count = [&](const char* measure, std::uint64_t number, const char* cause) {
        checks.push_back({measure, static_cast<double>(number), 0.5, "grains", Verdict::broke,
                          fmt::format("{} {}", number, cause), true});
    };
    count("grains without a place", notFinite_, "grains have a place or speed that is no number");
    count("grains in solids", inSolids_, "grains went into a solid");
    count("lost grains", lost_, "grains are missing");
    checks.push_back({"speed / speed of the fall", fastestShare_, kSpeedAllowance, "",
                      Verdict::broke,
                      fmt::format("a grain is {:.2f} times as fast as its fall allows",
                                  fastestShare_), true});
    const double grains = static_cast<double>(std::max<std::size_t>(1, now_.size()));
    const double rise = energyRise_ / (unitEnergy_ * grains);
    checks.push_back({"energy made", rise, kEnergyAllowance, "m g d", Verdict::broke,
                      fmt::format("{:.2g} m g d a grain of energy came from nowhere", rise), true});
    checks.push_back({"deepest overlap", deepestOverlap_,
                      std::min(kOverlapAllowance * scene_.contact.maxOverlap, 1.0), "r",
                      Verdict::broke,
                      fmt::format("grains overlap by {:.2f} r, contact.max_overlap = {:.2g}",
                                  deepestOverlap_, scene_.contact.maxOverlap), true});
}

void SoundnessWatch::addRestCheck(std::vector<Check>& checks) const
{
    const double motion = energyAtRest();
    checks.push_back({"motion at rest", motion, kRestLimit, "m g d", Verdict::jitters,
                      fmt::format("at the end grains still move with {:.2g} m g d each", motion)});
}

}  // namespace sandflow
