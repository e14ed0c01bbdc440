#include "scene/did_you_mean.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

TEST(DidYouMean, CountsTheStepsBetweenWords)
{
    EXPECT_EQ(editDistance("rate", "rate"), 0);
    EXPECT_EQ(editDistance("rte", "rate"), 1);
    EXPECT_EQ(editDistance("rrate", "rate"), 1);
    EXPECT_EQ(editDistance("rade", "rate"), 1);
    EXPECT_EQ(editDistance("raet", "rate"), 1) << "a swap is one step";
    EXPECT_EQ(editDistance("kitten", "sitting"), 3);
    EXPECT_EQ(editDistance("", "abc"), 3);
    EXPECT_EQ(editDistance("Look-At", "look_at"), 0);
}

TEST(DidYouMean, OffersOnlyWhatIsNear)
{
    const std::vector<std::string> keys = {"min", "max", "name", "radius", "rate"};
    EXPECT_EQ(findNearest("raduis", keys), "radius");
    EXPECT_EQ(findNearest("mx", keys), "max");
    EXPECT_EQ(findNearest("colour", keys), "");
    EXPECT_EQ(findNearest("xyz", keys), "") << "two letters of three are another word";
    EXPECT_EQ(findNearest("mix", keys), "min") << "the first of two at the same distance";
    EXPECT_EQ(findNearest(std::string(1 << 20, 'r'), keys), "");
    EXPECT_EQ(findNearest("rate", {}), "");
}

}  // namespace
}  // namespace sandflow
