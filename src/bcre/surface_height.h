#pragma once

#include "bcre/columns.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sandflow {

/// A grain that belongs to the accumulated sand (airborne and fast grains are left out by the
/// caller).
struct AccumulatedGrain {
    Vec3 position;   ///< m
    double radius;   ///< m
};

/// Measures H of every span by vertical rays. Keep one and use it again: then nothing is allocated
/// as long as the numbers of grains and columns do not grow.
class SurfaceHeightMeter {
public:
    /// H of a span: mean over a sub-grid of rays about 0.5 `diameter` [m] apart of the highest
    /// sphere cap met by the ray, the floor where it meets none; then smoothed: (1 - smoothing) of
    /// its own value + smoothing of the mean over its linked neighbours. A neighbour that lies
    /// wholly above the surface or below the floor (a ledge) counts with the span's own value.
    /// A grain counts for the span that holds its centre. Makes missing columns, with a margin of
    /// one around every grain. The result does not depend on the order of the grains nor on the
    /// number of threads.
    /// Throws PhysicsError if a grain is further than 1e9 columns away (or nowhere: NaN).
    void measure(std::span<const AccumulatedGrain> grains, double diameter, double smoothing,
                 ColumnGrid& columns);

private:
    void placeGrains(std::span<const AccumulatedGrain> grains, ColumnGrid& columns);
    bool findSlots(std::span<const AccumulatedGrain> grains, const ColumnGrid& columns);
    void countGrains(const ColumnGrid& columns);
    void makeMargins(ColumnGrid& columns);
    void makeMissing(ColumnGrid& columns);
    void sortGrains(std::span<const AccumulatedGrain> grains);
    void castRays(double diameter, ColumnGrid& columns);
    void collectNearby(std::int32_t slot, const ColumnGrid& columns,
                       std::vector<std::pair<std::int32_t, std::int32_t>>& nearby) const;
    double meanTop(std::int32_t span, int raysPerEdge, const ColumnGrid& columns,
                   const std::vector<std::pair<std::int32_t, std::int32_t>>& nearby,
                   std::vector<double>& tops) const;
    void smooth(double share, ColumnGrid& columns);

    /// What one thread needs while it casts rays.
    struct Scratch {
        std::vector<double> tops;                                   ///< m, highest so far per ray
        std::vector<std::pair<std::int32_t, std::int32_t>> nearby;  ///< ranges of sorted_
    };

    int reach_ = 1;                          ///< columns a grain can stretch to, each way
    std::vector<std::int32_t> slotOfGrain_;
    std::vector<std::int32_t> firstOfSlot_;  ///< counting sort: a column's first grain
    std::vector<AccumulatedGrain> sorted_;   ///< grains column by column
    std::vector<std::pair<std::int32_t, std::int32_t>> missing_;   ///< columns (j, i) to make
    std::vector<double> smoothed_;           ///< m
    std::vector<Scratch> scratch_;           ///< one per thread
};

/// The same for one use.
void measureSurfaceHeight(std::span<const AccumulatedGrain> grains, double diameter,
                          double smoothing, ColumnGrid& columns);

}  // namespace sandflow
