#include "measure/crater.h"

#include "core/errors.h"
#include "measure/height_map.h"
#include "measure/radial_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace sandflow {
namespace {

constexpr double kSank = 1.0;    // d: a point of the surface that sank by more has its grains gone
constexpr double kAsHigh = 0.1;  // d: what sand far away may settle in the meantime
constexpr double kMiddle = 2.0;  // d

/// The grains of `all` that are in `other` too. Ids ascend in both.
Snapshot keepShared(const Snapshot& all, const Snapshot& other)
{
    Snapshot kept;
    kept.frame = all.frame, kept.time = all.time, kept.meanRadius = all.meanRadius;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (std::binary_search(other.id.begin(), other.id.end(), all.id[k])) {
            kept.id.push_back(all.id[k]);
            kept.position.push_back(all.position[k]);
            kept.velocity.push_back(all.velocity[k]);
            kept.spin.push_back(all.spin[k]);
            kept.radius.push_back(all.radius[k]);
            kept.state.push_back(all.state[k]);
        }
    }
    return kept;
}

/// Mean place of the points whose surface sank, weighted with how far.
std::optional<Vec2> findMiddle(const HeightMap& before, const HeightMap& after)
{
    Vec2 moment = Vec2::Zero();
    double sum = 0.0;
    for (const HeightMap::Tile& tile : before.tiles()) {
        for (std::int32_t p = 0; p < HeightMap::kTilePoints; ++p) {
            const std::int32_t i = tile.i * HeightMap::kTileEdge + p % HeightMap::kTileEdge;
            const std::int32_t j = tile.j * HeightMap::kTileEdge + p / HeightMap::kTileEdge;
            const double fall = tile.height[p] - tile.floor[p] - after.depthAt(i, j);
            if (fall > kSank * before.diameter()) {
                sum += fall;
                moment += fall * Vec2(before.pointCoordinate(i), before.pointCoordinate(j));
            }
        }
    }
    return sum > 0.0 ? std::optional<Vec2>(moment / sum) : std::nullopt;
}

}  // namespace

CraterFigures measureCrater(const Snapshot& before, const Snapshot& after, const FloorHeight& floor)
{
    const Snapshot was = keepShared(before, after), is = keepShared(after, before);
    if (was.size() == 0) {
        throw InputError(fmt::format("frames {} and {} have no grain in common, so nothing can be "
                                     "said of a crater",
                                     before.frame, after.frame));
    }
    const double d = 2.0 * before.meanRadius;
    const HeightMap high(was, floor, d), low(is, floor, d);
    const std::optional<Vec2> middle = findMiddle(high, low);
    CraterFigures crater;
    if (!middle) {
        return crater;
    }
    crater.centre = *middle;
    crater.fall = averageOverAnnuli(high, crater.centre);
    const std::vector<double> later = averageOverAnnuli(low, crater.centre);
    crater.fall.resize(std::max(crater.fall.size(), later.size()), 0.0);
    for (std::size_t k = 0; k < later.size(); ++k) {
        crater.fall[k] -= later[k];
    }
    crater.depth = std::max(averageOverDisc(high, crater.centre, kMiddle * d) -
                                averageOverDisc(low, crater.centre, kMiddle * d),
                            0.0);
    // A hollow may have a hill in its very middle, and annuli there are too small to mean much.
    const auto inner = static_cast<std::size_t>(kMiddle);
    std::size_t ring = 0;
    while (ring < crater.fall.size() && (ring < inner || crater.fall[ring] > kAsHigh * d)) {
        crater.volume += crater.fall[ring] * annulusArea(ring) * d * d;
        crater.depth = std::max(crater.depth, ring < inner ? 0.0 : crater.fall[ring]);
        ++ring;
    }
    crater.rim = static_cast<double>(ring) * d;
    return crater;
}

}  // namespace sandflow
