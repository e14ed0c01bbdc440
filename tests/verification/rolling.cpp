#include "verification/contact_bench.h"

#include <fmt/format.h>

#include <cmath>

/// Rolling on a plane, closed forms (LAMMPS, unittest/granular). The plane stays level and gravity
/// leans. The lever is R less the resting overlap, some 1e-4 of R.
namespace sandflow::verification {
namespace {

constexpr double kTolerance = 0.005;
constexpr double kRadius = 0.005, kDensity = 2600.0, kStiffness = 3e3;

ContactCoefficients rollingLaw(double friction, double rollingFriction)
{
    ContactCoefficients law = linearLaw(kStiffness, 0.3, true);
    law.friction = friction;
    law.tangentialRatio = 2.0 / 7.0;
    law.tangentialDamping = 0.5;
    law.rollingFriction = rollingFriction;
    law.rollingStiffness = 2.25 * rollingFriction * rollingFriction;
    law.rollingDamping = rollingFriction > 0.0 ? 0.3 : 0.0;
    return law;
}

Ball layOnPlane(double normalGravity)
{
    Ball ball = makeBall(kRadius, kDensity);
    ball.position.z() = kRadius - ball.mass * normalGravity / kStiffness;
    return ball;
}

std::vector<Verdict> spinDown(const Settings&)
{
    // Nothing but the torque mu_r R N: omega = omega0 - (5/2) mu_r g t / R.
    constexpr double kSpin = 100.0, kTime = 0.1;
    std::vector<Verdict> verdicts;
    for (const double rollingFriction : {0.05, 0.1}) {
        const ContactCoefficients law = rollingLaw(0.0, rollingFriction);
        const double rate = 2.5 * rollingFriction * kGravity / kRadius;
        Ball ball = layOnPlane(kGravity);
        ball.spin.y() = kSpin;
        const std::string name = fmt::format("mu_r {:g}: ", rollingFriction);
        judge({{name + "spin lost in 0.1 s [rad/s]", rate * kTime, Gate::relative, kTolerance},
               {name + "spin after 1 s [rad/s]", 0.0, Gate::absolute, 1e-3 * kSpin},
               {name + "speed after 1 s [m/s]", 0.0, Gate::absolute, 1e-12}},
              [&](const Stepping& stepping) {
                  ContactBench bench(law, {ball}, {makePlane(Vec3::Zero(), Vec3::UnitZ())},
                                     Vec3(0.0, 0.0, -kGravity), stepping);
                  while (bench.time() < kTime) {
                      bench.step();
                  }
                  const double lost = (kSpin - bench.ball().spin.y()) * kTime / bench.time();
                  while (bench.time() < 10.0 * kTime) {
                      bench.step();
                  }
                  return std::vector<double>{lost, bench.ball().spin.y(),
                                             bench.ball().velocity.x()};
              },
              1e-5, shippingStep(law, ball, 0.1), verdicts, 1);
    }
    return verdicts;
}

/// What a ball gains on an incline from rest, per second; from 0.1 to 0.2 s, for the springs load
/// before.
struct Descent {
    double speed, surfaceSpeed;  ///< m/s2
    double way;                  ///< m in all
};

Descent descend(const ContactCoefficients& law, double tangent, const Stepping& stepping)
{
    const double angle = std::atan(tangent);
    const Vec3 gravity = kGravity * Vec3(std::sin(angle), 0.0, -std::cos(angle));
    ContactBench bench(law, {layOnPlane(-gravity.z())}, {makePlane(Vec3::Zero(), Vec3::UnitZ())},
                       gravity, stepping);
    while (bench.time() < 0.1) {
        bench.step();
    }
    const Ball half = bench.ball();
    const double since = bench.time();
    while (bench.time() < 0.2) {
        bench.step();
    }
    const Ball& ball = bench.ball();
    const double time = bench.time() - since;
    return {(ball.velocity.x() - half.velocity.x()) / time,
            kRadius * (ball.spin.y() - half.spin.y()) / time, ball.position.x()};
}

std::vector<Verdict> rollDownIncline(const Settings&)
{
    constexpr double kFineStep = 1e-5;
    std::vector<Verdict> verdicts;
    const auto judgeDescent = [&](const ContactCoefficients& law, double tangent, double speed,
                                  double surface, const std::string& name) {
        judge({{name + "acceleration [m/s2]", speed, Gate::relative, kTolerance},
               {name + "R dw/dt [m/s2]", surface, Gate::relative, kTolerance}},
              [&](const Stepping& stepping) {
                  const Descent down = descend(law, tangent, stepping);
                  return std::vector<double>{down.speed, down.surfaceSpeed};
              },
              kFineStep, shippingStep(law, layOnPlane(kGravity), 1.0), verdicts, 1);
    };
    // Without rolling friction: it rolls up to tan = 3.5 mu, and slips beyond.
    constexpr double kFriction = 0.3;
    for (const double tangent : {0.1, 0.5, 1.0, 1.2, 2.0}) {
        const double angle = std::atan(tangent);
        const bool rolls = tangent <= 3.5 * kFriction;
        const double speed =
            rolls ? 5.0 / 7.0 * kGravity * std::sin(angle)
                  : kGravity * (std::sin(angle) - kFriction * std::cos(angle));
        const double surface = rolls ? speed : 2.5 * kFriction * kGravity * std::cos(angle);
        judgeDescent(rollingLaw(kFriction, 0.0), tangent, speed, surface,
                     fmt::format("mu 0.3, tan {:g}: ", tangent));
    }
    // With it: (5/7) g (sin - mu_r cos).
    constexpr double kRolling = 0.1;
    for (const double tangent : {0.2, 0.4}) {
        const double angle = std::atan(tangent);
        const double speed =
            5.0 / 7.0 * kGravity * (std::sin(angle) - kRolling * std::cos(angle));
        judgeDescent(rollingLaw(0.5, kRolling), tangent, speed, speed,
                     fmt::format("mu_r 0.1, tan {:g}: ", tangent));
    }
    // Below tan = mu_r it only leans on its rolling spring: at most as far as that is elastic,
    // mu_r m g / (2.25 mu_r^2 k), and twice that in swinging.
    const ContactCoefficients law = rollingLaw(0.5, kRolling);
    const double elastic =
        makeBall(kRadius, kDensity).mass * kGravity / (2.25 * kRolling * kStiffness);
    for (const double tangent : {0.05, 0.08}) {
        judge({{fmt::format("mu_r 0.1, tan {:g}: way in 0.2 s [m]", tangent), 2.0 * elastic,
                Gate::atMost}},
              [&](const Stepping& stepping) {
                  return std::vector<double>{descend(law, tangent, stepping).way};
              },
              kFineStep, shippingStep(law, layOnPlane(kGravity), 1.0), verdicts, 1);
    }
    return verdicts;
}

const Registration kSpinDown({"SpinDown", "closed form, LAMMPS unittest/granular: rolling friction",
                              false, spinDown});
const Registration kIncline({"Incline",
                             "closed forms, LAMMPS unittest/granular: ball on an incline", false,
                             rollDownIncline});

}  // namespace
}  // namespace sandflow::verification
