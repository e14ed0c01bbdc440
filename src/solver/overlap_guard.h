#pragma once

#include "dem/dem.h"
#include "emit/emitter.h"
#include "solids/solid_set.h"

#include <vector>

namespace sandflow {

/// Lets a new grain in only where there is room: grains put into each other fly apart silently.
/// One routine for every place where grains come in.
template <class Real>
class OverlapGuard {
public:
    /// Deepest overlap that is let in, in radii of the smaller grain.
    static constexpr double kLimit = 0.05;

    /// Moves the grains of `waiting` that have room to `accepted` and keeps the others, in order.
    /// The first `retries` of them were turned away before: they may also be in each other's place
    /// and in that of the new ones, which come from one emitter at a time and are clear of each
    /// other.
    void admit(const Dem<Real>& dem, const SolidSet& solids, double time, std::size_t retries,
               std::vector<NewGrain>& waiting, std::vector<NewGrain>& accepted);

private:
    std::vector<Vec3> near_;
    std::vector<double> nearRadius_;
};

}  // namespace sandflow
