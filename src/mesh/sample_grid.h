#pragma once

#include "core/cell_key.h"
#include "core/cell_map.h"
#include "core/vec3.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Samples of a surface, growing, that can be found by place.
///
/// Cells are two reaches wide, so a ball of one reach meets two of them per axis:
///
///     +-------+-------+
///     |     __|_      |     cell -> newest sample in it -> the one before -> ... -> kNone
///     |    (  p )     |
///     +-----\-|/------+
///     |       |       |
///     +-------+-------+
class SampleGrid {
public:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    /// `corner` is the lower corner of a box that holds all points to come; lengths in m. The box
    /// must be less than 2^20 cells wide, that is 2^21 reaches.
    SampleGrid(const Vec3& corner, double reach)
        : corner_(corner), reach_(reach), inverseCell_(0.5 / reach)
    {
    }

    std::size_t size() const { return points.size(); }

    void add(const Vec3& point, const Vec3& normal)
    {
        const auto index = static_cast<std::uint32_t>(points.size());
        points.push_back(point);
        normals.push_back(normal);
        const Vec3 offset = point - corner_;
        const std::uint64_t key =
            packCellKey(cellOf(offset.x()), cellOf(offset.y()), cellOf(offset.z()));
        const auto [newest, isNew] = newestInCell_.insert(key, index);
        before_.push_back(isNew ? kNone : *newest);
        *newest = index;
    }

    /// The first sample that `accepts(index)` among those in the cells about `point`, which include
    /// all within reach; kNone if there is none.
    template <typename Accept>
    std::uint32_t findNear(const Vec3& point, const Accept& accepts) const
    {
        const Vec3 low = point - corner_ - Vec3::Constant(reach_);
        const Vec3 high = point - corner_ + Vec3::Constant(reach_);
        const std::int32_t iEnd = cellOf(high.x());
        const std::int32_t jEnd = cellOf(high.y());
        const std::int32_t kEnd = cellOf(high.z());
        for (std::int32_t k = cellOf(low.z()); k <= kEnd; ++k) {
            for (std::int32_t j = cellOf(low.y()); j <= jEnd; ++j) {
                for (std::int32_t i = cellOf(low.x()); i <= iEnd; ++i) {
                    const std::uint32_t* newest = newestInCell_.find(packCellKey(i, j, k));
                    for (std::uint32_t s = newest ? *newest : kNone; s != kNone; s = before_[s]) {
                        if (accepts(s)) {
                            return s;
                        }
                    }
                }
            }
        }
        return kNone;
    }

    std::vector<Vec3> points;   ///< m, in the order they were added
    std::vector<Vec3> normals;  ///< of unit length, outward

private:
    std::int32_t cellOf(double offset) const { return cellCoordinate(offset, inverseCell_); }

    Vec3 corner_;
    double reach_;        ///< m
    double inverseCell_;  ///< 1/m
    CellMap newestInCell_;
    std::vector<std::uint32_t> before_;  ///< the next older sample in the same cell
};

}  // namespace sandflow
