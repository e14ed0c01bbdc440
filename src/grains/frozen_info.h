#pragma once

#include "core/vec3.h"
#include "grains/mobile_grains.h"
#include "grains/snapshot.h"

namespace sandflow {

/// What is known of a grain that is held fixed though it is sand: part of the particle interface,
/// or asleep.
struct FrozenInfo {
    GrainState state = GrainState::interface;
    bool judged = false;             ///< restForce has been taken
    bool wakes = false;              ///< to be woken at the next transfer
    /// Its row in the contact book if it was mobile when that was written, else kNoRow.
    std::uint32_t row = kNoRow;
    Vec3f restForce = Vec3f::Zero(); ///< N, sum of normal forces when it came to rest
};

/// Fixed particles of rough solids carry nothing else.
struct BoundaryInfo {};

}  // namespace sandflow
