#pragma once

#include "core/errors.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sandflow {

struct RunOptions {
    std::string scenePath;
    std::string folder;
    std::string mode;
    std::optional<std::uint64_t> frames;
    int threads = 0;
    std::string simd = "auto";
    std::optional<std::uint64_t> seed;
    std::vector<std::string> overrides;
    bool force = false;
    bool noFrames = false;
    bool allGrains = false;
    bool keepStates = false;
    bool noSkip = false;
    std::optional<double> releaseSeconds;  ///< simulated after the end, with all sand set free
    bool quiet = false;
};

/// Reads the scene, runs it to its end and leaves a run folder. Nothing is left behind when the
/// scene is refused.
ExitCode runScene(const RunOptions& options);

}  // namespace sandflow
