#pragma once

#include "bcre/columns.h"
#include "solids/primitive.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sandflow {

/// On a smooth floor the lowest grains roll and slide under the weight of a slope, and the heap above
/// spreads with them, ever slower with depth (by e over 5 d in our full DEM; on a rough floor over
/// 1.7 d). Fixed grains would not: a heap that is frozen there stands four degrees too steep. Nor does
/// it help to ask which grains at the base move just now: every fixed one holds its neighbours. So
/// over a smooth floor no sand is fixed under a surface that slopes; level sand presses nobody aside.
class BaseSlip {
public:
    /// By span: 1 where the base may slip; empty where no floor is smooth. `time`: s.
    const std::vector<std::uint8_t>& find(const ColumnGrid& columns,
                                          std::span<const Primitive> solids, double time);

private:
    void findSmoothFloors(const ColumnGrid& columns, std::span<const Primitive> solids, double time);
    void findSlopes(const ColumnGrid& columns);

    std::vector<std::uint8_t> smooth_;   ///< by span: its floor has no fixed particles
    std::vector<Vec2> slope_, smoothed_; ///< of H, by span
    std::vector<std::uint8_t> slips_;
};

}  // namespace sandflow
