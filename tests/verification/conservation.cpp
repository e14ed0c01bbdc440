#include "core/errors.h"
#include "dem/restitution.h"
#include "verification/contact_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// What no contact law may break: momentum of a pair left alone, and no energy from friction.
namespace sandflow::verification {
namespace {

struct NamedLaw {
    const char* name;
    ContactCoefficients law;
};

/// The three laws with friction and rolling resistance, for grains of 5 mm at 1 m/s.
std::vector<NamedLaw> makeLaws(double e, double friction)
{
    const Ball grain = makeBall(0.005, 2600.0);
    std::vector<NamedLaw> laws;
    for (const auto& [name, kind] :
         {std::pair{"linear", NormalLaw::linear}, std::pair{"Hertz", NormalLaw::hertz},
          std::pair{"Bell-Yu-Mucha", NormalLaw::bellYuMucha}}) {
        ContactCoefficients law;
        law.law = kind;
        law.stiffness = kind == NormalLaw::linear ? 1e4 : 1e8;
        law.damping = solveDamping(kind, true, e);
        if (kind == NormalLaw::bellYuMucha) {
            law.damping *= collisionLength(kind, law.stiffness, grain.mass, grain.radius, 1.0);
        }
        law.friction = friction;
        law.tangentialRatio = 2.0 / 7.0;
        law.tangentialDamping = 0.5;
        law.rollingFriction = 0.1;
        law.rollingStiffness = 2.25 * 0.1 * 0.1;
        law.rollingDamping = 0.3;
        laws.push_back({name, law});
    }
    return laws;
}

double stepOf(const ContactCoefficients& law, double share)
{
    const Ball grain = makeBall(0.005, 2600.0);
    return share * collisionLength(law.law, law.stiffness, grain.mass, grain.radius, 1.0);
}

std::vector<Verdict> keepMomentum(const Settings&)
{
    std::vector<Verdict> verdicts;
    for (const auto& [name, law] : makeLaws(0.3, 0.5)) {
        // Unlike in size and density, spinning, off each other's path.
        Ball a = makeBall(0.005, 2600.0);
        a.velocity = Vec3(1.0, 0.0, 0.0);
        Ball b = makeBall(0.0058, 5000.0);
        b.spin = Vec3(0.0, -25.0, 40.0);
        b.position = 0.0108 * Vec3(0.93, 0.35, -0.11).normalized();
        const auto total = [](const std::vector<Ball>& balls) {
            Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
            for (const Ball& ball : balls) {
                linear += ball.mass * ball.velocity;
                angular += ball.mass * ball.position.cross(ball.velocity)
                           + ball.inertia() * ball.spin;
            }
            return std::pair(linear, angular);
        };
        const auto before = total({a, b});
        judge({{fmt::format("{}: change of momentum, share", name), 1e-13, Gate::atMost},
               {fmt::format("{}: change of angular momentum, share", name), 1e-12, Gate::atMost},
               // That there was something to keep.
               {fmt::format("{}: change of speed [m/s]", name), 0.1, Gate::atLeast},
               {fmt::format("{}: change of spin [rad/s]", name), 1.0, Gate::atLeast}},
              [&, law = law](const Stepping& stepping) {
                  const Impact impact = hitEachOther(law, a, b, stepping);
                  const auto after = total(impact.after);
                  return std::vector<double>{
                      (after.first - before.first).norm() / before.first.norm(),
                      (after.second - before.second).norm() / before.second.norm(),
                      (impact.after[0].velocity - a.velocity).norm(),
                      (impact.after[0].spin - a.spin).norm()};
              },
              stepOf(law, 1e-3), shippingStep(law, a, 1.0), verdicts);
    }
    return verdicts;
}

/// Balls that touch the plane z = 0 at 1 m/s, from head-on to grazing, with forward and backward
/// spin, side by side.
std::vector<Ball> makeVolley()
{
    std::vector<Ball> volley;
    for (const double degrees : {0.0, 5.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9}) {
        for (const double spin : {-400.0, -100.0, 0.0, 100.0, 400.0}) {
            const double angle = degrees * kPi / 180.0;
            Ball ball = makeBall(0.005, 2600.0);
            ball.position = Vec3(0.0, 0.02 * static_cast<double>(volley.size()), ball.radius);
            ball.velocity = Vec3(std::sin(angle), 0.0, -std::cos(angle));
            ball.spin.y() = spin;
            volley.push_back(ball);
        }
    }
    return volley;
}

/// Largest relative rise of the kinetic energy over all those impacts.
double largestRise(const ContactCoefficients& law, const Stepping& stepping)
{
    constexpr double kLongest = 1.0;  ///< s, hundreds of impacts
    std::vector<Ball> volley = makeVolley();
    for (Ball& ball : volley) {
        ball.position -= stepping.phase * stepping.dt * ball.velocity;
    }
    ContactBench bench(law, volley, {makePlane(Vec3::Zero(), Vec3::UnitZ())}, Vec3::Zero(),
                       stepping);
    const auto hasParted = [](const Ball& ball) {
        return ball.velocity.z() >= 0.0 && ball.position.z() >= ball.radius;
    };
    do {
        bench.step();
        SAND_CHECK(bench.time() < kLongest, "an impact does not end");
    } while (!std::all_of(bench.balls().begin(), bench.balls().end(), hasParted));
    double rise = -1.0;
    for (std::size_t k = 0; k < volley.size(); ++k) {
        rise = std::max(rise, bench.ball(k).kineticEnergy() / volley[k].kineticEnergy() - 1.0);
    }
    return rise;
}

std::vector<Verdict> neverGainEnergy(const Settings&)
{
    std::vector<Verdict> verdicts;
    for (const double e : {0.05, 0.3, 0.8}) {
        for (const double friction : {0.1, 0.5}) {
            for (const auto& [name, law] : makeLaws(e, friction)) {
                // Over the tangential springs and dashpots that scenes may ask for.
                std::vector<double> worst{-1.0, -1.0};
                for (const double ratio : {0.1, 2.0 / 7.0, 0.82}) {
                    for (const double damping : {0.0, 0.2, 1.0}) {
                        ContactCoefficients varied = law;
                        varied.tangentialRatio = ratio;
                        varied.tangentialDamping = damping;
                        worst[0] = std::max(worst[0],
                                            largestRise(varied, {stepOf(law, 5e-3), 0.0, false}));
                        const double shipped =
                            shippingStep(varied, makeBall(0.005, 2600.0), 1.0);
                        worst[1] = std::max(worst[1], largestRise(varied, {shipped, 0.5, true}));
                    }
                }
                verdicts.push_back({fmt::format("{}, e {:g}, mu {:g}: largest rise, share", name, e,
                                                friction),
                                    0.0, worst[0], Gate::atMost, 0.0, worst[1]});
            }
        }
    }
    // Elastic and without dashpots nothing pays for an error of the integrator (linear: of second
    // order in the step), nor for the work that nobody does on Hertz' tangential spring when its
    // stiffness grows under a stretched spring (Elata & Berryman 1996): that is the law's own.
    for (const auto& [name, law] : makeLaws(1.0, 0.5)) {
        judge({{fmt::format("{}, e 1, mu 0.5: largest rise, share", name),
                law.law == NormalLaw::linear ? 1e-4 : 0.03, Gate::atMost}},
              [&, law = law](const Stepping& stepping) {
                  double worst = -1.0;
                  for (const double ratio : {0.1, 2.0 / 7.0, 0.82}) {
                      ContactCoefficients elastic = law;
                      elastic.tangentialRatio = ratio;
                      elastic.rollingDamping = 0.0;
                      worst = std::max(worst, largestRise(elastic, stepping));
                  }
                  return std::vector<double>{worst};
              },
              stepOf(law, 5e-3), shippingStep(law, makeBall(0.005, 2600.0), 1.0), verdicts, 2);
    }
    return verdicts;
}

const Registration kMomentum({"Momentum", "closed form: momentum of an isolated pair", false,
                              keepMomentum});
const Registration kEnergy({"ImpactEnergy",
                            "closed form: kinetic energy never rises in a frictional impact", false,
                            neverGainEnergy});

}  // namespace
}  // namespace sandflow::verification
