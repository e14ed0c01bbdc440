#pragma once

#include <functional>

namespace sandflow {

/// Height [m] of the solid on which sand lies over (x, y) [m]. Called from several threads at once.
using FloorHeight = std::function<double(double x, double y)>;

/// The floor that is level at `z` [m].
inline FloorHeight levelFloor(double z)
{
    return [z](double, double) { return z; };
}

}  // namespace sandflow
