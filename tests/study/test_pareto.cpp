#include "core/errors.h"
#include "study/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandflow {
namespace {

using Front = std::vector<std::size_t>;

TEST(Pareto, DominatingIsNoWorseInBothAndBetterInOne)
{
    EXPECT_TRUE(dominates({1.0, 0.1}, {2.0, 0.2}));
    EXPECT_TRUE(dominates({1.0, 0.2}, {2.0, 0.2}));
    EXPECT_TRUE(dominates({2.0, 0.1}, {2.0, 0.2}));
    EXPECT_FALSE(dominates({1.0, 0.2}, {1.0, 0.2}));
    EXPECT_FALSE(dominates({1.0, 0.3}, {2.0, 0.2}));
    EXPECT_FALSE(dominates({3.0, 0.1}, {2.0, 0.2}));
}

TEST(Pareto, ClearlyIsBeyondTheNoise)
{
    const ChoiceNoise noise{std::log(1.1), 0.05};
    const CostAndError shipped{1.0, 0.20};
    EXPECT_FALSE(dominatesClearly({0.95, 0.18}, shipped, noise));
    EXPECT_TRUE(dominatesClearly({0.95, 0.14}, shipped, noise));
    EXPECT_TRUE(dominatesClearly({0.90, 0.20}, shipped, noise));  // 1 / 0.9 is above 1.1
    EXPECT_FALSE(dominatesClearly({0.50, 0.21}, shipped, noise));  // cheap, but worse
}

TEST(Pareto, FrontOfAHandful)
{
    // The last equals the second.
    const std::vector<CostAndError> choices{{4.0, 0.1}, {1.0, 0.3}, {2.0, 0.4}, {0.5, 0.9},
                                            {1.0, 0.3}};
    EXPECT_EQ(findParetoFront(choices), (Front{3, 1, 0}));
    EXPECT_EQ(findParetoFront(std::vector<CostAndError>{}), Front{});
    EXPECT_EQ(findParetoFront(std::vector<CostAndError>{{1.0, 0.0}}), Front{0});
}

/// Against the definition, pair by pair.
TEST(Pareto, FrontIsWhatNobodyDominates)
{
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coarse(1, 12);  // so that ties happen
    for (int round = 0; round < 200; ++round) {
        std::vector<CostAndError> choices;
        for (int k = 0; k < 15; ++k) {
            choices.push_back({0.1 * coarse(random), 0.1 * coarse(random)});
        }
        std::vector<bool> onFront(choices.size(), false);
        const Front front = findParetoFront(choices);
        for (std::size_t k = 0; k < front.size(); ++k) {
            onFront[front[k]] = true;
            if (k > 0) {
                EXPECT_GT(choices[front[k]].cost, choices[front[k - 1]].cost);
                EXPECT_LT(choices[front[k]].error, choices[front[k - 1]].error);
            }
        }
        for (std::size_t a = 0; a < choices.size(); ++a) {
            bool expected = true;
            for (std::size_t b = 0; b < choices.size(); ++b) {
                const bool earlierTwin = b < a && choices[a].cost == choices[b].cost &&
                                         choices[a].error == choices[b].error;
                expected = expected && !dominates(choices[b], choices[a]) && !earlierTwin;
            }
            EXPECT_EQ(onFront[a], expected) << "round " << round << ", choice " << a;
        }
    }
}

TEST(Pareto, KneeIsTheCorner)
{
    // Along log2(cost) = 0 ... 4; the chord falls from 1 to 0, the corner lies 0.65 below it.
    const std::vector<CostAndError> choices{
        {1.0, 1.0}, {2.0, 0.1}, {4.0, 0.07}, {8.0, 0.03}, {16.0, 0.0}};
    const Front front = findParetoFront(choices);
    ASSERT_EQ(front.size(), 5u);
    EXPECT_EQ(findKnee(choices, front), 1u);
}

TEST(Pareto, KneeDoesNotDependOnUnits)
{
    const std::vector<CostAndError> choices{{1.0, 1.0}, {2.0, 0.5}, {4.0, 0.35}, {9.0, 0.2}};
    std::vector<CostAndError> scaled;
    for (const CostAndError& choice : choices) {
        scaled.push_back({137.0 * choice.cost, 0.01 * choice.error});
    }
    const auto knee = findKnee(choices, findParetoFront(choices));
    ASSERT_TRUE(knee.has_value());
    EXPECT_EQ(findKnee(scaled, findParetoFront(scaled)), knee);
}

TEST(Pareto, AStraightOrBulgingFrontHasNoKnee)
{
    const std::vector<CostAndError> two{{1.0, 1.0}, {2.0, 0.1}};
    EXPECT_FALSE(findKnee(two, findParetoFront(two)).has_value());
    const std::vector<CostAndError> bulging{{1.0, 1.0}, {2.0, 0.9}, {4.0, 0.1}};
    EXPECT_FALSE(findKnee(bulging, findParetoFront(bulging)).has_value());
}

}  // namespace
}  // namespace sandflow
