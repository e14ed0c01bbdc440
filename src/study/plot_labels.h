#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sandflow {

/// A point of a plot with a text beside it; x and y in letters (widths and heights of one).
struct PlotLabel {
    double x = 0.0;
    double y = 0.0;
    std::string text;
    bool toTheLeft = false;  ///< of its point, not to the right
};

/// Which of the texts can be written without lying on another text or on another's point; those
/// that come first in the list have the first choice.
std::vector<bool> chooseLabels(std::span<const PlotLabel> labels);

}  // namespace sandflow
