#include "dem/contact_coefficients.h"

#include "core/errors.h"
#include "dem/restitution.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

/// Share of the rolling spring's critical damping. It only quiets the spring: the torque of a
/// rolling grain is the plastic cap, at which the dashpot is off.
constexpr double kRollingDamping = 0.3;

/// Ai et al. 2011, model C: kr = 2.25 kn mu_r^2 R*^2 for spheres.
constexpr double kRollingStiffness = 2.25;

/// Solid fraction of poured sand, for the weight of a column.
constexpr double kSolidFraction = 0.6;

/// Contact forces in a pile vary: their distribution falls as exp(-1.5 F / mean) (Mueth et al.
/// 1998), so one contact in a hundred carries three times the mean and more.
constexpr double kForceChains = 3.0;

/// On a recommended stiffness, so that it still suffices when printed with three digits.
constexpr double kSpare = 1.006;

double sphereMass(double radius, double density)
{
    return 4.0 / 3.0 * kPi * radius * radius * radius * density;
}

/// The law and what a grain must stand, in the terms of the two predictions.
struct Prediction {
    NormalLaw law;
    double smallestRadius;  ///< m, unit of the reported overlaps
    double mass;            ///< kg, largest grain against a fixed one of its size: m* = m
    double effectiveRadius; ///< m, of that pair: R* = r / 2
    double speed;           ///< m/s at impact
    double peak;            ///< overlap at the turn, in units of collisionLength
    double weight;          ///< N on the lowest contact

    double impactOverlap(double stiffness) const
    {
        return speed > 0.0 ? peak * collisionLength(law, stiffness, mass, effectiveRadius, speed)
                                 / smallestRadius
                           : 0.0;
    }

    double loadOverlap(double stiffness) const
    {
        const double overlap =
            law == NormalLaw::linear
                ? weight / stiffness
                : std::pow(weight / (stiffness * std::sqrt(effectiveRadius)), 2.0 / 3.0);
        return overlap / smallestRadius;
    }

    /// The stiffness at which the larger of the two is just `limit` [r]. Both overlaps are powers
    /// of the stiffness: k^-1/2 and k^-1 (linear), K^-2/5 and K^-2/3.
    double sufficientStiffness(double limit) const
    {
        const bool linear = law == NormalLaw::linear;
        const double impact = std::pow(impactOverlap(1.0) / limit, linear ? 2.0 : 2.5);
        const double rest = std::pow(loadOverlap(1.0) / limit, linear ? 1.0 : 1.5);
        return std::max(impact, rest);
    }
};

/// Bell-Yu-Mucha restitution falls with speed; it is made right at half the fastest speed.
double referenceSpeed(const LoadCase& load)
{
    return 0.5 * load.fastestSpeed;
}

/// The dashpot of Bell-Yu-Mucha in its own units, D V / L, for a collision other than the one it
/// was solved for. L ~ (m* V^2 / (K sqrt(R*)))^0.4, so K drops out of the ratio.
double carryDamping(double damping, double massRatio, double radiusRatio, double speedRatio)
{
    return damping * std::pow(speedRatio, 0.2) * std::pow(radiusRatio, 0.2)
           / std::pow(massRatio, 0.4);
}

Prediction predictOverlaps(const Scene& scene, const LoadCase& load, double damping)
{
    const double radius = load.maxRadius;
    Prediction prediction{};
    prediction.law = scene.contact.law;
    prediction.smallestRadius = load.minRadius;
    prediction.mass = sphereMass(radius, load.density);
    prediction.effectiveRadius = 0.5 * radius;
    prediction.speed = load.fastestSpeed;

    double impactDamping = damping;
    if (scene.contact.law == NormalLaw::bellYuMucha && load.fastestSpeed > 0.0) {
        const double pairMass = 0.5 * sphereMass(scene.grains.radius, load.density);
        impactDamping = carryDamping(damping, prediction.mass / pairMass,
                                     radius / scene.grains.radius,
                                     load.fastestSpeed / referenceSpeed(load));
    }
    prediction.peak =
        integrateCollision(scene.contact.law, scene.contact.clipAttraction, impactDamping)
            .peakOverlap;

    // A grain carries the sand above its own square d x d, and at least itself.
    const double depth = std::max(load.deepestColumn, 2.0 * radius);
    const double column = kSolidFraction * load.density * load.gravity * depth;
    prediction.weight = kForceChains * column * (2.0 * radius) * (2.0 * radius);
    return prediction;
}

