#pragma once

#include "scene/scene.h"
#include "solver/simulation.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// What an emitter will do.
struct EmitterPlan {
    std::uint64_t count = 0;
    double start = 0.0;  ///< s, first grains
    double end = 0.0;    ///< s, last grains
};

/// Memory of a grain that is computed, in float: two records, its lists, its contacts and what the
/// search for them needs. The settled bed of `bench kernel` takes 428.
inline constexpr double kBytesPerMobile = 440.0;
/// Of one that is buried: its place, size and id.
inline constexpr double kBytesPerBuried = 16.0;

/// Rough needs of a run, to tell megabytes from gigabytes and minutes from days.
struct RunCosts {
    double grainSteps = 0.0;   ///< grains times steps if every grain were computed in every step
    double memoryBytes = 0.0;  ///< at the end
    double frameBytes = 0.0;   ///< picture files of all frames
};

/// Throws InputError for an emitter that cannot work.
std::vector<EmitterPlan> planEmitters(const Scene& scene);

RunCosts estimateCosts(const Scene& scene, const RunPlan& plan,
                       const std::vector<EmitterPlan>& emitters);

}  // namespace sandflow
