#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "core/vec3.h"
#include "scene/scene.h"

namespace sandflow {

/// The flat opening a jet leaves through, in its own plane, centred on (0, 0).
struct Opening {
    bool round = true;
    double radius = 0.0;       ///< m, round
    Vec2 size = Vec2::Zero();  ///< m, rectangle: full width and height

    /// Half the extent along both axes, m.
    Vec2 halfSize() const { return round ? Vec2::Constant(radius) : Vec2(0.5 * size); }

    /// Area in which the centre of a grain that is wholly inside may lie, m2; 0 if none fits.
    double centreArea(double grainRadius) const;

    /// True when a grain centred there is wholly inside.
    bool holds(const Vec2& centre, double grainRadius) const;

    /// A uniformly random centre for a grain that is wholly inside.
    Vec2 drawCentre(double grainRadius, Random& random) const;
};

/// Random sequential addition: one grain after the other goes to random places until it is farther
/// from all earlier ones than the sum of the radii plus 2 %. When no place turns up, all are shaken
/// a little and it goes on; plain addition would saturate just below what the paper's jets need.
/// Returns the number placed, less than radii.size() when the budget ran out. Centres in m.
std::size_t placeLayer(const Opening& opening, const std::vector<double>& radii, Random& random,
                       std::vector<Vec2>& centres);

/// The number of grains a layer can be counted on to hold: found by trial, since no formula knows
/// how random addition saturates in a narrow opening. `wanted` is what the caller needs; when a
/// cautious area bound already allows it, that bound (rounded down) is returned without a trial.
std::int64_t layerCapacity(const Opening& opening, const GrainSpec& grains, double wanted,
                           Random& random);

}  // namespace sandflow
