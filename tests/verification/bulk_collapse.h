#pragma once

#include "measure/heap.h"
#include "scene/scene.h"

/// Collapse of a round column of sand whose wall vanishes.
///
/// The run-out is judged with the radius that holds 99 % of the grains, for it hardly depends on
/// how large the grains are: with 10 and with 20 of them across L0 it is 1.34 and 1.32 L0 at a = 1,
/// 2.87 and 2.86 L0 at a = 2.5. The foot at a height of 1 d, 0.68 and 0.97, 1.66 and 2.26 L0, would
/// have to be extrapolated to the small grains of the experiments; it is reported.
namespace sandflow::verification {

struct CollapseResult {
    std::uint64_t grains = 0;
    double aspect = 0.0;  ///< H0 / L0 as measured before the wall vanished; L0 its inner radius
    double runOut = 0.0;  ///< (L - L0) / L0, L the radius that holds 99 % of the grains
    double foot = 0.0;    ///< the same with L where the mean height falls below 1 d
    double height = 0.0;  ///< final height at the middle / L0
    HeapFigures column, deposit;
};

/// Sand is poured into a cylinder of smooth glass on a rough floor, comes to rest, and the glass
/// vanishes. `aspect` is what the column is to have; `radius` [d] its L0.
CollapseResult measureCollapse(Mode mode, double aspect, double radius, std::uint64_t seed);

}  // namespace sandflow::verification
