#include "app/scene_floor.h"

#include "solids/solid_set.h"

#include <memory>

namespace sandflow {
namespace {

constexpr double kBottomless = -1e29;  // m; below this there is no floor

}  // namespace

FloorHeight makeSceneFloor(const Scene& scene, double time)
{
    return [solids = std::make_shared<const SolidSet>(scene), time](double x, double y) {
        std::vector<FreeStretch> free;
        solids->freeStretches(time, x, y, 0.0, free);
        for (const FreeStretch& stretch : free) {
            if (stretch.floor > kBottomless) {
                return stretch.floor;
            }
        }
        return 0.0;
    };
}

}  // namespace sandflow
