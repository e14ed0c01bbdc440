#include "core/random.h"

#include <cstring>

#include "core/errors.h"
#include "core/hash.h"

namespace sandflow {

Random::Random(std::uint64_t sceneSeed, std::uint64_t emitter, RandomUse use)
    : generator_(gsl_rng_alloc(gsl_rng_taus2))
{
    if (!generator_) {
        throw SystemError("not enough memory for a random number generator");
    }
    // taus2 takes 32 bits of seed and takes 0 as 1, so both halves of the mix are folded together.
    const std::uint64_t mixed =
        extendHash(extendHash(extendHash(0, sceneSeed), emitter), static_cast<std::uint64_t>(use));
    gsl_rng_set(generator_.get(), (mixed ^ (mixed >> 32)) & 0xffffffffULL);
}

double Random::uniform(double from, double to)
{
    return from + (to - from) * gsl_rng_uniform(generator_.get());
}

std::uint64_t Random::below(std::uint64_t count)
{
    SAND_CHECK(count >= 1 && count <= (1ULL << 32), "count = {}", count);
    return static_cast<std::uint64_t>(gsl_rng_uniform(generator_.get()) *
                                      static_cast<double>(count));
}

std::vector<std::uint8_t> Random::saveState() const
{
    const auto* state = static_cast<const std::uint8_t*>(gsl_rng_state(generator_.get()));
    return std::vector<std::uint8_t>(state, state + gsl_rng_size(generator_.get()));
}

void Random::loadState(const std::vector<std::uint8_t>& bytes)
{
    if (bytes.size() != gsl_rng_size(generator_.get())) {
        throw InputError(fmt::format(
            "a saved random generator has {} bytes instead of {}, so the state was not written by "
            "this version of the program",
            bytes.size(), gsl_rng_size(generator_.get())));
    }
    std::memcpy(gsl_rng_state(generator_.get()), bytes.data(), bytes.size());
}

}  // namespace sandflow
