#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/errors.h"
#include "emit/emitter.h"

namespace sandflow::testing {

/// The jet of the paper's floor scene: 83 grains a layer in a disc of 14 radii.
inline Scene makeFloorScene()
{
    Scene scene;
    scene.sourcePath = "scenes/floor.toml";
    EmitterSpec jet;
    jet.kind = EmitterKind::jet;
    jet.name = "spout";
    jet.count = 107687;
    jet.rate = 10700.0;
    jet.position = Vec3(0.0, 0.0, 0.5);
    jet.direction = -Vec3::UnitZ();
    jet.speed = 1.6;
    jet.radius = 0.07;
    scene.emitters.push_back(jet);
    return scene;
}

inline Scene makeScene(const EmitterSpec& spec)
{
    Scene scene;
    scene.sourcePath = "scenes/some.toml";
    scene.emitters.push_back(spec);
    return scene;
}

inline void flyTo(const Vec3& gravity, double delay, NewGrain& grain)
{
    grain.position += grain.velocity * delay + 0.5 * gravity * delay * delay;
    grain.velocity += gravity * delay;
}

/// Calls visit(i, j, gap) once for each pair of grains nearer than `within` (gap between the
/// surfaces, m, negative for overlap), found by hashed cells.
template <typename Visit>
void forEachPair(const std::vector<NewGrain>& grains, double within, Visit&& visit)
{
    double largest = 0.0;
    for (const NewGrain& grain : grains) {
        largest = std::max(largest, grain.radius);
    }
    const double cell = 2.0 * largest + within;
    const auto index = [cell](double x) { return static_cast<std::int64_t>(std::floor(x / cell)); };
    const auto key = [](std::int64_t i, std::int64_t j, std::int64_t k) {
        return ((i + (1 << 20)) << 42) ^ ((j + (1 << 20)) << 21) ^ (k + (1 << 20));
    };
    std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
    for (std::size_t a = 0; a < grains.size(); ++a) {
        const Vec3& p = grains[a].position;
        for (std::int64_t i = -1; i <= 1; ++i) {
            for (std::int64_t j = -1; j <= 1; ++j) {
                for (std::int64_t k = -1; k <= 1; ++k) {
                    const auto found =
                        cells.find(key(index(p.x()) + i, index(p.y()) + j, index(p.z()) + k));
                    if (found == cells.end()) {
                        continue;
                    }
                    for (const std::size_t b : found->second) {
                        const double gap =
                            (p - grains[b].position).norm() - grains[a].radius - grains[b].radius;
                        if (gap < within) {
                            visit(b, a, gap);
                        }
                    }
                }
            }
        }
        cells[key(index(p.x()), index(p.y()), index(p.z()))].push_back(a);
    }
}

/// Smallest gap between two grains, at most `within`.
inline double smallestGap(const std::vector<NewGrain>& grains, double within)
{
    double smallest = within;
    forEachPair(grains, within,
                [&](std::size_t, std::size_t, double gap) { smallest = std::min(smallest, gap); });
    return smallest;
}

/// All batches, each taken when due.
inline std::vector<NewGrain> emitAll(Emitter& emitter)
{
    std::vector<NewGrain> grains;
    while (emitter.nextTime() < std::numeric_limits<double>::infinity()) {
        emitter.emit(emitter.nextTime(), grains);
    }
    return grains;
}

/// The sentence with which an emitter is refused, "" when it is accepted.
inline std::string refusalOf(const Scene& scene)
{
    try {
        makeEmitter(scene, 0);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace sandflow::testing
