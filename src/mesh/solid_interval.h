#pragma once

namespace sandflow {

/// A vertical stretch [lo, hi], m, of a column that is inside a solid.
struct SolidInterval {
    double lo;
    double hi;
};

}  // namespace sandflow
