#pragma once

#include "app/bench_bed.h"

namespace sandflow {

struct KernelBenchOptions {
    int steps = 300;   ///< timed
    int warmup = 300;  ///< before them: the springs of a bed are not part of it and must form
    int repeats = 3;   ///< from the same start; the median counts
    int busy = 0;      ///< processes that keep a processor busy each, in a second round of repeats
    bool rolling = true;
    bool real64 = false;
};

/// Cost of the steps of one repeat; the state at the end is the same for each.
struct KernelTiming {
    double stepSeconds = 0.0;
    double rebuildSeconds = 0.0;
    std::uint64_t rebuilds = 0;
};

/// Mps is million particle-steps per second: grains times steps over wall time.
struct KernelBenchResult {
    std::size_t grains = 0;
    int steps = 0;
    int threads = 0;
    std::vector<KernelTiming> repeats;
    double mps = 0.0;  ///< rebuilds included; median
    double mpsLow = 0.0, mpsHigh = 0.0;
    double mpsBusy = 0.0;  ///< beside busy processes, if that was asked for; median
    double mpsWithoutRebuilds = 0.0;  ///< of the repeat that gave the median
    std::uint64_t rebuilds = 0;
    double rebuildShare = 0.0;      ///< of the time
    double contactsPerGrain = 0.0;  ///< partners that push on a grain, walls included
    double pairsPerGrain = 0.0;     ///< listed
    double kineticEnergy = 0.0;     ///< J, translation
    double bytesPerGrain = 0.0;
    double deepestOverlap = 0.0;  ///< in r
};

/// Times steps on a bed, with the threads that OpenMP is set to. Throws PhysicsError if the bed
/// flies apart (grains put into each other).
KernelBenchResult benchKernel(const Bed& bed, const KernelBenchOptions& options);

}  // namespace sandflow
