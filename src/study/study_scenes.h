#pragma once

#include "scene/scene.h"

namespace sandflow {

/// Pieces of the small scenes that studies are made of.

/// The plane z = 0; rough as a sanded floor, or smooth.
SolidSpec makeLevelFloor(bool rough);

/// A container of four thin walls about the middle, `half` to either side along x and y [m], open at
/// the top; `bottom` closes it at z = 0.
SolidSpec makeContainer(const Vec2& half, double height, bool bottom);

/// Settled sand between the walls of such a container, up to `depth` [m].
EmitterSpec makeSettledFill(const Vec2& half, double depth);

/// One grain.
EmitterSpec makeOneGrain(const Vec3& position, const Vec3& velocity);

}  // namespace sandflow
