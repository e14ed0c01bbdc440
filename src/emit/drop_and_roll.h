#pragma once

#include <optional>

#include "core/vec3.h"
#include "emit/ball_grid.h"

namespace sandflow {

/// Where grains settle: on the floor, and inside vertical walls unless they are absent.
struct SettlingRegion {
    Vec2 lo = Vec2::Zero();  ///< m
    Vec2 hi = Vec2::Zero();  ///< m
    double floor = 0.0;      ///< m
    bool walls = true;       ///< false: grains may leave the region (and are then lost)
};

/// Builds a packing grain by grain (Visscher & Bolsterli 1972): a grain falls until it touches
/// something, then rolls without friction down the steepest way its contacts allow, over one
/// support on a great circle, over two on the circle of constant distance to both, until three
/// supports or the floor hold it. Paths are exact arcs, so contacts close to rounding.
class DropAndRoll {
public:
    DropAndRoll(const SettlingRegion& region, double largestRadius);

    /// Where a grain of that radius dropped at (x, y) comes to rest; nothing when it leaves the
    /// region or balances without end. Does not add it.
    std::optional<Vec3> settle(double x, double y, double radius) const;

    void add(const Vec3& centre, double radius) { grid_.add(centre, radius); }

private:
    SettlingRegion region_;
    double largest_;
    BallGrid grid_;
};

}  // namespace sandflow
