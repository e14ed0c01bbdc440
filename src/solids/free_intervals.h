#pragma once

#include "solids/primitive.h"

#include <utility>
#include <vector>

namespace sandflow {

/// Floor of a column below which there is no solid, m.
inline constexpr double kNoFloor = -1e30;
/// Ceiling of a column that is open above, m.
inline constexpr double kOpenAbove = 1e30;

/// Where sand can be in the column with centre (x, y): {floor, ceiling} in m of every stretch of
/// the vertical line that is in none of the solids existing at `time`, ascending; replaces `out`.
/// Gaps not higher than minGap (m, >= 0) count as solid. The last stretch ends at kOpenAbove unless
/// a plane lies over it; the first begins at kNoFloor where nothing lies below. Empty if the centre
/// is behind a wall (a vertical plane), or altogether in solids. Plates part a column: the floor
/// on one is its true height, the ceiling under it a micrometre less.
void freeIntervals(const std::vector<Primitive>& primitives, double time, double x, double y,
                   double minGap, std::vector<std::pair<double, double>>& out);

/// The stretches of the line inside the primitives that exist at `time`, {bottom, top}, in no order.
void appendSolidStretches(const std::vector<Primitive>& primitives, double time, double x, double y,
                          std::vector<std::pair<double, double>>& out);

/// Solid stretches, in any order, are replaced by the free ones between them that are higher than
/// minGap, as freeIntervals() has them.
void keepGaps(double minGap, std::vector<std::pair<double, double>>& stretches);

}  // namespace sandflow
