#pragma once

#include "core/vec3.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// A grain is in exactly one of these; asleep is a kind of mobile. Values are part of the state
/// file format.
enum class GrainState : std::uint8_t { mobile = 0, asleep = 1, interface = 2, buried = 3 };

/// Every grain still in the domain at one instant, ascending by id. What frames, state files,
/// measures and exports are made of; the solver's own layout never leaves the solver.
struct Snapshot {
    std::uint64_t frame = 0;
    double time = 0.0;          ///< s
    double meanRadius = 0.0;    ///< m, of the scene
    std::uint64_t emitted = 0;
    std::uint64_t exited = 0;
    std::vector<std::uint32_t> id;
    std::vector<Vec3> position;       ///< m
    std::vector<Vec3f> velocity;      ///< m/s, zero unless mobile
    std::vector<Vec3f> spin;          ///< rad/s, zero unless mobile
    std::vector<float> radius;        ///< m
    std::vector<GrainState> state;

    std::size_t size() const { return id.size(); }
};

}  // namespace sandflow
