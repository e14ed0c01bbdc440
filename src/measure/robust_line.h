#pragma once

#include <optional>
#include <vector>

namespace sandflow {

/// y = intercept + slope x.
struct Line {
    double intercept = 0.0;
    double slope = 0.0;
};

/// Line through (x, y) by iterated least squares with Tukey's bisquare weights, which pay no heed
/// to outliers. Nothing for fewer than four points, or when they all share one x.
std::optional<Line> fitRobustLine(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace sandflow
