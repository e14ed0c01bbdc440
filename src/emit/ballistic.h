#pragma once

#include "emit/emitter.h"

namespace sandflow {

/// Moves a grain on by `delay` s of free flight, exactly: x + v t + g t^2 / 2, v + g t.
inline void flyOn(const Vec3& gravity, double delay, NewGrain& grain)
{
    grain.position += grain.velocity * delay + gravity * (0.5 * delay * delay);
    grain.velocity += gravity * delay;
}

}  // namespace sandflow
