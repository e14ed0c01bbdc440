#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sandflow {

/// Three double components in the simulator's axes: right-handed, z up, metres.
using Vec3 = Eigen::Vector3d;
/// The same in single precision; used where a difference, not a position, is kept.
using Vec3f = Eigen::Vector3f;
using Vec2 = Eigen::Vector2d;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kGravity = 9.81;  ///< m/s2, the default of a scene

}  // namespace sandflow
