#include <gtest/gtest.h>

#include <set>

#include "core/errors.h"
#include "core/random.h"

namespace sandflow {
namespace {

std::vector<double> drawSome(Random& random, int count)
{
    std::vector<double> values;
    for (int k = 0; k < count; ++k) {
        values.push_back(random.uniform(0.0, 1.0));
    }
    return values;
}

TEST(Random, EverySeedEmitterAndUseHasItsOwnStream)
{
    std::set<std::vector<double>> streams;
    for (std::uint64_t seed : {0ULL, 1ULL, 2ULL, 1ULL << 40}) {
        for (std::uint64_t emitter = 0; emitter < 3; ++emitter) {
            for (RandomUse use : {RandomUse::sizes, RandomUse::places}) {
                Random random(seed, emitter, use);
                streams.insert(drawSome(random, 4));
            }
        }
    }
    EXPECT_EQ(streams.size(), 24U);
}

TEST(Random, SameSeedGivesSameNumbers)
{
    Random a(7, 1, RandomUse::sizes);
    Random b(7, 1, RandomUse::sizes);
    EXPECT_EQ(drawSome(a, 100), drawSome(b, 100));
}

TEST(Random, NumbersStayInRangeAndAverageOut)
{
    Random random(3, 0, RandomUse::places);
    double sum = 0.0;
    std::vector<int> histogram(5, 0);
    const int draws = 100000;
    for (int k = 0; k < draws; ++k) {
        const double value = random.uniform(-2.0, 4.0);
        ASSERT_GE(value, -2.0);
        ASSERT_LT(value, 4.0);
        sum += value;
        ++histogram.at(static_cast<std::size_t>(random.below(5)));
    }
    EXPECT_NEAR(sum / draws, 1.0, 0.03);  // standard error 6 / sqrt(12 * 1e5) = 0.0055
    for (const int hits : histogram) {
        EXPECT_NEAR(hits, draws / 5, 700);  // 5.5 standard errors
    }
}

TEST(Random, SavedStateGoesOnWithTheSameNumbers)
{
    Random random(11, 2, RandomUse::packing);
    drawSome(random, 17);
    const std::vector<std::uint8_t> state = random.saveState();
    const std::vector<double> expected = drawSome(random, 50);
    Random other(99, 5, RandomUse::sizes);
    other.loadState(state);
    EXPECT_EQ(drawSome(other, 50), expected);
}

TEST(Random, ForeignStateIsRefused)
{
    Random random(1, 0, RandomUse::sizes);
    EXPECT_THROW(random.loadState({1, 2, 3}), InputError);
}

}  // namespace
}  // namespace sandflow
