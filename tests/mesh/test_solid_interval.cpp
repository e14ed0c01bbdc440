#include "mesh/solid_interval.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

std::vector<std::pair<double, double>> withoutSlivers(double least,
                                                      std::vector<SolidInterval> stretches)
{
    dropSlivers(least, stretches);
    std::vector<std::pair<double, double>> pairs;
    for (const SolidInterval& stretch : stretches) {
        pairs.emplace_back(stretch.lo, stretch.hi);
    }
    return pairs;
}

using Pairs = std::vector<std::pair<double, double>>;

TEST(Slivers, GoAndTheOthersStay)
{
    EXPECT_EQ(withoutSlivers(0.25, {{0.0, 1.0}, {2.0, 2.125}, {3.0, 3.25}, {4.0, 4.0}}),
              (Pairs{{0.0, 1.0}, {3.0, 3.25}}));
    EXPECT_EQ(withoutSlivers(0.25, {}), Pairs{});
    EXPECT_EQ(withoutSlivers(0.25, {{1.0, 1.125}}), Pairs{});
    EXPECT_EQ(withoutSlivers(0.0, {{1.0, 1.0}, {2.0, 3.0}}), (Pairs{{1.0, 1.0}, {2.0, 3.0}}));
}

TEST(Slivers, ThoseThatTouchAreOneStretch)
{
    EXPECT_EQ(withoutSlivers(0.25, {{0.0, 0.125}, {0.125, 0.25}, {0.5, 0.625}}),
              (Pairs{{0.0, 0.25}}));
}

}  // namespace
}  // namespace sandflow
