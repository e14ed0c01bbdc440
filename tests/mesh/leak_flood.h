#pragma once

#include "core/vec3.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <vector>

namespace sandflow {

/// The static leak test. Space is cut into cells; those whose centre is nearer to a sample than
/// `blocked` are closed. A flood of the open ones shows where a grain could get that stays that far
/// from all samples.
class LeakFlood {
public:
    LeakFlood(const std::vector<Vec3>& samples, const Eigen::AlignedBox3d& box, double cell,
              double blocked)
        : corner_(box.min()), cell_(cell)
    {
        for (int d = 0; d < 3; ++d) {
            size_[d] = static_cast<int>(std::ceil(box.sizes()[d] / cell));
        }
        isClosed_.assign(static_cast<std::size_t>(size_.prod()), 0);
        for (const Vec3& sample : samples) {
            close(sample, blocked);
        }
    }

    /// Counts the flooded cells that are `isForbidden(centre)`. The flood begins in the cell of
    /// `source` and goes from cell to cell across faces, only where it `mayGo(centre)`.
    template <typename MayGo, typename IsForbidden>
    std::size_t countReached(const Vec3& source, const MayGo& mayGo,
                             const IsForbidden& isForbidden) const
    {
        std::vector<std::uint8_t> isShut = isClosed_;
        std::vector<Eigen::Array3i> front;
        const auto enter = [&](const Eigen::Array3i& at) {
            if ((at >= 0).all() && (at < size_).all() && !isShut[indexOf(at)] &&
                mayGo(centreOf(at))) {
                isShut[indexOf(at)] = 1;
                front.push_back(at);
            }
        };
        enter(((source - corner_).array() / cell_).floor().cast<int>());
        std::size_t reached = 0;
        while (!front.empty()) {
            const Eigen::Array3i at = front.back();
            front.pop_back();
            reached += isForbidden(centreOf(at)) ? 1 : 0;
            for (int d = 0; d < 3; ++d) {
                for (const int step : {-1, 1}) {
                    Eigen::Array3i next = at;
                    next[d] += step;
                    enter(next);
                }
            }
        }
        return reached;
    }

private:
    void close(const Vec3& sample, double blocked)
    {
        const Eigen::Array3d middle = (sample - corner_).array() / cell_ - 0.5;
        const double reach = blocked / cell_;
        const Eigen::Array3i low = (middle - reach).ceil().cast<int>().max(0);
        const Eigen::Array3i high = (middle + reach).floor().cast<int>().min(size_ - 1);
        for (int k = low.z(); k <= high.z(); ++k) {
            for (int j = low.y(); j <= high.y(); ++j) {
                for (int i = low.x(); i <= high.x(); ++i) {
                    const Eigen::Array3i at(i, j, k);
                    if ((centreOf(at) - sample).squaredNorm() < blocked * blocked) {
                        isClosed_[indexOf(at)] = 1;
                    }
                }
            }
        }
    }

    std::size_t indexOf(const Eigen::Array3i& at) const
    {
        return static_cast<std::size_t>(at.x() + size_.x() * (at.y() + size_.y() * at.z()));
    }

    Vec3 centreOf(const Eigen::Array3i& at) const
    {
        return corner_ + cell_ * (at.cast<double>() + 0.5).matrix();
    }

    Vec3 corner_;
    double cell_;
    Eigen::Array3i size_;
    std::vector<std::uint8_t> isClosed_;
};

}  // namespace sandflow
