#include "verification/contact_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

/// MFIX-DEM case 3 (Garg et al. 2012, tests/dem/DEM03): two spheres pressed between floor and
/// ceiling, linear springs that may pull.
namespace sandflow::verification {
namespace {

constexpr double kRadius = 0.5e-3, kBox = 1.8e-3, kStiffness = 1000.0;
constexpr double kLower = 0.45e-3, kUpper = 1.35e-3;
constexpr double kEnd = 1e-3;  ///< s
constexpr double kTolerance = 1e-4;

Ball makeLower()
{
    Ball ball = makeBall(kRadius, 20000.0);
    ball.position.z() = kLower;
    return ball;
}

Ball makeUpper()
{
    Ball ball = makeBall(kRadius, 10000.0);
    ball.position.z() = kUpper;
    return ball;
}

/// Heights and speeds of both.
using State = std::array<double, 4>;

/// The two masses with three springs, by classical Runge-Kutta.
class Reference {
public:
    explicit Reference(double beta) : beta_(beta) {}

    State advance(const State& y, double h) const
    {
        const State a = rate(y);
        const State b = rate(add(y, a, 0.5 * h));
        const State c = rate(add(y, b, 0.5 * h));
        const State d = rate(add(y, c, h));
        State next = y;
        for (int k = 0; k < 4; ++k) {
            next[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
        }
        return next;
    }

private:
    static State add(const State& y, const State& slope, double h)
    {
        State sum = y;
        for (int k = 0; k < 4; ++k) {
            sum[k] += h * slope[k];
        }
        return sum;
    }

    double push(double overlap, double closing, double effectiveMass) const
    {
        const double dashpot = 2.0 * beta_ * std::sqrt(effectiveMass * kStiffness);
        return overlap > 0.0 ? kStiffness * overlap + dashpot * closing : 0.0;
    }

    State rate(const State& y) const
    {
        const double pair = mass_[0] * mass_[1] / (mass_[0] + mass_[1]);
        const double floor = push(kRadius - y[0], -y[2], mass_[0]);
        const double ceiling = push(y[1] + kRadius - kBox, y[3], mass_[1]);
        const double between = push(2.0 * kRadius - (y[1] - y[0]), y[2] - y[3], pair);
        return {y[2], y[3], (floor - between) / mass_[0] - kGravity,
                (between - ceiling) / mass_[1] - kGravity};
    }

    double beta_;
    std::array<double, 2> mass_{makeLower().mass, makeUpper().mass};
};

ContactBench makeStack(const ContactCoefficients& law, const Stepping& stepping)
{
    return {law,
            {makeLower(), makeUpper()},
            {makePlane(Vec3::Zero(), Vec3::UnitZ()),
             makePlane(Vec3(0.0, 0.0, kBox), -Vec3::UnitZ())},
            Vec3(0.0, 0.0, -kGravity),
            stepping};
}

double energyOf(const ContactBench& bench)
{
    double energy = 0.0;
    for (const Ball& ball : bench.balls()) {
        energy += ball.kineticEnergy() + ball.mass * kGravity * ball.position.z();
    }
    const double lower = bench.ball(0).position.z();
    const double upper = bench.ball(1).position.z();
    for (const double overlap :
         {kRadius - lower, upper + kRadius - kBox, 2.0 * kRadius - (upper - lower)}) {
        energy += overlap > 0.0 ? 0.5 * kStiffness * overlap * overlap : 0.0;
    }
    return energy;
}

std::vector<Verdict> pressTwoSpheres(const Settings&)
{
    constexpr double kFineStep = 1e-8;
    std::vector<Verdict> verdicts;
    const ContactCoefficients elastic = linearLaw(kStiffness, 1.0, false);

    // The published heights, mm.
    std::vector<Expectation> published;
    for (const auto& [time, lower, upper] :
         {std::array{0.1, .43267, 1.38139}, std::array{0.5, .43624, 1.37914},
          std::array{1.0, .42713, 1.38355}}) {
        published.push_back({fmt::format("e 1, {} ms: lower sphere [mm]", time), lower,
                             Gate::relative, kTolerance});
        published.push_back({fmt::format("e 1, {} ms: upper sphere [mm]", time), upper,
                             Gate::relative, kTolerance});
    }
    const double shipped = shippingStep(elastic, makeUpper(), 1.0);
    judge(
        published,
        [&](const Stepping& stepping) {
            std::vector<double> heights;
            for (const double time : {0.1e-3, 0.5e-3, 1e-3}) {
                // Whole steps to each of the times.
                const double count = std::ceil(time / stepping.dt - 1e-9);
                Stepping fitted = stepping;
                fitted.dt = time / count;
                ContactBench bench = makeStack(elastic, fitted);
                for (int k = 0; k < static_cast<int>(count); ++k) {
                    bench.step();
                }
                heights.push_back(1e3 * bench.ball(0).position.z());
                heights.push_back(1e3 * bench.ball(1).position.z());
            }
            return heights;
        },
        kFineStep, shipped, verdicts, 1);

    // Against the reference at all times.
    for (const double e : {1.0, 0.9, 0.8, 0.7, 0.6, 0.5}) {
        const ContactCoefficients law = linearLaw(kStiffness, e, false);
        judge({{fmt::format("e {}: farthest from Runge-Kutta in 1 ms, share", e), kTolerance,
                Gate::atMost}},
              [&](const Stepping& stepping) {
                  ContactBench bench = makeStack(law, stepping);
                  const Reference reference(law.damping);
                  // Well below its own error at the bench's shipped step too.
                  const int finer = std::max(1, static_cast<int>(stepping.dt / kFineStep));
                  State y{kLower, kUpper, 0.0, 0.0};
                  double worst = 0.0;
                  while (bench.time() < kEnd) {
                      bench.step();
                      for (int k = 0; k < finer; ++k) {
                          y = reference.advance(y, stepping.dt / finer);
                      }
                      for (int k = 0; k < 2; ++k) {
                          worst = std::max(worst,
                                           std::abs(bench.ball(k).position.z() / y[k] - 1.0));
                      }
                  }
                  return std::vector<double>{worst};
              },
              kFineStep, shippingStep(law, makeUpper(), 1.0), verdicts, 1);
    }

    judge({{"e 1: total energy in 1 ms, largest relative change", kTolerance, Gate::atMost}},
          [&](const Stepping& stepping) {
              ContactBench bench = makeStack(elastic, stepping);
              const double before = energyOf(bench);
              double worst = 0.0;
              while (bench.time() < kEnd) {
                  bench.step();
                  worst = std::max(worst, std::abs(energyOf(bench) / before - 1.0));
              }
              return std::vector<double>{worst};
          },
          kFineStep, shipped, verdicts, 1);
    return verdicts;
}

const Registration kStack({"Mfix3", "MFIX-DEM case 3, Garg et al. 2012: two spheres pressed", false,
                           pressTwoSpheres});

}  // namespace
}  // namespace sandflow::verification
