#pragma once

#include "measure/height_map.h"

#include <vector>

namespace sandflow {

/// Mean depth of sand [m] in annulus k, rho in [k d, (k + 1) d) about `centre`, for every annulus
/// out to the farthest sand; points without sand count as zero. Empty for no sand.
std::vector<double> averageOverAnnuli(const HeightMap& map, const Vec2& centre);

/// Mean depth of sand [m] over the disc of `radius` [m] about `centre`.
double averageOverDisc(const HeightMap& map, const Vec2& centre, double radius);

/// Area of annulus k in units of d^2: pi ((k + 1)^2 - k^2).
double annulusArea(std::size_t k);

/// Mean distance from the centre over annulus k, in units of d. With it, a cone's profile is
/// exactly a straight line.
double annulusMeanRadius(std::size_t k);

}  // namespace sandflow
