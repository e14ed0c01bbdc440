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

/// Of a fixed particle that makes a solid rough.
struct BoundaryInfo {
    std::uint32_t cover = 0;  ///< which of the solver's covers it belongs to
};

}  // namespace sandflow
