#pragma once

#include "grains/snapshot.h"
#include "measure/floor.h"

#include <optional>

namespace sandflow {

/// What became of sand that was set free all at once. A frozen heap that is a real state hardly
/// moves; d is the mean grain diameter.
struct ReleaseFigures {
    double seconds = 0.0;               ///< s simulated since
    double apexMoved = 0.0;             ///< d, change of the heap's apex; a fall is negative
    double meanHeightChange = 0.0;      ///< d, mean |dH| on cells 5 d wide (see compare.h)
    std::optional<double> reposeMoved;  ///< deg; none unless the heap has an angle before and after
    /// Fastest grain and what falling could make of the fastest, both at the moment where the one
    /// came closest to the other or went farthest beyond; m/s.
    double fastest = 0.0;
    double couldFall = 0.0;
};

/// Follows sand after its release.
class ReleaseWatch {
public:
    /// `before`: at the release; the floor is that of the scene then. `gravity` [m/s2].
    ReleaseWatch(Snapshot before, FloorHeight floor, double gravity);

    /// Looks at a later moment: no grain may then be faster than the fastest before became by
    /// falling freely all the time, nor than it would be after a fall from the top of the sand to
    /// the lowest grain: min(v0 + g t, sqrt(v0^2 + 2 g height)).
    void look(const Snapshot& now);

    /// The figures, as of the last look.
    ReleaseFigures figures(const Snapshot& last) const;

private:
    Snapshot before_;
    FloorHeight floor_;
    double gravity_;
    double top_ = 0.0, fastestBefore_ = 0.0;
    double fastest_ = 0.0, couldFall_ = 0.0;
};

}  // namespace sandflow
