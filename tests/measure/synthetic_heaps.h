#pragma once

#include "grains/snapshot.h"

#include <cmath>
#include <cstdint>
#include <random>

namespace sandflow::testing {

inline constexpr double kRadius = 0.005;          // m
inline constexpr double kDiameter = 2 * kRadius;  // m

inline double degrees(double radians)
{
    return radians * 180.0 / kPi;
}

inline Snapshot emptySnapshot(double meanRadius = kRadius)
{
    Snapshot snapshot;
    snapshot.meanRadius = meanRadius;
    return snapshot;
}

inline void addGrain(Snapshot& snapshot, const Vec3& position, double radius = kRadius,
                     GrainState state = GrainState::mobile, const Vec3f& velocity = Vec3f::Zero())
{
    snapshot.id.push_back(static_cast<std::uint32_t>(snapshot.size()));
    snapshot.position.push_back(position);
    snapshot.velocity.push_back(velocity);
    snapshot.spin.push_back(Vec3f::Zero());
    snapshot.radius.push_back(static_cast<float>(radius));
    snapshot.state.push_back(state);
}

/// Spheres side by side under the surface of a cone, so dense that their hull is the cone: for
/// centres on a plane of slope angle t the hull is a plane r / cos t higher. Grains per area are
/// the same everywhere out to the rim.
inline Snapshot makeConeShell(double angle, double apex, const Vec2& centre = Vec2::Zero(),
                              double lift = 0.0)
{
    Snapshot snapshot = emptySnapshot();
    const double rim = apex / std::tan(angle);
    const double step = kDiameter / 4.0;
    const int reach = static_cast<int>(rim / step) + 1;
    for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
            const double rho = step * std::hypot(i, j);
            if (rho < rim) {
                const double top = apex - std::tan(angle) * rho;
                addGrain(snapshot, {centre.x() + step * i, centre.y() + step * j,
                                    top - kRadius / std::cos(angle) + lift});
            }
        }
    }
    return snapshot;
}

/// Grains thrown at random into a cone, about as many as a poured heap has: a rough surface, the
/// same number per volume everywhere. They overlap and keep no contacts; held, so all count.
inline Snapshot makeRandomCone(double angle, double apex, std::uint64_t seed)
{
    Snapshot snapshot = emptySnapshot();
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double rim = apex / std::tan(angle);
    const double volume = kPi * rim * rim * apex / 3.0;
    const int count = static_cast<int>(0.6 * volume / (4.0 / 3.0 * kPi * std::pow(kRadius, 3)));
    while (snapshot.size() < static_cast<std::size_t>(count)) {
        const Vec3 p{rim * (2 * unit(random) - 1), rim * (2 * unit(random) - 1),
                     apex * unit(random)};
        const double rho = std::hypot(p.x(), p.y());
        if (p.z() < apex - rho * std::tan(angle)) {
            addGrain(snapshot, p, kRadius * (0.92 + 0.16 * unit(random)), GrainState::buried);
        }
    }
    return snapshot;
}

/// Spheres whose hull is a block with a nearly level top, edges [0, length] x [0, width].
inline Snapshot makeSlab(double length, double width, double top)
{
    Snapshot snapshot = emptySnapshot();
    const double step = kDiameter / 8.0;
    for (int j = 4; j * step < width - kRadius + 1e-9; ++j) {
        for (int i = 4; i * step < length - kRadius + 1e-9; ++i) {
            addGrain(snapshot, {i * step, j * step, top - kRadius}, kRadius, GrainState::asleep);
        }
    }
    return snapshot;
}

}  // namespace sandflow::testing
