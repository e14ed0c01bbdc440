#pragma once

#include "bcre/columns.h"

namespace sandflow {

/// h [m] at (x, y) over a span: its own value plus the smaller of the two one-sided slopes on each
/// axis (none at a summit, a dip or a wall), so that the interface follows the heap's flank instead
/// of stepping from column to column.
double bedHeightAt(const ColumnGrid& columns, std::int32_t span, double x, double y);

}  // namespace sandflow
