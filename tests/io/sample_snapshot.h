#pragma once

#include "grains/snapshot.h"

#include <cmath>
#include <random>

namespace sandflow {

/// Appends a grain at rest.
inline void addGrain(Snapshot& snapshot, std::uint32_t id, const Vec3& position,
                     GrainState state = GrainState::interface)
{
    snapshot.id.push_back(id);
    snapshot.position.push_back(position);
    snapshot.velocity.push_back(Vec3f::Zero());
    snapshot.spin.push_back(Vec3f::Zero());
    snapshot.radius.push_back(static_cast<float>(snapshot.meanRadius));
    snapshot.state.push_back(state);
}

/// A cone of loosely placed grains of all four states, some moving.
inline Snapshot makeHeap(std::size_t count, std::uint32_t seed = 1)
{
    Snapshot snapshot;
    snapshot.frame = 2;
    snapshot.time = 2.0 / 30.0;
    snapshot.meanRadius = 0.005;
    snapshot.emitted = count + 3;
    snapshot.exited = 3;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double slope = std::tan(26.0 * kPi / 180.0);
    const double base = 0.005 * std::cbrt(static_cast<double>(count) * 4.0 / 0.58 / slope);
    for (std::size_t i = 0; i < count; ++i) {
        const double z = base * slope * (1.0 - std::cbrt(uniform(random)));
        const double rho = (base - z / slope) * std::sqrt(uniform(random));
        const double phi = 2.0 * kPi * uniform(random);
        const auto state = static_cast<GrainState>(i % 4);
        addGrain(snapshot, static_cast<std::uint32_t>(2 * i + 1),
                 Vec3(rho * std::cos(phi), rho * std::sin(phi), z + 0.005), state);
        snapshot.radius.back() = static_cast<float>(0.005 * (0.92 + 0.16 * uniform(random)));
        if (state == GrainState::mobile) {
            snapshot.velocity.back() = Vec3f(0.25F, -1.0F / 3.0F, static_cast<float>(-z));
            snapshot.spin.back() = Vec3f(0.0F, 7.1F, -0.0F);
        }
    }
    return snapshot;
}

}  // namespace sandflow
