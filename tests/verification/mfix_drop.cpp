#include "dem/restitution.h"
#include "verification/contact_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// MFIX-DEM cases 1 and 2 (Garg et al. 2012, tests/dem/DEM01 and DEM02): a sphere of 0.1 m falls
/// from 0.5 m onto a floor, linear springs that may pull.
namespace sandflow::verification {
namespace {

constexpr double kRadius = 0.1, kDensity = 2600.0, kHeight = 0.5;
constexpr double kContactTolerance = 0.005;

struct Drop {
    double lowest = 0.0;    ///< m, height of the centre
    double duration = 0.0;  ///< s of the first contact
    double rebound = 0.0;   ///< m/s
};

double fallTime()
{
    return std::sqrt(2.0 * (kHeight - kRadius) / kGravity);
}

/// The closed form: an oscillator with weight, from first touch until y = R again.
class SpringContact {
public:
    SpringContact(double stiffness, double beta)
        : frequency_(std::sqrt(stiffness / makeBall(kRadius, kDensity).mass)),
          damped_(frequency_ * std::sqrt(1.0 - beta * beta)),
          decay_(beta * frequency_),
          sag_(kGravity / (frequency_ * frequency_)),
          // y - R + sag = exp(-decay t) (sag cos + slope sin)
          slope_((decay_ * sag_ - kGravity * fallTime()) / damped_)
    {
    }

    double height(double t) const
    {
        return kRadius - sag_
               + std::exp(-decay_ * t)
                     * (sag_ * std::cos(damped_ * t) + slope_ * std::sin(damped_ * t));
    }

    double speed(double t) const
    {
        return std::exp(-decay_ * t)
               * ((slope_ * damped_ - decay_ * sag_) * std::cos(damped_ * t)
                  - (sag_ * damped_ + decay_ * slope_) * std::sin(damped_ * t));
    }

    Drop solve() const
    {
        // The turn lies within half a period, the end within one.
        const double turn =
            bisect([&](double t) { return speed(t) > 0.0; }, 1e-9, kPi / damped_);
        const double end = bisect([&](double t) { return height(t) > kRadius; }, turn,
                                  turn + kPi / damped_);
        return {height(turn), end, speed(end)};
    }

private:
    template <class Reached>
    static double bisect(const Reached& reached, double low, double high)
    {
        for (int k = 0; k < 100; ++k) {
            const double middle = 0.5 * (low + high);
            (reached(middle) ? high : low) = middle;
        }
        return high;
    }

