#include "emit/ball_grid.h"

#include "core/errors.h"

namespace sandflow {

BallGrid::BallGrid(const Vec2& lo, const Vec2& hi, double floor, double cell)
    : lo_(lo),
      floor_(floor),
      cell_(cell),
      nx_(cellIndex(hi.x() - lo.x()) + 1),
      ny_(cellIndex(hi.y() - lo.y()) + 1)
{
    SAND_CHECK(nx_ >= 1 && ny_ >= 1, "grid of {} x {} columns", nx_, ny_);
    top_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), -1);
}

void BallGrid::add(const Vec3& centre, double radius)
{
    const int i = std::clamp(cellIndex(centre.x() - lo_.x()), 0, nx_ - 1);
    const int j = std::clamp(cellIndex(centre.y() - lo_.y()), 0, ny_ - 1);
    const int k = std::max(0, cellIndex(centre.z() - floor_));
    const std::size_t where = column(i, j);
    while (layers_.size() <= static_cast<std::size_t>(k)) {
        layers_.emplace_back(top_.size(), -1);
    }
    top_[where] = std::max(top_[where], k);
    std::int32_t& head = layers_[static_cast<std::size_t>(k)][where];
    next_.push_back(head);
    head = static_cast<std::int32_t>(balls_.size());
    balls_.push_back({centre, radius});
}

}  // namespace sandflow
