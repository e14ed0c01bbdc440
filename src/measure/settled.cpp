#include "measure/settled.h"

#include "measure/grain_grid.h"

namespace sandflow {
namespace {

bool isHeld(const Snapshot& snapshot, std::size_t n)
{
    return snapshot.state[n] != GrainState::mobile;
}

bool isSlow(const Snapshot& snapshot, std::size_t n, const SettledRule& rule)
{
    return isHeld(snapshot, n) || snapshot.velocity[n].cast<double>().norm() <= rule.fastest;
}

bool liesOnFloor(const Snapshot& snapshot, std::size_t n, const FloorHeight& floor,
                 const SettledRule& rule)
{
    const Vec3& p = snapshot.position[n];
    const double radius = snapshot.radius[n];
    return p.z() - radius - floor(p.x(), p.y()) <= rule.widestGap * radius;
}

bool liesOnGrain(const Snapshot& snapshot, std::size_t n, const GrainGrid& grid,
                 const SettledRule& rule)
{
    const Vec3& p = snapshot.position[n];
    const double radius = snapshot.radius[n];
    bool carried = false;
    grid.visitNear(n, [&](std::size_t other) {
        const Vec3& q = snapshot.position[other];
        const double reach = radius * (1.0 + rule.widestGap) + double{snapshot.radius[other]};
        carried = q.z() < p.z() && (p - q).squaredNorm() <= reach * reach &&
                  isSlow(snapshot, other, rule);
        return !carried;
    });
    return carried;
}

}  // namespace

std::vector<std::uint8_t> findSettled(const Snapshot& snapshot, const FloorHeight& floor,
                                      const SettledRule& rule)
{
    std::vector<std::uint8_t> settled(snapshot.size(), 0);
    if (snapshot.size() == 0) {
        return settled;
    }
    const GrainGrid grid(snapshot, (2.0 + rule.widestGap) * findLargestRadius(snapshot));
    const auto count = static_cast<std::int64_t>(snapshot.size());
#pragma omp parallel for schedule(dynamic, 1024)
    for (std::int64_t i = 0; i < count; ++i) {
        const auto n = static_cast<std::size_t>(i);
        settled[n] = isHeld(snapshot, n) ||
                     (isSlow(snapshot, n, rule) && (liesOnFloor(snapshot, n, floor, rule) ||
                                                    liesOnGrain(snapshot, n, grid, rule)));
    }
    return settled;
}

}  // namespace sandflow
