#pragma once

#include "bcre/columns.h"
#include "mesh/mesh_columns.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sandflow::testing {

constexpr double kGrainDiameter = 0.01;  ///< m

/// What a mesh leaves free over a level ground (none: the void), by the rules for grains of
/// kGrainDiameter: no solid thinner than 1/40 of it, no gap up to one of it.
inline ColumnGrid::SpanSource makeMeshSource(const TriangleMesh& mesh, std::optional<double> ground)
{
    const auto solid = std::make_shared<const MeshColumns>(mesh, 0.25 * kGrainDiameter);
    return [=](double x, double y, std::vector<ColumnGrid::FreeInterval>& out) {
        std::vector<SolidInterval> stretches;
        solid->solidIntervalsAt(x, y, stretches);
        dropSlivers(0.025 * kGrainDiameter, stretches);
        double top = ground.value_or(-1e30);
        for (const SolidInterval& stretch : stretches) {
            if (stretch.lo - top > kGrainDiameter) {
                out.push_back({top, stretch.lo});
            }
            top = std::max(top, stretch.hi);
        }
        out.push_back({top, 1e30});
    };
}

/// A field with all columns whose centres are within `reach` of the z axis along x and y, and some
/// more.
inline ColumnGrid makeMeshField(double cellSize, double reach, const TriangleMesh& mesh,
                                std::optional<double> ground)
{
    ColumnGrid columns(cellSize, makeMeshSource(mesh, ground), {});
    const std::int32_t first = columns.cellIndex(-reach);
    const std::int32_t last = columns.cellIndex(reach);
    for (std::int32_t j = first; j <= last; ++j) {
        for (std::int32_t i = first; i <= last; ++i) {
            columns.ensureColumn(i, j);
        }
    }
    return columns;
}

inline Vec2 centreOf(const ColumnGrid& columns, std::size_t span)
{
    return {(columns.columnI[span] + 0.5) * columns.cellSize(),
            (columns.columnJ[span] + 0.5) * columns.cellSize()};
}

/// Which spans sand could reach from one of them, by links in either direction, never through spans
/// that are not `allowed`.
template <class Allowed>
std::vector<bool> spansReachedFrom(const ColumnGrid& columns, std::int32_t start,
                                   const Allowed& allowed)
{
    std::vector<std::vector<std::int32_t>> neighbours(columns.spanCount());
    const auto connect = [&](std::int32_t a, std::int32_t b) {
        neighbours[static_cast<std::size_t>(a)].push_back(b);
        neighbours[static_cast<std::size_t>(b)].push_back(a);
    };
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        for (const std::int32_t other : columns.link[s]) {
            if (other != ColumnGrid::kNone) {
                connect(static_cast<std::int32_t>(s), other);
            }
        }
    }
    for (const ColumnGrid::ExtraLink& extra : columns.extraLinks) {
        connect(extra.span, extra.other);
    }
    std::vector<bool> reached(columns.spanCount());
    std::vector<std::int32_t> open = {start};
    reached[static_cast<std::size_t>(start)] = true;
    while (!open.empty()) {
        const auto span = static_cast<std::size_t>(open.back());
        open.pop_back();
        for (const std::int32_t other : neighbours[span]) {
            const auto at = static_cast<std::size_t>(other);
            if (!reached[at] && allowed(at)) {
                reached[at] = true;
                open.push_back(other);
            }
        }
    }
    return reached;
}

}  // namespace sandflow::testing
