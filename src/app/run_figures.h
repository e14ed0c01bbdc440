#pragma once

#include <cstdint>
#include <string>

namespace sandflow {

/// Shares of the emitted grains, 0 to 1. Awake is mobile without the sleeping ones.
struct GrainShares {
    double mobile = 0.0;
    double awake = 0.0;
    double interface = 0.0;
    double buried = 0.0;
};

/// What frames.csv of a run says about it as a whole. "Busy" is from the first emission to half a
/// second after the last: what comes later is waiting.
struct RunFigures {
    std::uint64_t frames = 0;
    std::uint64_t grains = 0;  ///< emitted
    std::uint64_t exited = 0;
    double endTime = 0.0;       ///< s
    double lastEmission = 0.0;  ///< s, end of the last frame in which grains came
    GrainShares atEnd;
    GrainShares pouring;         ///< mean over the last second of emission
    double wallPerFrame = 0.0;   ///< s, mean over the busy frames
    double stepsPerFrame = 0.0;  ///< mean over the busy frames
    double step = 0.0;           ///< s, mean over all steps
    bool ledgerOk = false;       ///< emitted = mobile + interface + buried + exited in all frames
};

/// Reads frames.csv of a run folder. Throws InputError if it is missing, broken or without a frame.
RunFigures readRunFigures(const std::string& folder);

}  // namespace sandflow
