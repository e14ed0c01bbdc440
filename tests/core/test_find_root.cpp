#include "core/find_root.h"

#include "core/errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sandflow {
namespace {

TEST(FindRoot, IsExactToTheLastBits)
{
    EXPECT_NEAR(findRoot([](double x) { return x * x - 2.0; }, 0.0, 2.0), std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(findRoot([](double x) { return std::cos(x); }, 0.0, 3.0), std::acos(0.0), 1e-12);
    EXPECT_EQ(findRoot([](double x) { return x - 0.25; }, 0.0, 1.0), 0.25);
}

TEST(FindRoot, RefusesAnIntervalWithoutASignChange)
{
    EXPECT_THROW(findRoot([](double x) { return x * x + 1.0; }, -1.0, 1.0), InternalError);
}

}  // namespace
}  // namespace sandflow
