#include "transfer/bed_height.h"

#include <cmath>

namespace sandflow {
namespace {

/// Change of h per column along one axis.
double limitedSlope(const ColumnGrid& columns, std::int32_t span, int axis)
{
    const std::int32_t below = columns.link[span][2 * axis];
    const std::int32_t above = columns.link[span][2 * axis + 1];
    if (below == ColumnGrid::kNone || above == ColumnGrid::kNone) {
        return 0.0;
    }
    const double left = columns.h[span] - columns.h[below];
    const double right = columns.h[above] - columns.h[span];
    if (left * right <= 0.0) {
        return 0.0;
    }
    return std::abs(left) < std::abs(right) ? left : right;
}

}  // namespace

double bedHeightAt(const ColumnGrid& columns, std::int32_t span, double x, double y)
{
    const double u = x / columns.cellSize() - columns.columnI[span] - 0.5;
    const double v = y / columns.cellSize() - columns.columnJ[span] - 0.5;
    return columns.h[span] + u * limitedSlope(columns, span, 0) + v * limitedSlope(columns, span, 1);
}

}  // namespace sandflow
