#pragma once

#include "grains/snapshot.h"
#include "solver/simulation.h"
#include "verification/verdict.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

/// What the bulk cases share: sand as scenes have it, runs, fits, and rows of both modes.
namespace sandflow::verification {

/// A scene without solids or emitters, with all defaults of scene files.
Scene makeSandScene(const std::string& name, Mode mode, std::uint64_t seed);

/// Runs to the end, calling `visit` after every frame.
std::unique_ptr<Simulation> runToEnd(
    const Scene& scene, const std::function<void(const Simulation&, const FrameReport&)>& visit);

Snapshot takeSnapshotOf(const Simulation& simulation);

/// Number of grains of mean size that fill `volume` [m3] at a solid fraction.
double countGrains(const Scene& scene, double volume, double solidFraction);

/// y = a x^b by least squares in logarithms.
struct PowerLaw {
    double prefactor = 0.0;
    double exponent = 0.0;
};
PowerLaw fitPowerLaw(const std::vector<double>& x, const std::vector<double>& y);

/// a of y = a x^exponent, the geometric mean over the points.
double fitPrefactor(const std::vector<double>& x, const std::vector<double>& y, double exponent);

double meanOf(const std::vector<double>& values);
/// Standard deviation of a single value; 0 for fewer than two.
double scatterOf(const std::vector<double>& values);

/// One number in both modes.
struct BothModes {
    double dem = 0.0;
    double surfaceFlow = 0.0;
};

/// "<quantity>, dem", "<quantity>, surface-flow", and "<quantity>, surface-flow:dem": how the
/// second differs from the first.
void addBoth(std::vector<Verdict>& rows, const std::string& quantity, double expected,
             const BothModes& ours, Gate gate, double tolerance = 0.0);

/// The same where the experiments leave a range: judged against its nearest point.
void addBothInRange(std::vector<Verdict>& rows, const std::string& quantity, double low,
                    double high, const BothModes& ours, double tolerance);

std::string nameOf(Mode mode);

/// Tells on standard error how far a case of minutes has come.
void tellProgress(const std::string& what);

}  // namespace sandflow::verification
