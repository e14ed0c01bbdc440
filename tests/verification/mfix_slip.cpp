#include "verification/contact_bench.h"

#include <fmt/format.h>

#include <cmath>

/// MFIX-DEM cases 4 and 5 (Garg et al. 2012, tests/dem/DEM04 and DEM05): slip that turns into
/// rolling, and oblique impacts against Kharaz, Gorham & Salman 2001.
namespace sandflow::verification {
namespace {

std::vector<Verdict> slipThenRoll(const Settings&)
{
    constexpr double kRadius = 0.5e-3, kDensity = 1e4, kSpeed = 0.1, kStiffness = 1e4;
    constexpr double kSpeedTolerance = 2e-4, kTimeTolerance = 6e-3;
    std::vector<Verdict> verdicts;
    for (const double friction : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        ContactCoefficients law = linearLaw(kStiffness, 0.5, true);
        law.friction = friction;
        law.tangentialRatio = 2.0 / 7.0;
        law.tangentialDamping = 0.2;
        Ball ball = makeBall(kRadius, kDensity);
        ball.position.z() = kRadius - ball.mass * kGravity / kStiffness;
        ball.velocity.x() = kSpeed;
        const double rollsAt = 2.0 * kSpeed / (7.0 * friction * kGravity);
        const std::string name = fmt::format("mu {:g}: ", friction);
        judge({{name + "speed halfway to rolling [m/s]",
                kSpeed - 0.5 * friction * kGravity * rollsAt, Gate::relative, kSpeedTolerance},
               {name + "R w halfway to rolling [m/s]", 1.25 * friction * kGravity * rollsAt,
                Gate::relative, kTimeTolerance},
               {name + "time when it rolls [s]", rollsAt, Gate::relative, kTimeTolerance},
               {name + "speed when rolling [m/s]", 5.0 / 7.0 * kSpeed, Gate::relative,
                kSpeedTolerance},
               {name + "R w when rolling [m/s]", 5.0 / 7.0 * kSpeed, Gate::relative,
                kTimeTolerance}},
              [&](const Stepping& stepping) {
                  // Whole steps to the middle of the slide.
                  const int half = static_cast<int>(std::ceil(0.5 * rollsAt / stepping.dt));
                  Stepping fitted = stepping;
                  fitted.dt = 0.5 * rollsAt / half;
                  ContactBench bench(law, {ball}, {makePlane(Vec3::Zero(), Vec3::UnitZ())},
                                     Vec3(0.0, 0.0, -kGravity), fitted);
                  std::vector<double> numbers;
                  double slipBefore = kSpeed;
                  double rolled = 0.0;
                  for (int k = 1; k <= 4 * half; ++k) {
                      bench.step();
                      const double speed = bench.ball().velocity.x();
                      const double surface = kRadius * bench.ball().spin.y();
                      if (k == half) {
                          numbers = {speed, surface};
                      }
                      // The slip reaches zero, or what the lever's shortness leaves of it.
                      const double slip = speed - surface;
                      if (rolled == 0.0 && slip < 1e-3 * kSpeed) {
                          rolled = bench.time()
                                   - fitted.dt * (1e-3 * kSpeed - slip) / (slipBefore - slip);
                      }
                      slipBefore = slip;
                  }
                  numbers.push_back(rolled);
                  numbers.push_back(bench.ball().velocity.x());
                  numbers.push_back(kRadius * bench.ball().spin.y());
                  return numbers;
              },
              1e-6, shippingStep(law, ball, kSpeed), verdicts, 1);
    }
    return verdicts;
}

std::vector<Verdict> hitGlass(const Settings&)
{
    // 5 mm spheres of aluminium oxide at 3.9 m/s, linear springs as MFIX runs it.
    constexpr double kRadius = 0.0025, kDensity = 4000.0, kSpeed = 3.9;
    constexpr double kTolerance = 0.05;  ///< of MFIX's own regression tests
    constexpr double kSpringTolerance = 0.03;
    ContactCoefficients law = linearLaw(1.72e7, 0.98, true);
    law.friction = 0.092;
    law.tangentialRatio = 1.48 / 1.72;
    law.tangentialDamping = 0.5;
    std::vector<Verdict> verdicts;
    const Ball resting = makeBall(kRadius, kDensity);
    const double fine = impactDuration(law, resting.mass, kRadius, kSpeed) / 1e4;
    const double shipped = shippingStep(law, resting, kSpeed);
    const auto hit = [&](double degrees, const Stepping& stepping) {
        const double angle = degrees * kPi / 180.0;
        Ball ball = resting;
        ball.position.z() = kRadius;
        ball.velocity = kSpeed * Vec3(std::sin(angle), 0.0, -std::cos(angle));
        return hitPlane(law, ball, stepping).after[0];
    };
    const auto judgeRestitution = [&](double degrees, double expected, const char* whose,
                                      Gate gate, double tolerance) {
        judge({{fmt::format("{} deg: tangential restitution, {}", degrees, whose), expected, gate,
                tolerance}},
              [&](const Stepping& stepping) {
                  return std::vector<double>{hit(degrees, stepping).velocity.x()
                                             / (kSpeed * std::sin(degrees * kPi / 180.0))};
              },
              fine, shipped, verdicts);
    };
    judgeRestitution(20.0, 0.596, "their springs", Gate::relative, kSpringTolerance);
    judgeRestitution(45.0, 0.816, "their springs", Gate::relative, kSpringTolerance);
    // Nearer to the normal the measurement is of speeds along the plate of 0.1 to 0.3 m/s, and the
    // published curves of spring models miss it too (0.948 at 5.2 degrees in Chung & Ooi's test 4).
    for (const auto& [degrees, measured] : {std::pair{2.0, .794}, std::pair{3.9, .745}}) {
        judgeRestitution(degrees, measured, "measured", Gate::report, 0.0);
    }
    for (const auto& [degrees, measured] :
         {std::pair{9.6, .673}, std::pair{20.1, .596},
          std::pair{30.2, .688}, std::pair{39.3, .772}, std::pair{49.5, .847},
          std::pair{59.8, .902}}) {
        judgeRestitution(degrees, measured, "measured", Gate::relative, kTolerance);
    }
    for (const auto& [degrees, measured] :
         {std::pair{6.0, 136.0}, std::pair{11.0, 265.0}, std::pair{21.0, 577.0},
          std::pair{31.0, 613.0}, std::pair{39.0, 595.0}, std::pair{50.0, 453.0},
          std::pair{60.0, 381.0}}) {
        judge({{fmt::format("{} deg: spin, measured [rad/s]", degrees), measured, Gate::report}},
              [&, d = degrees](const Stepping& stepping) {
                  return std::vector<double>{hit(d, stepping).spin.y()};
              },
              fine, shipped, verdicts);
    }
    for (const auto& [degrees, measured] :
         {std::pair{9.9, 6.7}, std::pair{20.6, 12.4}, std::pair{30.4, 21.8},
          std::pair{39.6, 32.5}, std::pair{49.8, 45.1}, std::pair{60.1, 57.4}}) {
        judge({{fmt::format("{} deg: rebound angle of the centre, measured [deg]", degrees),
                measured, Gate::relative, kTolerance}},
              [&, d = degrees](const Stepping& stepping) {
                  const Vec3 v = hit(d, stepping).velocity;
                  return std::vector<double>{std::atan2(v.x(), v.z()) * 180.0 / kPi};
              },
              fine, shipped, verdicts);
    }
    return verdicts;
}

const Registration kSlip({"Mfix4", "MFIX-DEM case 4, Garg et al. 2012: slip turns into rolling",
                          false, slipThenRoll});
const Registration kGlass({"Mfix5",
                           "MFIX-DEM case 5, Garg et al. 2012: oblique impact, Kharaz 2001", false,
                           hitGlass});

}  // namespace
}  // namespace sandflow::verification
