#include "core/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <set>
#include <vector>

namespace sandflow {
namespace {

std::vector<std::uint64_t> drawWords(std::size_t count)
{
    std::mt19937_64 random(5);
    std::vector<std::uint64_t> words(count);
    std::generate(words.begin(), words.end(), [&] { return random(); });
    return words;
}

std::uint64_t hashWords(const std::vector<std::uint64_t>& words)
{
    StateHash hash;
    hash.add(words.data(), words.size() * sizeof(std::uint64_t));
    return hash.value();
}

TEST(MixBits, IsOneToOne)
{
    // Undo the three steps: multiply by the inverses modulo 2^64, unfold the shifts.
    const auto invert = [](std::uint64_t odd) {
        std::uint64_t inverse = odd;
        for (int k = 0; k < 6; ++k) {
            inverse *= 2 - odd * inverse;
        }
        return inverse;
    };
    const auto unfold = [](std::uint64_t y, int shift) {
        std::uint64_t x = y;
        for (int k = 0; k < 64 / shift + 1; ++k) {
            x = y ^ (x >> shift);
        }
        return x;
    };
    for (const std::uint64_t word : drawWords(1000)) {
        std::uint64_t x = unfold(mixBits(word), 31) * invert(0x94d049bb133111ebULL);
        x = unfold(x, 27) * invert(0xbf58476d1ce4e5b9ULL);
        EXPECT_EQ(unfold(x, 30), word);
    }
}

TEST(ExtendHash, OrderSeedAndWordsAllCount)
{
    std::set<std::uint64_t> seen;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        for (std::uint64_t i = 0; i < 50; ++i) {
            for (std::uint64_t j = 0; j < 50; ++j) {
                seen.insert(extendHash(extendHash(seed, i - 25), j - 25));
            }
        }
    }
    EXPECT_EQ(seen.size(), 25000u);
    EXPECT_NE(extendHash(1, 2), extendHash(2, 1));
}

TEST(ExtendHash, EachInputBitFlipsHalfTheOutputBits)
{
    double flips = 0.0;
    const std::vector<std::uint64_t> words = drawWords(200);
    for (const std::uint64_t word : words) {
        for (int bit = 0; bit < 64; ++bit) {
            flips += std::popcount(extendHash(7, word) ^ extendHash(7, word ^ (1ULL << bit)));
        }
    }
    // 12,800 samples of a binomial of deviation 4: the mean is good to 0.035; five of those.
    EXPECT_NEAR(flips / (64.0 * static_cast<double>(words.size())), 32.0, 0.18);
}

TEST(UnitFromBits, FillsTheUnitIntervalEvenly)
{
    EXPECT_EQ(unitFromBits(0), 0.0);
    EXPECT_LT(unitFromBits(~0ULL), 1.0);
    constexpr int kBins = 64;
    constexpr int kDraws = 640000;
    std::vector<int> count(kBins, 0);
    for (std::uint64_t k = 0; k < kDraws; ++k) {
        ++count[static_cast<std::size_t>(unitFromBits(extendHash(3, k)) * kBins)];
    }
    double chiSquare = 0.0;
    for (const int n : count) {
        const double expected = static_cast<double>(kDraws) / kBins;
        chiSquare += (n - expected) * (n - expected) / expected;
    }
    // 63 degrees of freedom: mean 63, deviation 11.
    EXPECT_GT(chiSquare, 63.0 - 4.0 * 11.0);
    EXPECT_LT(chiSquare, 63.0 + 4.0 * 11.0);
}

TEST(StateHash, NoChangeOfOneBitGoesUnseen)
{
    std::vector<std::uint64_t> words = drawWords(101);
    std::set<std::uint64_t> seen = {hashWords(words)};
    for (std::uint64_t& word : words) {
        for (int bit = 0; bit < 64; ++bit) {
            word ^= 1ULL << bit;
            seen.insert(hashWords(words));
            word ^= 1ULL << bit;
        }
    }
    EXPECT_EQ(seen.size(), 101u * 64u + 1u);
}

TEST(StateHash, OneBitFlipsHalfTheValue)
{
    std::vector<std::uint64_t> words = drawWords(13);
    const std::uint64_t original = hashWords(words);
    double flips = 0.0;
    for (std::uint64_t& word : words) {
        for (int bit = 0; bit < 64; ++bit) {
            word ^= 1ULL << bit;
            flips += std::popcount(hashWords(words) ^ original);
            word ^= 1ULL << bit;
        }
    }
    // 832 samples: the mean is good to 0.14.
    EXPECT_NEAR(flips / (13.0 * 64.0), 32.0, 0.7);
}

TEST(StateHash, OrderCounts)
{
    std::vector<std::uint64_t> words = drawWords(40);
    std::set<std::uint64_t> seen = {hashWords(words)};
    for (std::size_t i = 0; i < words.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            std::swap(words[i], words[j]);
            seen.insert(hashWords(words));
            std::swap(words[i], words[j]);
        }
    }
    EXPECT_EQ(seen.size(), 40u * 39u / 2u + 1u);
}

