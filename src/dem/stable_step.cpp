#include "dem/stable_step.h"

#include "core/errors.h"
#include "dem/contact_law.h"

#include <cmath>
#include <limits>

namespace sandflow {

namespace {

NormalForce<double> evaluateStiffness(const ContactCoefficients& law, double overlap, double mass,
                                      double radius)
{
    const LawNumbers<double> numbers(law);
    switch (law.law) {
    case NormalLaw::linear:
        return evaluateNormal<NormalLaw::linear>(numbers, overlap, 0.0, mass, radius);
    case NormalLaw::hertz:
        return evaluateNormal<NormalLaw::hertz>(numbers, overlap, 0.0, mass, radius);
    case NormalLaw::bellYuMucha:
        return evaluateNormal<NormalLaw::bellYuMucha>(numbers, overlap, 0.0, mass, radius);
    }
    throw InternalError("unknown contact law");
}

}  // namespace

double boundSymplecticEuler(double frequencySquared, double damping)
{
    SAND_CHECK(frequencySquared >= 0.0 && damping >= 0.0, "w^2 {}, c {}", frequencySquared,
               damping);
    const double sum = damping + std::sqrt(damping * damping + 4.0 * frequencySquared);
    return sum > 0.0 ? 4.0 / sum : std::numeric_limits<double>::infinity();
}

ModeBounds boundModes(const ContactCoefficients& law, double mass, double radius, double overlap,
                      double coordination)
{
    SAND_CHECK(mass > 0.0 && radius > 0.0 && coordination > 0.0, "mass {}, radius {}, Z {}", mass,
               radius, coordination);
    SAND_CHECK(law.law == NormalLaw::linear || overlap > 0.0,
               "the stiffness of a contact of overlap {} is not defined", overlap);
    const double pairMass = 0.5 * mass;
    const double pairRadius = 0.5 * radius;
    const double inertia = 0.4 * mass * radius * radius;
    const double share = 2.0 * coordination / 3.0;

    const NormalForce<double> normal = evaluateStiffness(law, overlap, pairMass, pairRadius);
    const double kt = law.tangentialRatio * normal.tangentStiffness;
    const double ct = law.tangentialDamping * normal.dashpot;
    const double kr =
        law.rollingStiffness * normal.tangentStiffness * pairRadius * pairRadius;
    // 1/Ir = 2 / (I + m R^2)
    const double pairInertia = 0.5 * (inertia + mass * radius * radius);
    const double cr = 2.0 * law.rollingDamping * std::sqrt(pairInertia * kr);

    ModeBounds bounds;
    bounds.translation =
        boundSymplecticEuler(share * (normal.tangentStiffness + 2.0 * kt) / mass,
                             share * (normal.dashpot + 2.0 * ct) / mass);
    const double lever = 2.0 * share * radius * radius / inertia;
    bounds.rotation = boundSymplecticEuler(lever * kt, lever * ct);
    bounds.rolling =
        boundSymplecticEuler(2.0 * share * kr / inertia, 2.0 * share * cr / inertia);
    return bounds;
}

StepReport stableStep(const ContactCoefficients& law, const LoadCase& load, double overlap,
                      double safety, const std::optional<double>& given)
{
    SAND_CHECK(safety > 0.0 && safety <= 1.0, "safety {}", safety);
    SAND_CHECK(load.minRadius > 0.0 && load.density > 0.0, "radius {}, density {}",
               load.minRadius, load.density);
    // Among sizes the smallest grains bound the step: w^2 ~ k / m* and c ~ sqrt(k / m*), and both
    // are largest for two of the smallest.
    const double radius = load.minRadius;
    const double mass = 4.0 / 3.0 * kPi * radius * radius * radius * load.density;
    const ModeBounds modes = boundModes(law, mass, radius, overlap, kDenseCoordination);

    StepReport report;
    const auto consider = [&](double bound, const char* reason) {
        if (report.reason.empty() || bound < report.bound) {
            report.bound = bound;
            report.reason = reason;
        }
    };
    consider(modes.translation, "translation (springs and dashpots at 12 contacts)");
    consider(modes.rotation, "rotation (tangential springs and dashpots at 12 contacts)");
    consider(modes.rolling, "rolling (rolling springs and dashpots at 12 contacts)");
    if (load.fastestSpeed > 0.0) {
        consider(kTravelPerStep * radius / load.fastestSpeed, "fastest grain");
    }

    if (given) {
        if (!(*given > 0.0 && *given <= report.bound)) {
            throw InputError(fmt::format(
                "time.step = {:.3g} s must be above 0 and at most {:.3g} s, the bound set by: {}",
                *given, report.bound, report.reason));
        }
        report.step = *given;
        report.reason = "given";
        return report;
    }
    report.step = safety * report.bound;
    return report;
}

}  // namespace sandflow
