#include "measure/height_map.h"

#include "measure/settled.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandflow {

HeightMap::HeightMap(const Snapshot& snapshot, const FloorHeight& floor, double diameter)
    : diameter_(diameter)
{
    SAND_CHECK(diameter > 0.0, "mean grain diameter {} m", diameter);
    const std::vector<std::uint8_t> isSettled = findSettled(snapshot, floor);
    for (std::size_t n = 0; n < isSettled.size(); ++n) {
        if (isSettled[n]) {
            settled_.push_back(static_cast<std::uint32_t>(n));
        }
    }
    makeTiles(snapshot);
    fillTiles(snapshot, floor);
}

void HeightMap::makeTiles(const Snapshot& snapshot)
{
    // Tiles that the square around each grain meets: usually one, up to four.
    const double inverseTile = 1.0 / (kTileEdge * spacing());
    std::vector<std::pair<std::uint64_t, std::uint32_t>> meets;  // tile key, grain
    meets.reserve(settled_.size() + settled_.size() / 2);
    for (const std::uint32_t n : settled_) {
        const Vec3& p = snapshot.position[n];
        const double radius = snapshot.radius[n];
        const std::int32_t lastI = cellCoordinate(p.x() + radius, inverseTile);
        const std::int32_t lastJ = cellCoordinate(p.y() + radius, inverseTile);
        for (std::int32_t j = cellCoordinate(p.y() - radius, inverseTile); j <= lastJ; ++j) {
            for (std::int32_t i = cellCoordinate(p.x() - radius, inverseTile); i <= lastI; ++i) {
                meets.emplace_back(packCellKey(i, j, 0), n);
            }
        }
    }
    std::sort(meets.begin(), meets.end());

    for (std::size_t m = 0; m < meets.size(); ++m) {
        if (m == 0 || meets[m].first != meets[m - 1].first) {
            const CellIndex cell = unpackCellKey(meets[m].first);
            tileIndex_.insert(meets[m].first, static_cast<std::uint32_t>(tiles_.size()));
            tiles_.push_back(Tile{cell.i, cell.j, {}, {}});
            overBegin_.push_back(static_cast<std::uint32_t>(m));
        }
        over_.push_back(meets[m].second);
    }
    overBegin_.push_back(static_cast<std::uint32_t>(over_.size()));
}

// Each tile is one thread's own, and a maximum does not depend on the order of the grains.
void HeightMap::fillTiles(const Snapshot& snapshot, const FloorHeight& floor)
{
    const auto tileCount = static_cast<std::int64_t>(tiles_.size());
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t t = 0; t < tileCount; ++t) {
        Tile& tile = tiles_[t];
        for (std::int32_t p = 0; p < kTilePoints; ++p) {
            const std::int64_t i = std::int64_t{tile.i} * kTileEdge + p % kTileEdge;
            const std::int64_t j = std::int64_t{tile.j} * kTileEdge + p / kTileEdge;
            tile.floor[p] = floor(pointCoordinate(i), pointCoordinate(j));
        }
        tile.height = tile.floor;
        for (std::uint32_t at = overBegin_[t]; at < overBegin_[t + 1]; ++at) {
            raiseTile(tile, snapshot.position[over_[at]], snapshot.radius[over_[at]]);
        }
    }
}

void HeightMap::raiseTile(Tile& tile, const Vec3& position, double radius) const
{
    const std::int64_t baseI = std::int64_t{tile.i} * kTileEdge;
    const std::int64_t baseJ = std::int64_t{tile.j} * kTileEdge;
    // First and last point of the tile that the sphere can cover, along one axis.
    const auto range = [&](double centre, std::int64_t base) {
        const double first = std::ceil((centre - radius) / spacing() - 0.5);
        const double last = std::floor((centre + radius) / spacing() - 0.5);
        return std::pair{
            std::max<std::int64_t>(static_cast<std::int64_t>(first) - base, 0),
            std::min<std::int64_t>(static_cast<std::int64_t>(last) - base, kTileEdge - 1)};
    };
    const auto [firstI, lastI] = range(position.x(), baseI);
    const auto [firstJ, lastJ] = range(position.y(), baseJ);
    for (std::int64_t j = firstJ; j <= lastJ; ++j) {
        const double dy = pointCoordinate(baseJ + j) - position.y();
        for (std::int64_t i = firstI; i <= lastI; ++i) {
            const double dx = pointCoordinate(baseI + i) - position.x();
            // The upper half of a sphere: z = z0 + sqrt(r^2 - dx^2 - dy^2).
            const double rest = radius * radius - dx * dx - dy * dy;
            if (rest >= 0.0) {
                double& height = tile.height[j * kTileEdge + i];
                height = std::max(height, position.z() + std::sqrt(rest));
            }
        }
    }
}

const HeightMap::Tile* HeightMap::findTile(std::int32_t i, std::int32_t j) const
{
    const std::uint32_t* at = tileIndex_.find(packCellKey(i, j, 0));
    return at ? &tiles_[*at] : nullptr;
}

std::int32_t HeightMap::pointIndex(double coordinate) const
{
    const double index = std::floor(coordinate / spacing());
    SAND_CHECK(std::abs(index) < double{kTileEdge} * kCellIndexLimit,
               "coordinate {} m is off the height map", coordinate);
    return static_cast<std::int32_t>(index);
}

double HeightMap::depthAt(std::int32_t i, std::int32_t j) const
{
    const auto tileOf = [](std::int32_t point) {
        return point >= 0 ? point / kTileEdge : -((-point - 1) / kTileEdge) - 1;
    };
    const Tile* tile = findTile(tileOf(i), tileOf(j));
    if (tile == nullptr) {
        return 0.0;
    }
    const std::int32_t at = (j - tileOf(j) * kTileEdge) * kTileEdge + i - tileOf(i) * kTileEdge;
    return tile->height[at] - tile->floor[at];
}

}  // namespace sandflow
