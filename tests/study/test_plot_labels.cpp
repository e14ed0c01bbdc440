#include "study/plot_labels.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

using Chosen = std::vector<bool>;

TEST(PlotLabels, FarApartAllAreWritten)
{
    const std::vector<PlotLabel> labels{{0, 0, "one"}, {0, 5, "two"}, {20, 0, "three"}};
    EXPECT_EQ(chooseLabels(labels), (Chosen{true, true, true}));
}

TEST(PlotLabels, OfTwoInOnePlaceTheFirstIsWritten)
{
    const std::vector<PlotLabel> labels{{0, 0, "longer"}, {0, 0.8, "two"}};
    EXPECT_EQ(chooseLabels(labels), (Chosen{true, false}));
}

TEST(PlotLabels, ATextNeverHidesAPoint)
{
    // The second point lies where the fourth letter of the first text would be.
    const std::vector<PlotLabel> labels{{0, 0, "longer"}, {5, 0, ""}};
    EXPECT_EQ(chooseLabels(labels), (Chosen{false, true}));
    // To the left of its point it is out of the way.
    const std::vector<PlotLabel> left{{0, 0, "longer", true}, {5, 0, ""}};
    EXPECT_EQ(chooseLabels(left), (Chosen{true, true}));
    // Behind its end it does not.
    const std::vector<PlotLabel> apart{{0, 0, "longer"}, {8, 0, ""}};
    EXPECT_EQ(chooseLabels(apart), (Chosen{true, true}));
}

}  // namespace
}  // namespace sandflow
