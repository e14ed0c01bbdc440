#pragma once

#include <cstdint>

namespace sandflow {

/// All that a contact needs of one grain, in one cache line (float): a neighbour costs one line.
/// Positions are always double: a resting overlap is micrometres, a float's step at 1 m is 0.06.
template <class Real>
struct alignas(64) GrainRecord {
    double x = 0, y = 0, z = 0;      ///< m, centre
    Real radius = 0;                 ///< m
    Real inverseMass = 0;            ///< 1/kg; 0: fixed (interface, asleep, rough floor)
    Real vx = 0, vy = 0, vz = 0;     ///< m/s
    Real wx = 0, wy = 0, wz = 0;     ///< rad/s
    std::uint32_t id = 0;            ///< see grain_id.h
    /// Fixed grains: contact force [N] beyond which the kernel asks for the grain to be woken.
    float wakeForce = 0;
};
static_assert(sizeof(GrainRecord<float>) == 64);

/// Ids of one number space, so that a contact is known by its two ids whatever the grains' states.
inline constexpr std::uint32_t kFirstBoundaryId = 0x80000000u;  ///< fixed particles of rough solids
inline constexpr std::uint32_t kFirstWallId = 0xF0000000u;      ///< primitives of analytic solids

/// Springs of one contact: tangential displacement [m] and rolling displacement [m], both as the
/// grain that owns the pair sees them (the other sees the negative).
template <class Real>
struct PairHistory {
    Real sx = 0, sy = 0, sz = 0;
    Real qx = 0, qy = 0, qz = 0;
};

}  // namespace sandflow
