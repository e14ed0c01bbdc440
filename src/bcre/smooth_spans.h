#pragma once

#include "bcre/columns.h"

#include <vector>

namespace sandflow {

/// Every span's value becomes the mean of its own and its neighbours', `passes` times. `scratch` is
/// room to work in, kept by the caller.
template <class Value>
void smoothOverNeighbours(const ColumnGrid& columns, int passes, std::vector<Value>& values,
                          std::vector<Value>& scratch)
{
    const auto count = static_cast<std::int64_t>(values.size());
    scratch.resize(values.size());
    for (int pass = 0; pass < passes; ++pass) {
#pragma omp parallel for schedule(static)
        for (std::int64_t s = 0; s < count; ++s) {
            Value sum = values[s];
            double parts = 1.0;
            for (const std::int32_t other : columns.link[s]) {
                if (other != ColumnGrid::kNone) {
                    sum += values[other];
                    parts += 1.0;
                }
            }
            scratch[s] = sum / parts;
        }
        values.swap(scratch);
    }
}

}  // namespace sandflow
