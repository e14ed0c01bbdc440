#include "scene/repose_table.h"

#include "core/errors.h"
#include "core/find_root.h"
#include "core/quiet_gsl.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

constexpr ReposeMeasurement kMeasurements[] = {
#include "scene/repose_measurements.inc"
};

using Curve = std::function<double(double)>;

/// Ends of a curve that is linear between nodes.
Interval spanOf(const Curve& curve, const std::vector<double>& nodes)
{
    Interval span{curve(nodes.front()), curve(nodes.front())};
    for (const double node : nodes) {
        span.low = std::min(span.low, curve(node));
        span.high = std::max(span.high, curve(node));
    }
    return span;
}

/// The smallest x at which such a curve takes the value. Measured curves that have levelled out may
/// take it more than once.
std::optional<double> findFirst(const Curve& curve, const std::vector<double>& nodes, double value)
{
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double excess = curve(nodes[k]) - value;
        if (excess == 0.0) {
            return nodes[k];
        }
        if (k + 1 < nodes.size() && excess * (curve(nodes[k + 1]) - value) < 0.0) {
            return findRoot([&](double x) { return curve(x) - value; }, nodes[k], nodes[k + 1]);
        }
    }
    return std::nullopt;
}

}  // namespace

ReposeTable::ReposeTable(std::span<const ReposeMeasurement> rows)
    : interpolation_(nullptr, &gsl_interp2d_free)
{
    double squares = 0.0;
    double freedom = 0.0;
    for (const ReposeMeasurement& row : rows) {
        if (friction_.empty() || row.friction != friction_.back()) {
            friction_.push_back(row.friction);
        }
        if (friction_.size() == 1) {
            rolling_.push_back(row.rollingFriction);
        }
        SAND_CHECK(row.rollingFriction == rolling_[angle_.size() % rolling_.size()],
                   "the repose table is no grid at friction {}", row.friction);
        angle_.push_back(row.angle);
        squares += (row.heaps - 1) * row.scatter * row.scatter;
        freedom += row.heaps - 1;
    }
    SAND_CHECK(friction_.size() >= 2 && rolling_.size() >= 2 &&
                   angle_.size() == friction_.size() * rolling_.size() &&
                   std::is_sorted(friction_.begin(), friction_.end()) &&
                   std::is_sorted(rolling_.begin(), rolling_.end()),
               "the repose table is no grid of at least two by two");
    scatter_ = freedom > 0.0 ? std::sqrt(squares / freedom) : 0.0;

    const QuietGsl quiet;
    interpolation_.reset(
        gsl_interp2d_alloc(gsl_interp2d_bilinear, rolling_.size(), friction_.size()));
    SAND_CHECK(interpolation_ != nullptr, "no memory for an interpolation");
    const int code = gsl_interp2d_init(interpolation_.get(), rolling_.data(), friction_.data(),
                                       angle_.data(), rolling_.size(), friction_.size());
    SAND_CHECK(code == GSL_SUCCESS, "the repose table: {}", gsl_strerror(code));
}

bool ReposeTable::covers(double friction, double rollingFriction) const
{
    return frictions().contains(friction) && rollingFrictions().contains(rollingFriction);
}

double ReposeTable::angle(double friction, double rollingFriction) const
{
    const QuietGsl quiet;
    double angle = 0.0;
    const int code = gsl_interp2d_eval_e(
        interpolation_.get(), rolling_.data(), friction_.data(), angle_.data(),
        std::clamp(rollingFriction, rolling_.front(), rolling_.back()),
        std::clamp(friction, friction_.front(), friction_.back()), nullptr, nullptr, &angle);
    SAND_CHECK(code == GSL_SUCCESS, "no angle of repose for {} and {}: {}", friction,
               rollingFriction, gsl_strerror(code));
    return angle;
}

Interval ReposeTable::reachByRolling(double friction) const
{
    return spanOf([&](double rolling) { return angle(friction, rolling); }, rolling_);
}

std::optional<double> ReposeTable::rollingFrictionFor(double wanted, double friction) const
{
    return findFirst([&](double rolling) { return angle(friction, rolling); }, rolling_, wanted);
}

Interval ReposeTable::reachByFriction(double rollingFriction) const
{
    return spanOf([&](double friction) { return angle(friction, rollingFriction); }, friction_);
}

std::optional<double> ReposeTable::frictionFor(double wanted, double rollingFriction) const
{
    return findFirst([&](double friction) { return angle(friction, rollingFriction); }, friction_,
                     wanted);
}

const ReposeTable& measuredRepose()
{
    static const ReposeTable table(kMeasurements);
    return table;
}

std::span<const ReposeMeasurement> reposeMeasurements()
{
    return kMeasurements;
}

}  // namespace sandflow
