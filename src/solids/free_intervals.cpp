#include "solids/free_intervals.h"

#include <algorithm>

namespace sandflow {

namespace {

/// Thickness of plates, m: enough to part a column, far too little to be seen.
constexpr double kPlateThickness = 1e-6;

}  // namespace

void freeIntervals(const std::vector<Primitive>& primitives, double time, double x, double y,
                   double minGap, std::vector<std::pair<double, double>>& out)
{
    // Solid stretches first, in `out` itself: columns are made in bulk and need no other memory.
    out.clear();
    for (const Primitive& primitive : primitives) {
        if (!primitive.existsAt(time)) {
            continue;
        }
        const SolidInterval solid = solidIntervalAt(primitive, x, y, kPlateThickness);
        if (solid.lo < solid.hi) {
            out.emplace_back(solid.lo, solid.hi);
        }
    }
    std::sort(out.begin(), out.end());

    // Each gap between the top of all below and the next stretch is free. There is at most one gap
    // per stretch read, so writing never overtakes reading.
    double top = kNoFloor;
    std::size_t written = 0;
    for (std::size_t read = 0; read < out.size(); ++read) {
        const auto [lo, hi] = out[read];
        if (lo - top > minGap) {
            out[written++] = {top, lo};
        }
        top = std::max(top, hi);
    }
    out.resize(written);
    if (top < kOpenAbove) {
        out.emplace_back(top, kOpenAbove);
    }
}

}  // namespace sandflow
