#include "bcre/smooth_spans.h"

#include "test_fields.h"

#include <gtest/gtest.h>

namespace sandflow::testing {
namespace {

TEST(SmoothSpans, APeakIsSharedWithTheFourNeighbours)
{
    const ColumnGrid columns = makeFlatBox(5, 5, 0.03);
    const auto at = [&](int i, int j) {
        return static_cast<std::size_t>(columns.spansOf(i, j).first);
    };
    std::vector<double> values(columns.spanCount(), 0.0), scratch;
    values[at(2, 2)] = 5.0;
    smoothOverNeighbours(columns, 1, values, scratch);
    EXPECT_DOUBLE_EQ(values[at(2, 2)], 1.0);
    EXPECT_DOUBLE_EQ(values[at(1, 2)], 1.0);
    EXPECT_DOUBLE_EQ(values[at(2, 3)], 1.0);
    EXPECT_EQ(values[at(1, 1)], 0.0) << "not diagonally";
    EXPECT_EQ(values[at(4, 2)], 0.0);
}

TEST(SmoothSpans, WallsNeitherAddNorTake)
{
    const ColumnGrid columns = makeFlatBox(4, 3, 0.03);
    std::vector<double> values(columns.spanCount(), 0.25), scratch;
    smoothOverNeighbours(columns, 3, values, scratch);
    for (const double value : values) {
        EXPECT_DOUBLE_EQ(value, 0.25);
    }
}

}  // namespace
}  // namespace sandflow::testing
