#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sandflow {

/// Scrambles 64 bits so that every input bit flips every output bit with probability 1/2. One to
/// one: different inputs never meet. (Shifts and factors: Stafford 2011, variant 13 of the
/// MurmurHash3 finaliser; Steele et al. 2014 use it in SplitMix.)
constexpr std::uint64_t mixBits(std::uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// Adds `word` to a chain of hashed words; the order of the words counts. Start from a seed:
/// extendHash(extendHash(seed, i), j). One to one in either argument while the other stands.
constexpr std::uint64_t extendHash(std::uint64_t hash, std::uint64_t word)
{
    // The odd constant (2^64 over the golden ratio) keeps (0, 0) from mapping to 0; the rotation
    // keeps hash and word from changing places.
    return mixBits(std::rotl(mixBits(hash), 23) + word + 0x9e3779b97f4a7c15ULL);
}

/// The upper 53 bits as a number in [0, 1); the same bits on every machine.
constexpr double unitFromBits(std::uint64_t bits)
{
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Fingerprint of a simulation's state: feed it the arrays in a fixed order, then read value().
///
/// Four lanes take one 8-byte word each in turn, so that the multiplications overlap. Every step is
/// one to one in the lane and in the word: two states fed by the same calls that differ in a
/// single word never have the same value; others meet with a chance of about 2^-64. Where one
/// array ends and the next begins counts. Not made to withstand an adversary.
///
/// Words are hashed by value: arrays of 8-byte numbers give the same hash on little- and big-endian
/// machines; narrower numbers do not. Floating-point numbers count by their bits (-0 is not 0), and
/// padding inside structs counts too, so feed members, not structs with holes.
class StateHash {
public:
    /// Adds `bytes` bytes; data may be null if there are none, and need not be aligned.
    void add(const void* data, std::size_t bytes)
    {
        // A local copy lives in registers; the members might alias the data.
        std::array<std::uint64_t, kLanes> lane = lane_;
        const unsigned char* at = static_cast<const unsigned char*>(data);
        std::size_t left = bytes;
        for (; left >= kLanes * kWord; left -= kLanes * kWord, at += kLanes * kWord) {
            for (std::size_t k = 0; k < kLanes; ++k) {
                lane[k] = absorbWord(lane[k], loadWord(at + k * kWord));
            }
        }
        std::size_t next = 0;
        for (; left >= kWord && next < kLanes; left -= kWord, at += kWord, ++next) {
            lane[next] = absorbWord(lane[next], loadWord(at));
        }
        if (left > 0 && next < kLanes) {
            lane[next] = absorbWord(lane[next], loadTail(at, left));
        }
        // The length tells a short tail from one padded with zeros, and closes the array.
        lane[0] = absorbWord(lane[0], bytes);
        lane_ = lane;
    }

    /// Adds one number, as add(&word, 8) does.
    void addWord(std::uint64_t word) { add(&word, sizeof word); }

    /// The hash of all that was added so far; adding may go on afterwards.
    std::uint64_t value() const
    {
        std::uint64_t hash = 0;
        for (const std::uint64_t lane : lane_) {
            hash = extendHash(hash, lane);
        }
        return hash;
    }

private:
    static constexpr std::size_t kLanes = 4;
    static constexpr std::size_t kWord = 8;

    static constexpr std::uint64_t absorbWord(std::uint64_t lane, std::uint64_t word)
    {
        // The word's product is off the critical path; multiplying moves differences up, the
        // rotation brings the upper half down again. The sum leaves no lane stuck at 0.
        constexpr std::uint64_t kSpread = 0xd6e8feb86659fd93ULL;
        constexpr std::uint64_t kCarry = 0xa0761d6478bd642fULL;
        return std::rotl(lane ^ (word * kSpread), 29) * kCarry + kSpread;
    }

    static std::uint64_t loadWord(const unsigned char* at)
    {
        std::uint64_t word = 0;
        std::memcpy(&word, at, kWord);
        return word;
    }

    static std::uint64_t loadTail(const unsigned char* at, std::size_t bytes)
    {
        std::uint64_t word = 0;
        for (std::size_t k = 0; k < bytes; ++k) {
            word |= static_cast<std::uint64_t>(at[k]) << (8 * k);
        }
        return word;
    }

    std::array<std::uint64_t, kLanes> lane_ = {1, 2, 3, 4};
};

}  // namespace sandflow
