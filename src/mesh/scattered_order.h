#pragma once

#include "core/hash.h"

#include <bit>
#include <cstdint>

namespace sandflow {

/// The numbers 0 .. count - 1 in an order without pattern, each exactly once, given by the seed
/// alone. Nothing is stored, so a shuffle of hundreds of millions costs no memory.
///
/// Multiplying by an odd number and folding the upper half of the bits onto the lower are both one
/// to one on words of `bits` bits; a result beyond the count is sent round again until it falls
/// below, which keeps the whole map one to one.
class ScatteredOrder {
public:
    ScatteredOrder(std::uint64_t count, std::uint64_t seed)
        : count_(count),
          mask_(std::bit_ceil(count) - 1),
          fold_(static_cast<int>(std::bit_width(mask_)) / 2 + 1),
          key_(mixBits(seed ^ kSalt))
    {
    }

    /// The number at place `k`; k below the count.
    std::uint64_t at(std::uint64_t k) const
    {
        do {
            std::uint64_t key = key_;
            for (int round = 0; round < kRounds; ++round) {
                key = mixBits(key + kSalt);
                k = (k * (key | 1) + (key >> 32)) & mask_;
                k ^= k >> fold_;
            }
        } while (k >= count_);
        return k;
    }

private:
    static constexpr int kRounds = 4;
    static constexpr std::uint64_t kSalt = 0x9e3779b97f4a7c15ULL;

    std::uint64_t count_;
    std::uint64_t mask_;
    int fold_;
    std::uint64_t key_;
};

}  // namespace sandflow