TEST(StateHash, LengthsAndBoundariesCount)
{
    const std::vector<unsigned char> zeros(100, 0);
    std::set<std::uint64_t> seen;
    for (std::size_t bytes = 0; bytes <= zeros.size(); ++bytes) {
        StateHash hash;
        hash.add(zeros.data(), bytes);
        seen.insert(hash.value());
    }
    // One array cut in two at every place, empty parts included.
    for (std::size_t cut = 0; cut <= zeros.size(); ++cut) {
        StateHash hash;
        hash.add(zeros.data(), cut);
        hash.add(zeros.data() + cut, zeros.size() - cut);
        seen.insert(hash.value());
    }
    seen.insert(StateHash().value());
    EXPECT_EQ(seen.size(), 101u + 101u + 1u);
}

TEST(StateHash, NothingToAddMayBeNull)
{
    StateHash hash;
    hash.add(nullptr, 0);
    EXPECT_NE(hash.value(), StateHash().value());
}

TEST(StateHash, ReadingTheValueDoesNotDisturbIt)
{
    StateHash once;
    StateHash twice;
    once.addWord(1);
    twice.addWord(1);
    EXPECT_EQ(twice.value(), once.value());
    once.addWord(2);
    twice.addWord(2);
    EXPECT_EQ(twice.value(), once.value());
    EXPECT_EQ(twice.value(), twice.value());
}

TEST(StateHash, AlignmentDoesNotCount)
{
    std::vector<unsigned char> bytes(200);
    for (std::size_t k = 0; k < bytes.size(); ++k) {
        bytes[k] = static_cast<unsigned char>(k * 37 % 251);
    }
    StateHash reference;
    reference.add(bytes.data(), 101);
    for (std::size_t offset = 1; offset < 16; ++offset) {
        std::vector<unsigned char> moved(offset);
        moved.insert(moved.end(), bytes.begin(), bytes.begin() + 101);
        StateHash hash;
        hash.add(moved.data() + offset, 101);
        EXPECT_EQ(hash.value(), reference.value());
    }
}

TEST(StateHash, SimilarStatesMeetNoMoreOftenThanChanceAllows)
{
    // 2^18 counters, compared in 32 bits: 2^36 / 2 / 2^32 = 8 pairs expected.
    constexpr std::uint64_t kStates = 1 << 18;
    std::vector<std::uint32_t> halves;
    for (std::uint64_t k = 0; k < kStates; ++k) {
        StateHash hash;
        hash.addWord(k);
        hash.addWord(k * k);
        halves.push_back(static_cast<std::uint32_t>(hash.value()));
    }
    std::sort(halves.begin(), halves.end());
    const auto last = std::unique(halves.begin(), halves.end());
    EXPECT_LT(halves.end() - last, 24);
}

TEST(StateHash, ValueIsFixedForEver)
{
    // Computed by an independent program from the definition: saved hashes must stay comparable.
    std::vector<std::uint64_t> words(11);
    for (std::size_t k = 0; k < words.size(); ++k) {
        words[k] = 0x0123456789abcdefULL * (k + 1);
    }
    EXPECT_EQ(hashWords(words), 0xef1e0af98b7a3c2dULL);
    StateHash hash;
    hash.add("sand", 4);
    hash.addWord(42);
    EXPECT_EQ(hash.value(), 0x69faa0b57f0009e2ULL);
}

}  // namespace
}  // namespace sandflow
