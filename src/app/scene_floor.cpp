#include "app/scene_floor.h"

#include "solids/free_intervals.h"
#include "solids/primitive.h"

namespace sandflow {
namespace {

constexpr double kBottomless = -1e29;  // m; below this there is no floor

}  // namespace

FloorHeight makeSceneFloor(const Scene& scene, double time)
{
    std::vector<Primitive> primitives;
    for (std::size_t s = 0; s < scene.solids.size(); ++s) {
        const auto parts = buildPrimitives(scene.solids[s], static_cast<int>(s));
        primitives.insert(primitives.end(), parts.begin(), parts.end());
    }
    // Room for one grain at least.
    const double gap = scene.diameter();
    return [primitives = std::move(primitives), time, gap](double x, double y) {
        std::vector<std::pair<double, double>> free;
        freeIntervals(primitives, time, x, y, gap, free);
        for (const auto& interval : free) {
            if (interval.first > kBottomless) {
                return interval.first;
            }
        }
        return 0.0;
    };
}

}  // namespace sandflow
