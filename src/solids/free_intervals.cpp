#include "solids/free_intervals.h"

#include <algorithm>

namespace sandflow {

namespace {

/// Thickness of plates, m: enough to part a column, far too little to be seen.
constexpr double kPlateThickness = 1e-6;

}  // namespace

void appendSolidStretches(const std::vector<Primitive>& primitives, double time, double x, double y,
                          std::vector<std::pair<double, double>>& out)
{
    for (const Primitive& primitive : primitives) {
        if (!primitive.existsAt(time)) {
            continue;
        }
        const SolidInterval solid = solidIntervalAt(primitive, x, y, kPlateThickness);
        if (solid.lo < solid.hi) {
            out.emplace_back(solid.lo, solid.hi);
        }
    }
}

void keepGaps(double minGap, std::vector<std::pair<double, double>>& stretches)
{
    std::sort(stretches.begin(), stretches.end());
    // Each gap between the top of all below and the next stretch is free. There is at most one gap
    // per stretch read, so writing never overtakes reading.
    double top = kNoFloor;
    std::size_t written = 0;
    for (std::size_t read = 0; read < stretches.size(); ++read) {
        const auto [lo, hi] = stretches[read];
        if (lo - top > minGap) {
            stretches[written++] = {top, lo};
        }
        top = std::max(top, hi);
    }
    stretches.resize(written);
    if (top < kOpenAbove) {
        stretches.emplace_back(top, kOpenAbove);
    }
}

void freeIntervals(const std::vector<Primitive>& primitives, double time, double x, double y,
                   double minGap, std::vector<std::pair<double, double>>& out)
{
    // Solid stretches first, in `out` itself: columns are made in bulk and need no other memory.
    out.clear();
    appendSolidStretches(primitives, time, x, y, out);
    keepGaps(minGap, out);
}

}  // namespace sandflow
