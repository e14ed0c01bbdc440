#pragma once

#include <vector>

namespace sandflow {

/// A vertical stretch [lo, hi], m, of a column that is inside a solid.
struct SolidInterval {
    double lo;
    double hi;
};

/// Removes stretches thinner than minThickness (m), such as folds and self-crossings of a scanned
/// surface leave behind. They ascend and do not overlap; those that touch are made one first.
void dropSlivers(double minThickness, std::vector<SolidInterval>& stretches);

}  // namespace sandflow
