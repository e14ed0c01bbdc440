#include "transfer/base_slip.h"

#include "bcre/smooth_spans.h"

#include <algorithm>

namespace sandflow {
namespace {

constexpr double kLevel = 0.2;      // of H: half the slope of the flattest heaps
constexpr int kSmoothings = 3;      // a surface of grains is rough over a column's width
constexpr double kAtFloor = 1e-6;   // m: a span begins at that solid

}  // namespace

const std::vector<std::uint8_t>& BaseSlip::find(const ColumnGrid& columns,
                                                std::span<const Primitive> solids, double time)
{
    slips_.clear();
    if (std::none_of(solids.begin(), solids.end(),
                     [&](const Primitive& solid) { return solid.isSmoothAt(time); })) {
        return slips_;
    }
    findSmoothFloors(columns, solids, time);
    findSlopes(columns);
    slips_.resize(columns.spanCount());
    for (std::size_t s = 0; s < slips_.size(); ++s) {
        slips_[s] = smooth_[s] && slope_[s].norm() > kLevel ? 1 : 0;
    }
    return slips_;
}

/// Spans keep their floor for as long as the solids stay.
void BaseSlip::findSmoothFloors(const ColumnGrid& columns, std::span<const Primitive> solids,
                                double time)
{
    for (std::size_t s = smooth_.size(); s < columns.spanCount(); ++s) {
        const double edge = columns.cellSize();
        const Vec3 base((columns.columnI[s] + 0.5) * edge, (columns.columnJ[s] + 0.5) * edge,
                        columns.floor[s]);
        smooth_.push_back(std::any_of(solids.begin(), solids.end(), [&](const Primitive& solid) {
            return solid.isSmoothAt(time) && nearestSurface(solid, base).distance < kAtFloor;
        }));
    }
}

void BaseSlip::findSlopes(const ColumnGrid& columns)
{
    const auto count = static_cast<std::int64_t>(columns.spanCount());
    slope_.resize(columns.spanCount());
#pragma omp parallel for schedule(static)
    for (std::int64_t s = 0; s < count; ++s) {
        for (int axis = 0; axis < 2; ++axis) {
            const std::int32_t before = columns.link[s][2 * axis];
            const std::int32_t after = columns.link[s][2 * axis + 1];
            const double run = (before != ColumnGrid::kNone) + (after != ColumnGrid::kNone);
            const double rise = columns.H[after == ColumnGrid::kNone ? s : after] -
                                columns.H[before == ColumnGrid::kNone ? s : before];
            slope_[s][axis] = run > 0.0 ? rise / (run * columns.cellSize()) : 0.0;
        }
    }
    smoothOverNeighbours(columns, kSmoothings, slope_, smoothed_);
}

}  // namespace sandflow
