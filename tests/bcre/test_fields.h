#pragma once

#include "bcre/columns.h"

#include <cmath>
#include <functional>

namespace sandflow::testing {

/// Columns (i, j) with 0 <= i < countI and 0 <= j < countJ over a floor of the given height; solid
/// all around. countJ = 1 is a strip: the one-dimensional model.
inline ColumnGrid makeBox(int countI, int countJ, double cellSize,
                          const std::function<double(double, double)>& floorAt)
{
    const double endX = countI * cellSize;
    const double endY = countJ * cellSize;
    ColumnGrid columns(
        cellSize,
        [=](double x, double y, std::vector<ColumnGrid::FreeInterval>& out) {
            if (x > 0.0 && x < endX && y > 0.0 && y < endY) {
                out.push_back({floorAt(x, y), 1e30});
            }
        },
        {});
    for (int j = 0; j < countJ; j += ColumnGrid::kTileEdge) {
        for (int i = 0; i < countI; i += ColumnGrid::kTileEdge) {
            columns.ensureColumn(i, j);
        }
    }
    columns.ensureColumn(countI - 1, countJ - 1);
    return columns;
}

inline ColumnGrid makeFlatBox(int countI, int countJ, double cellSize)
{
    return makeBox(countI, countJ, cellSize, [](double, double) { return 0.0; });
}

/// The only span of column (i, j).
inline std::size_t at(const ColumnGrid& columns, int i, int j = 0)
{
    return static_cast<std::size_t>(columns.spansOf(i, j).first);
}

/// Fills the field with a bed and a flowing layer given at the centres of the columns.
inline void fill(ColumnGrid& columns, const std::function<double(double, double)>& bed,
                 const std::function<double(double, double)>& flow)
{
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const double x = (columns.columnI[s] + 0.5) * columns.cellSize();
        const double y = (columns.columnJ[s] + 0.5) * columns.cellSize();
        columns.h[s] = bed(x, y);
        columns.R[s] = flow(x, y);
        columns.H[s] = columns.h[s] + columns.R[s];
    }
}

/// Sum of h + R over all spans, m.
inline double totalDepth(const ColumnGrid& columns)
{
    double sum = 0.0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        sum += columns.h[s] + columns.R[s];
    }
    return sum;
}

}  // namespace sandflow::testing