/// Young's modulus [Pa] of one grain from K = (4/3) E* of a pair, 1/E* = 2 (1 - nu^2) / E.
double youngFromPair(double stiffness, double poisson)
{
    return 1.5 * stiffness * (1.0 - poisson * poisson);
}

double pairFromYoung(double young, double poisson)
{
    return young / (1.5 * (1.0 - poisson * poisson));
}

/// The collision of a pair and the length it is measured in.
struct PairCollision {
    Collision collision;
    double length;
};

PairCollision integratePair(const ContactCoefficients& law, double effectiveMass,
                            double effectiveRadius, double speed)
{
    const double scale =
        collisionLength(law.law, law.stiffness, effectiveMass, effectiveRadius, speed);
    const double damping = law.law == NormalLaw::bellYuMucha ? law.damping * speed / scale
                                                             : law.damping;
    return {integrateCollision(law.law, law.clipAttraction, damping), scale};
}

void checkInput(const Scene& scene, const LoadCase& load)
{
    const ContactSpec& contact = scene.contact;
    SAND_CHECK(load.minRadius > 0.0 && load.maxRadius >= load.minRadius && load.density > 0.0,
               "radii {} to {}, density {}", load.minRadius, load.maxRadius, load.density);
    SAND_CHECK(load.fastestSpeed >= 0.0 && load.deepestColumn >= 0.0 && load.gravity >= 0.0,
               "speed {}, column {}, gravity {}", load.fastestSpeed, load.deepestColumn,
               load.gravity);
    const auto refuse = [](bool wrong, const char* key, double value, const char* range) {
        if (wrong) {
            throw InputError(fmt::format("contact.{} = {} must be {}", key, value, range));
        }
    };
    const double nu = contact.poissonRatio;
    refuse(!(contact.maxOverlap > 0.0), "max_overlap", contact.maxOverlap, "above 0");
    refuse(!(nu > -1.0 && nu <= 0.5), "poisson_ratio", nu, "above -1 and at most 0.5");
    refuse(!(contact.friction >= 0.0), "friction", contact.friction, "0 or more");
    refuse(!(contact.rollingFriction >= 0.0), "rolling_friction", contact.rollingFriction,
           "0 or more");
    refuse(!(contact.tangentialRatio >= 0.0), "tangential_ratio", contact.tangentialRatio,
           "0 or more");
    refuse(!(contact.tangentialDamping >= 0.0), "tangential_damping", contact.tangentialDamping,
           "0 or more");
    refuse(contact.stiffness && !(*contact.stiffness > 0.0), "stiffness",
           contact.stiffness.value_or(0.0), "above 0");
    refuse(contact.youngModulus && !(*contact.youngModulus > 0.0), "young_modulus",
           contact.youngModulus.value_or(0.0), "above 0");
}

}  // namespace

