#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace sandflow {

/// Spheres at rest on a floor, by cubic cells; layers of cells are added as the bed grows, so an
/// empty sky costs nothing.
class BallGrid {
public:
    struct Ball {
        Vec3 centre;    ///< m
        double radius;  ///< m
    };

    /// Spheres of radius up to cell / 2 with centres within [lo, hi] and above floor.
    BallGrid(const Vec2& lo, const Vec2& hi, double floor, double cell);

    const Ball& ball(std::int32_t index) const { return balls_[static_cast<std::size_t>(index)]; }

    void add(const Vec3& centre, double radius);

    /// Calls visit(index, ball) for every sphere whose cell touches the box [lo, hi].
    template <typename Visit>
    void forEachIn(const Vec3& lo, const Vec3& hi, Visit&& visit) const
    {
        const int z0 = std::max(0, cellIndex(lo.z() - floor_));
        const int z1 = std::min(static_cast<int>(layers_.size()) - 1, cellIndex(hi.z() - floor_));
        const Range range = columnRange(lo.head<2>(), hi.head<2>());
        for (int k = z0; k <= z1; ++k) {
            visitLayer(k, range, visit);
        }
    }

    /// Calls visit(index, ball) for the spheres about the vertical line through p that lie within
    /// `reach` of it, from the layer of cells at height `top` downwards; after each layer
    /// goOn(height of its bottom) says whether to look at the next.
    template <typename Visit, typename GoOn>
    void forEachBelow(const Vec2& p, double reach, double top, Visit&& visit, GoOn&& goOn) const
    {
        const Range range = columnRange(p - Vec2::Constant(reach), p + Vec2::Constant(reach));
        int k = std::min(cellIndex(top - floor_), highestLayer(range));
        for (; k >= 0; --k) {
            visitLayer(k, range, visit);
            if (!goOn(floor_ + cell_ * static_cast<double>(k))) {
                return;
            }
        }
    }

private:
    struct Range {
        int x0, x1, y0, y1;
    };

    int cellIndex(double length) const
    {
        const double index = length / cell_;
        return index < -1.0 ? -1 : index > 1e9 ? 1000000000 : static_cast<int>(index + 1.0) - 1;
    }

    Range columnRange(const Vec2& lo, const Vec2& hi) const
    {
        return {std::max(0, cellIndex(lo.x() - lo_.x())),
                std::min(nx_ - 1, cellIndex(hi.x() - lo_.x())),
                std::max(0, cellIndex(lo.y() - lo_.y())),
                std::min(ny_ - 1, cellIndex(hi.y() - lo_.y()))};
    }

    std::size_t column(int i, int j) const
    {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) +
               static_cast<std::size_t>(i);
    }

    int highestLayer(const Range& range) const
    {
        int highest = -1;
        for (int j = range.y0; j <= range.y1; ++j) {
            for (int i = range.x0; i <= range.x1; ++i) {
                highest = std::max(highest, top_[column(i, j)]);
            }
        }
        return highest;
    }

    template <typename Visit>
    void visitLayer(int k, const Range& range, Visit&& visit) const
    {
        const std::vector<std::int32_t>& heads = layers_[static_cast<std::size_t>(k)];
        for (int j = range.y0; j <= range.y1; ++j) {
            for (int i = range.x0; i <= range.x1; ++i) {
                for (std::int32_t b = heads[column(i, j)]; b >= 0;
                     b = next_[static_cast<std::size_t>(b)]) {
                    visit(b, balls_[static_cast<std::size_t>(b)]);
                }
            }
        }
    }

    Vec2 lo_;
    double floor_, cell_;
    int nx_, ny_;
    std::vector<std::vector<std::int32_t>> layers_;  ///< first sphere of each cell or -1
    std::vector<int> top_;                           ///< highest used layer of each column or -1
    std::vector<Ball> balls_;
    std::vector<std::int32_t> next_;
};

}  // namespace sandflow