    double frequency_, damped_, decay_, sag_, slope_;
};

ContactBench makeDrop(const ContactCoefficients& law, const Stepping& stepping)
{
    Ball ball = makeBall(kRadius, kDensity);
    // The fall, too, may end at any part of a step.
    ball.position.z() = kHeight + stepping.phase * stepping.dt * kGravity * fallTime();
    return {law, {ball}, {makePlane(Vec3::Zero(), Vec3::UnitZ())}, Vec3(0.0, 0.0, -kGravity),
            stepping};
}

/// Time of first touch [s], speed then [m/s], and the contact.
std::vector<double> dropOnce(const ContactCoefficients& law, const Stepping& stepping)
{
    ContactBench bench = makeDrop(law, stepping);
    double above = 0.0;
    const auto stepOnce = [&] {
        above = bench.ball().position.z() - kRadius;
        bench.step();
        const double now = bench.ball().position.z() - kRadius;
        return stepping.dt * now / (now - above);  // since the surfaces were level, if they were
    };
    double since = 0.0;
    while (bench.ball().position.z() >= kRadius) {
        since = stepOnce();
    }
    const double touch = bench.time() - since;
    const double speed = -bench.ball().velocity.z();
    Drop drop{kRadius, 0.0, 0.0};
    while (bench.ball().position.z() < kRadius) {
        since = stepOnce();
        drop.lowest = std::min(drop.lowest, bench.ball().position.z());
    }
    drop.duration = bench.time() - since - touch;
    drop.rebound = bench.ball().velocity.z();
    return {touch, speed, kRadius - drop.lowest, drop.duration, drop.rebound};
}

double shippedStepOf(const ContactCoefficients& law)
{
    return shippingStep(law, makeBall(kRadius, kDensity), kGravity * fallTime());
}

std::vector<Verdict> dropOnFloor(const Settings&)
{
    constexpr double kFineStep = 5e-6;
    std::vector<Verdict> verdicts;
    for (const double stiffness : {1e4, 2.5e4, 5e4, 1e5}) {
        for (const double e : {0.6, 0.7, 0.8, 0.9, 1.0}) {
            const ContactCoefficients law = linearLaw(stiffness, e, false);
            const Drop drop = SpringContact(stiffness, law.damping).solve();
            const std::string name = fmt::format("k {:g}, e {:g}: ", stiffness, e);
            const std::vector<Expectation> expectations = {
                {name + "time of impact [s]", fallTime(), Gate::relative, kContactTolerance},
                {name + "speed of impact [m/s]", kGravity * fallTime(), Gate::relative,
                 kContactTolerance},
                {name + "peak overlap [m]", kRadius - drop.lowest, Gate::relative,
                 kContactTolerance},
                {name + "contact time [s]", drop.duration, Gate::relative, kContactTolerance},
                {name + "speed of rebound [m/s]", drop.rebound, Gate::relative,
                 kContactTolerance}};
            judge(
                expectations,
                [&](const Stepping& stepping) { return dropOnce(law, stepping); }, kFineStep,
                shippedStepOf(law), verdicts, 4);
        }
    }
    return verdicts;
}

/// Heights of the first bounces [m].
std::vector<double> bounce(const ContactCoefficients& law, int bounces, const Stepping& stepping)
{
    ContactBench bench = makeDrop(law, stepping);
    std::vector<double> apexes;
    bool rises = false;
    double highest = 0.0;
    while (static_cast<int>(apexes.size()) < bounces) {
        bench.step();
        const Ball& ball = bench.ball();
        if (rises && ball.velocity.z() <= 0.0) {
            apexes.push_back(highest);
        }
        rises = ball.velocity.z() > 0.0;
        highest = ball.position.z();
    }
    return apexes;
}

std::vector<Verdict> bounceOnFloor(const Settings&)
{
    constexpr double kDrift = 0.002;
    const auto fineStep = [](const ContactCoefficients& law) {
        const Ball ball = makeBall(kRadius, kDensity);
        return impactDuration(law, ball.mass, kRadius, 1.0) / 1000.0;
    };
    std::vector<Verdict> verdicts;
    for (const double stiffness : {5e4, 5e5, 5e6}) {
        const ContactCoefficients law = linearLaw(stiffness, 1.0, false);
        judge({{fmt::format("k {:g}, e 1: height of bounce 16 [m]", stiffness), kHeight,
                Gate::relative, kDrift}},
              [&](const Stepping& stepping) {
                  return std::vector<double>{bounce(law, 16, stepping).back()};
              },
              fineStep(law), shippedStepOf(law), verdicts, 1);
    }
    // Damped: each bounce by the closed form of a contact with weight; soft floors give back a
    // little less than e. Beside it the limit of a hard floor, h e^2.
    for (const double e : {0.9, 0.6}) {
        for (const double stiffness : {5e4, 5e6}) {
            const ContactCoefficients law = linearLaw(stiffness, e, false);
            const double rebound = SpringContact(stiffness, law.damping).solve().rebound;
            const double first = kRadius + rebound * rebound / (2.0 * kGravity);
            const std::string name = fmt::format("k {:g}, e {:g}: ", stiffness, e);
            const double third = kRadius + (kHeight - kRadius) * std::pow(e, 6);
            judge({{name + "height of bounce 1 [m]", first, Gate::relative, kDrift},
                   {name + "height of bounce 3, hard floor [m]", third, Gate::report}},
                  [&](const Stepping& stepping) {
                      const std::vector<double> apexes = bounce(law, 3, stepping);
                      return std::vector<double>{apexes[0], apexes[2]};
                  },
                  fineStep(law), shippedStepOf(law), verdicts, 4);
        }
    }
    return verdicts;
}

const Registration kDrop({"Mfix1", "MFIX-DEM case 1, Garg et al. 2012: drop on a floor", false,
                          dropOnFloor});
const Registration kBounce({"Mfix2", "MFIX-DEM case 2, Garg et al. 2012: bouncing", false,
                            bounceOnFloor});

}  // namespace
}  // namespace sandflow::verification
