#include "verification/bulk_sand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sandflow::verification {

Scene makeSandScene(const std::string& name, Mode mode, std::uint64_t seed)
{
    Scene scene;
    scene.name = name;
    scene.mode = mode;
    scene.seed = seed;
    return scene;
}

std::unique_ptr<Simulation> runToEnd(
    const Scene& scene, const std::function<void(const Simulation&, const FrameReport&)>& visit)
{
    std::unique_ptr<Simulation> simulation = makeSimulation(scene);
    while (!simulation->finished()) {
        const FrameReport report = simulation->advanceFrame();
        visit(*simulation, report);
    }
    return simulation;
}

Snapshot takeSnapshotOf(const Simulation& simulation)
{
    Snapshot snapshot;
    simulation.takeSnapshot(snapshot);
    return snapshot;
}

double countGrains(const Scene& scene, double volume, double solidFraction)
{
    // Radii are uniform in r (1 +- s): the mean cube is r^3 (1 + s^2).
    const double r = scene.grains.radius, s = scene.grains.sizeSpread;
    return solidFraction * volume / (4.0 / 3.0 * kPi * r * r * r * (1.0 + s * s));
}

PowerLaw fitPowerLaw(const std::vector<double>& x, const std::vector<double>& y)
{
    const auto n = static_cast<double>(x.size());
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double u = std::log(x[k]), v = std::log(y[k]);
        sx += u, sy += v, sxx += u * u, sxy += u * v;
    }
    PowerLaw law;
    law.exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    law.prefactor = std::exp((sy - law.exponent * sx) / n);
    return law;
}

double fitPrefactor(const std::vector<double>& x, const std::vector<double>& y, double exponent)
{
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        sum += std::log(y[k]) - exponent * std::log(x[k]);
    }
    return std::exp(sum / static_cast<double>(x.size()));
}

double meanOf(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double v : values) {
        sum += v;
    }
    return sum / static_cast<double>(values.size());
}

double scatterOf(const std::vector<double>& values)
{
    if (values.size() < 2) {
        return 0.0;
    }
    const double mean = meanOf(values);
    double sum = 0.0;
    for (const double v : values) {
        sum += (v - mean) * (v - mean);
    }
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

void addBoth(std::vector<Verdict>& rows, const std::string& quantity, double expected,
             const BothModes& ours, Gate gate, double tolerance)
{
    rows.push_back({quantity + ", dem", expected, ours.dem, gate, tolerance});
    rows.push_back({quantity + ", surface-flow", expected, ours.surfaceFlow, gate, tolerance});
    rows.push_back({quantity + ", surface-flow:dem", ours.dem, ours.surfaceFlow, Gate::report});
}

void addBothInRange(std::vector<Verdict>& rows, const std::string& quantity, double low,
                    double high, const BothModes& ours, double tolerance)
{
    rows.push_back(
        {quantity + ", dem", std::clamp(ours.dem, low, high), ours.dem, Gate::relative, tolerance});
    rows.push_back({quantity + ", surface-flow", std::clamp(ours.surfaceFlow, low, high),
                    ours.surfaceFlow, Gate::relative, tolerance});
    rows.push_back({quantity + ", surface-flow:dem", ours.dem, ours.surfaceFlow, Gate::report});
}

std::string nameOf(Mode mode)
{
    return mode == Mode::dem ? "dem" : "surface-flow";
}

void tellProgress(const std::string& what)
{
    fmt::print(stderr, "    {}\n", what);
}

}  // namespace sandflow::verification
