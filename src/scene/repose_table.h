#pragma once

#include <gsl/gsl_interp2d.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sandflow {

/// Heaps of one pair of coefficients, poured in full DEM (scripts/measure_repose.sh).
struct ReposeMeasurement {
    double friction;         ///< mu
    double rollingFriction;  ///< mu_r
    double angle;            ///< degrees, mean over the heaps
    double scatter;          ///< degrees, standard deviation over the heaps
    int heaps;               ///< that differ in their seed only
};

struct Interval {
    double low;
    double high;

    bool contains(double value) const { return value >= low && value <= high; }
};

/// Angle of repose over friction and rolling friction, linear between the measured pairs, and the
/// way back. Angles are in degrees.
class ReposeTable {
public:
    /// Rows must be a full grid, both coefficients ascending, rolling friction the faster one.
    explicit ReposeTable(std::span<const ReposeMeasurement> rows);

    /// What was measured. Beyond it nothing is known.
    Interval frictions() const { return {friction_.front(), friction_.back()}; }
    Interval rollingFrictions() const { return {rolling_.front(), rolling_.back()}; }
    bool covers(double friction, double rollingFriction) const;

    /// Beyond the table the angle of the nearest pair in it.
    double angle(double friction, double rollingFriction) const;

    /// By how much heaps of one kind differ: standard deviation, all pairs taken together.
    double scatter() const { return scatter_; }

    /// Angles that any rolling friction of the table gives with that friction, and the smallest
    /// rolling friction that gives the angle; none if it is out of reach.
    Interval reachByRolling(double friction) const;
    std::optional<double> rollingFrictionFor(double angle, double friction) const;

    /// The same with the two in each other's place.
    Interval reachByFriction(double rollingFriction) const;
    std::optional<double> frictionFor(double angle, double rollingFriction) const;

private:
    std::vector<double> friction_;
    std::vector<double> rolling_;
    std::vector<double> angle_;  ///< rolling friction fastest
    double scatter_ = 0.0;
    std::unique_ptr<gsl_interp2d, decltype(&gsl_interp2d_free)> interpolation_;
};

/// The table of this program's own heaps.
const ReposeTable& measuredRepose();

/// Its rows as they were measured.
std::span<const ReposeMeasurement> reposeMeasurements();

}  // namespace sandflow