ContactCoefficients makeContactCoefficients(const Scene& scene, const LoadCase& load,
                                            StiffnessReport& report)
{
    checkInput(scene, load);
    const ContactSpec& contact = scene.contact;
    const bool linear = contact.law == NormalLaw::linear;
    const double nu = contact.poissonRatio;

    ContactCoefficients law;
    law.law = contact.law;
    law.clipAttraction = contact.clipAttraction;
    law.friction = contact.friction;
    law.tangentialDamping = contact.tangentialDamping;
    law.rollingFriction = contact.rollingFriction;
    law.rollingStiffness =
        kRollingStiffness * contact.rollingFriction * contact.rollingFriction;
    law.rollingDamping = contact.rollingFriction > 0.0 ? kRollingDamping : 0.0;
    // Hertz: kt / kn of Mindlin for equal materials; the others take the scene's ratio.
    law.tangentialRatio = contact.law == NormalLaw::hertz ? 2.0 * (1.0 - nu) / (2.0 - nu)
                                                          : contact.tangentialRatio;

    const double damping =
        solveDamping(contact.law, contact.clipAttraction, contact.restitution);
    const Prediction prediction = predictOverlaps(scene, load, damping);
    const double sufficient = prediction.sufficientStiffness(contact.maxOverlap);
    const std::optional<double>& given = linear ? contact.stiffness : contact.youngModulus;
    const char* key = linear ? "contact.stiffness" : "contact.young_modulus";
    const char* unit = linear ? "N/m" : "Pa";

    report.automatic = !given;
    if (given) {
        law.stiffness = linear ? *given : pairFromYoung(*given, nu);
    } else {
        if (!(sufficient > 0.0)) {
            throw InputError(fmt::format(
                "nothing falls or moves, so no stiffness can be derived: give {}", key));
        }
        law.stiffness = sufficient;
    }
    report.impactOverlap = prediction.impactOverlap(law.stiffness);
    report.loadOverlap = prediction.loadOverlap(law.stiffness);
    const bool impactRules = report.impactOverlap >= report.loadOverlap;
    const std::string cause =
        impactRules ? fmt::format("a grain hitting a fixed one at {:.3g} m/s",
                                  load.fastestSpeed)
                    : fmt::format("a grain under {:.3g} m of sand", load.deepestColumn);
    const double deepest = std::max(report.impactOverlap, report.loadOverlap);
    const double shown = linear ? law.stiffness : youngFromPair(law.stiffness, nu);

    // The smallest stiffness is found by powers and roots; allow for their rounding.
    if (deepest > contact.maxOverlap * (1.0 + 1e-9)) {
        throw InputError(fmt::format(
            "{} = {:.3g} {} lets {} overlap by {:.2g} r (contact.max_overlap = {:.2g}): at least "
            "{:.3g} {} is needed",
            key, shown, unit, cause, deepest, contact.maxOverlap,
            kSpare * (linear ? sufficient : youngFromPair(sufficient, nu)), unit));
    }
    report.reason = fmt::format("{} = {:.3g} {}{}: {} overlaps by {:.2g} r", key, shown, unit,
                                given ? " (given)" : " (auto)", cause, deepest);

    law.damping = damping;
    if (contact.law == NormalLaw::bellYuMucha) {
        // D = b L / V of a pair of mean grains at the reference speed; with nothing moving, at the
        // speed of a fall through one diameter.
        const double radius = scene.grains.radius;
        const double speed = load.fastestSpeed > 0.0
                                 ? referenceSpeed(load)
                                 : std::sqrt(4.0 * std::max(load.gravity, 1e-3) * radius);
        law.damping = damping
                      * collisionLength(contact.law, law.stiffness,
                                        0.5 * sphereMass(radius, load.density), 0.5 * radius,
                                        speed)
                      / speed;
    }
    return law;
}

double integrateRestitution(const ContactCoefficients& law, double effectiveMass,
                            double effectiveRadius, double speed)
{
    return integratePair(law, effectiveMass, effectiveRadius, speed).collision.restitution;
}

double integratePeakOverlap(const ContactCoefficients& law, double effectiveMass,
                            double effectiveRadius, double speed)
{
    const PairCollision pair = integratePair(law, effectiveMass, effectiveRadius, speed);
    return pair.collision.peakOverlap * pair.length;
}

}  // namespace sandflow
