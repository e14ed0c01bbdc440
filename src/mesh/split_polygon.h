#pragma once

#include "core/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sandflow {

/// Polygons with more corners are refused: splitting one takes up to the cube of their number.
inline constexpr std::size_t kMaxCorners = 256;

/// Splits a polygon, concave or not, into triangles between its corners, indices 0 to n - 1, the
/// same way round. (assimp 5.2.5 folds some concave polygons over themselves.) A warped one is
/// split as it looks along its normal; one without area becomes triangles without area. Returns
/// whether that is possible: not if it crosses itself.
bool splitPolygon(std::span<const Vec3> corners,
                  std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sandflow
