#pragma once

#include "solver/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <omp.h>
#include <vector>

/// Small scenes made in code, and what tests ask of their grains.
namespace sandflow::testing {

/// Small scenes gain nothing from more threads; tests of threads set their own number.
struct TwoThreads : ::testing::Environment {
    void SetUp() override { omp_set_num_threads(2); }
};
inline const ::testing::Environment* const kTwoThreads =
    ::testing::AddGlobalTestEnvironment(new TwoThreads);

inline SolidSpec makeFloor()
{
    SolidSpec floor;
    floor.shape = SolidShape::plane;
    floor.name = "floor";
    floor.rough = true;
    return floor;
}

inline SolidSpec makeDisc(double z, double radius, double until)
{
    SolidSpec disc;
    disc.shape = SolidShape::disc;
    disc.name = "plate";
    disc.point = Vec3(0.0, 0.0, z);
    disc.radius = radius;
    disc.until = until;
    return disc;
}

inline EmitterSpec makeSingle(const Vec3& position, const Vec3& velocity = Vec3::Zero())
{
    EmitterSpec single;
    single.kind = EmitterKind::single;
    single.position = position;
    single.velocity = velocity;
    return single;
}

/// Nothing but a rough floor.
inline Scene makeEmptyScene()
{
    Scene scene;
    scene.name = "small";
    scene.solids.push_back(makeFloor());
    return scene;
}

/// A slow, thin jet of `count` grains, 600 a second, onto a rough floor 0.12 m below: it makes a
/// heap as high as so few grains can.
inline Scene makePour(std::int64_t count, Mode mode)
{
    Scene scene = makeEmptyScene();
    scene.mode = mode;
    EmitterSpec jet;
    jet.kind = EmitterKind::jet;
    jet.name = "spout";
    jet.count = count;
    jet.rate = 600.0;
    jet.position = Vec3(0.0, 0.0, 0.12);
    jet.speed = 0.5;
    jet.radius = 0.03;
    scene.emitters.push_back(jet);
    return scene;
}

/// Runs to the end (or for `frames`), calling visit(simulation, report) after every frame.
inline std::unique_ptr<Simulation> run(
    const Scene& scene,
    const std::function<void(const Simulation&, const FrameReport&)>& visit =
        [](const Simulation&, const FrameReport&) {},
    std::uint64_t frames = 1u << 30)
{
    std::unique_ptr<Simulation> simulation = makeSimulation(scene);
    for (std::uint64_t n = 0; n < frames && !simulation->finished(); ++n) {
        const FrameReport report = simulation->advanceFrame();
        visit(*simulation, report);
    }
    return simulation;
}

inline Snapshot snapshotOf(const Simulation& simulation)
{
    Snapshot snapshot;
    simulation.takeSnapshot(snapshot);
    return snapshot;
}

inline std::size_t countState(const Snapshot& snapshot, GrainState state)
{
    return static_cast<std::size_t>(
        std::count(snapshot.state.begin(), snapshot.state.end(), state));
}

/// Mean height [m] of the twenty highest grains: a heap's apex without its luck.
inline double apexOf(const Snapshot& snapshot)
{
    std::vector<double> z;
    for (const Vec3& p : snapshot.position) {
        z.push_back(p.z());
    }
    const std::size_t top = std::min<std::size_t>(20, z.size());
    std::partial_sort(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(top), z.end(),
                      std::greater<>());
    double sum = 0.0;
    for (std::size_t k = 0; k < top; ++k) {
        sum += z[k];
    }
    return sum / static_cast<double>(std::max<std::size_t>(top, 1));
}

/// Distance [m] from the axis that 90 % of the grains are within.
inline double spreadOf(const Snapshot& snapshot)
{
    std::vector<double> distance;
    for (const Vec3& p : snapshot.position) {
        distance.push_back(p.head<2>().norm());
    }
    const auto at = distance.begin() + static_cast<std::ptrdiff_t>(9 * distance.size() / 10);
    std::nth_element(distance.begin(), at, distance.end());
    return *at;
}

/// Deepest overlap of two grains, in radii of the smaller one. A few thousand grains at most.
inline double deepestPair(const Snapshot& s)
{
    double deepest = 0.0;
    for (std::size_t a = 0; a < s.size(); ++a) {
        for (std::size_t b = a + 1; b < s.size(); ++b) {
            const double radii =
                static_cast<double>(s.radius[a]) + static_cast<double>(s.radius[b]);
            const Vec3 apart = s.position[a] - s.position[b];
            if (apart.squaredNorm() < radii * radii) {
                deepest =
                    std::max(deepest, (radii - apart.norm()) /
                                          static_cast<double>(std::min(s.radius[a], s.radius[b])));
            }
        }
    }
    return deepest;
}

/// Largest displacement [m] of a grain between two snapshots of the same grains.
inline double largestMove(const Snapshot& before, const Snapshot& after)
{
    EXPECT_EQ(before.id, after.id);
    double largest = 0.0;
    for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k) {
        largest = std::max(largest, (after.position[k] - before.position[k]).norm());
    }
    return largest;
}

}  // namespace sandflow::testing
