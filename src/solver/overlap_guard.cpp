#include "solver/overlap_guard.h"

#include <algorithm>

namespace sandflow {

template <class Real>
void OverlapGuard<Real>::admit(const Dem<Real>& dem, const SolidSet& solids, double time,
                               std::size_t retries, std::vector<NewGrain>& waiting, std::vector<NewGrain>& accepted)
{
    if (waiting.empty()) {
        return;
    }
    const double widest = 2.0 * dem.setup().largestRadius;
    Eigen::AlignedBox3d box;
    double largest = 0.0;
    for (const NewGrain& g : waiting) {
        box.extend(g.position);
        largest = std::max(largest, g.radius);
    }
    const Vec3 margin = Vec3::Constant(widest + largest);
    box.extend(Vec3(box.max() + margin));
    box.extend(Vec3(box.min() - margin));

    near_.clear();
    nearRadius_.clear();
    const auto collect = [&](const std::vector<GrainRecord<Real>>& records) {
        for (const GrainRecord<Real>& g : records) {
            const Vec3 p(g.x, g.y, g.z);
            if (box.contains(p)) {
                near_.push_back(p);
                nearRadius_.push_back(static_cast<double>(g.radius));
            }
        }
    };
    collect(dem.mobile().record);
    collect(dem.frozen().records());
    collect(dem.boundary().records());
    SortedCells cells(widest + largest);
    cells.build(near_);

    const auto hasRoom = [&](const NewGrain& g) {
        const double allowed = kLimit * g.radius;
        for (const Primitive& wall : solids.primitives()) {
            // Between the bumps of a rough plane grains rest a little deeper than on it.
            const double sinks = allowed + (wall.rough ? 0.25 * g.radius : 0.0);
            if (wall.existsAt(time) &&
                nearestSurface(wall, g.position).distance < g.radius - sinks) {
                return false;
            }
        }
        bool free = std::none_of(
            solids.meshes().begin(), solids.meshes().end(), [&](const MeshSolid& mesh) {
                return mesh.existsAt(time) && mesh.columns.contains(g.position);
            });
        cells.visitNear(cells.cellOf(g.position), 1, [&](const SortedCells::Cell& cell) {
            for (std::uint32_t e = cell.begin; e < cell.end; ++e) {
                const std::uint32_t other = cells.order()[e];
                const double reach = g.radius + nearRadius_[other] -
                                     std::min(allowed, kLimit * nearRadius_[other]);
                free = free && (near_[other] - g.position).squaredNorm() >= reach * reach;
            }
        });
        return free;
    };
    const std::size_t firstAccepted = accepted.size();
    const auto clearsAccepted = [&](const NewGrain& g) {
        return std::none_of(accepted.begin() + static_cast<std::ptrdiff_t>(firstAccepted),
                            accepted.end(), [&](const NewGrain& other) {
                                const double reach = (g.radius + other.radius) * (1.0 - kLimit / 2);
                                return (other.position - g.position).squaredNorm() < reach * reach;
                            });
    };
    std::vector<NewGrain> turnedAway;
    for (std::size_t k = retries; k < waiting.size(); ++k) {
        (hasRoom(waiting[k]) ? accepted : turnedAway).push_back(waiting[k]);
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < retries; ++k) {
        if (hasRoom(waiting[k]) && clearsAccepted(waiting[k])) {
            accepted.push_back(waiting[k]);
        } else {
            waiting[kept++] = waiting[k];
        }
    }
    waiting.resize(kept);
    waiting.insert(waiting.end(), turnedAway.begin(), turnedAway.end());
}

template class OverlapGuard<float>;
template class OverlapGuard<double>;

}  // namespace sandflow
