#pragma once

#include <gsl/gsl_rng.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace sandflow {

/// What random numbers are drawn for. Each use has its own stream, so that, for instance, a retried
/// placement never changes the sizes of later grains.
enum class RandomUse : std::uint64_t { sizes = 1, places = 2, packing = 3, trial = 4 };

/// A GSL generator (taus2, period 2^88) seeded from (scene seed, emitter index, use). The state can
/// be saved as bytes and restored exactly; the bytes are for machines of the same kind (x86-64).
class Random {
public:
    /// Throws SystemError when there is no memory for the generator.
    Random(std::uint64_t sceneSeed, std::uint64_t emitter, RandomUse use);

    /// Uniform in [from, to), with 2^32 steps.
    double uniform(double from, double to);

    /// Uniform in 0 .. count - 1; count in 1 .. 2^32.
    std::uint64_t below(std::uint64_t count);

    std::vector<std::uint8_t> saveState() const;

    /// Throws InputError when the bytes are not the state of such a generator.
    void loadState(const std::vector<std::uint8_t>& bytes);

private:
    struct Free {
        void operator()(gsl_rng* generator) const { gsl_rng_free(generator); }
    };
    std::unique_ptr<gsl_rng, Free> generator_;
};

}  // namespace sandflow
