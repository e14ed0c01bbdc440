#pragma once

#include "core/cell_map.h"
#include "grains/snapshot.h"
#include "measure/floor.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Height H of the accumulated sand on a horizontal sub-grid: at each point the highest sphere cap
/// over it, the floor where there is none. Grains in the air are left out (see settled.h).
///
///     spacing 0.5 d, d = mean grain diameter; point (i, j) lies at ((i + 0.5), (j + 0.5)) 0.5 d
///     tiles of 10 x 10 points = 5 d x 5 d, made only where there is sand: the plane is unbounded
///
/// Two maps of the same d share their points. A grain of less than 0.7 spacings across may fall
/// between them.
class HeightMap {
public:
    static constexpr std::int32_t kTileEdge = 10;
    static constexpr std::int32_t kTilePoints = kTileEdge * kTileEdge;

    struct Tile {
        std::int32_t i = 0;  ///< holds points kTileEdge * i ... kTileEdge * (i + 1) - 1 along x
        std::int32_t j = 0;
        std::array<double, kTilePoints> height;  ///< m, x fastest; never below the floor
        std::array<double, kTilePoints> floor;   ///< m
    };

    /// `diameter` [m] sets the sub-grid; throws InternalError unless it is positive.
    HeightMap(const Snapshot& snapshot, const FloorHeight& floor, double diameter);

    /// On a level floor, with the mean diameter of the scene.
    explicit HeightMap(const Snapshot& snapshot, double floorZ = 0.0)
        : HeightMap(snapshot, levelFloor(floorZ), 2.0 * snapshot.meanRadius)
    {
    }

    double diameter() const { return diameter_; }               ///< m
    double spacing() const { return 0.5 * diameter_; }          ///< m
    double pointArea() const { return spacing() * spacing(); }  ///< m2

    /// Grains that make up the accumulated sand, as ascending indices into the snapshot.
    const std::vector<std::uint32_t>& settled() const { return settled_; }

    /// Every tile with sand, ordered by row and column: an order that no grain can change.
    const std::vector<Tile>& tiles() const { return tiles_; }
    /// Null where there is no sand.
    const Tile* findTile(std::int32_t i, std::int32_t j) const;

    /// Sub-grid point nearest to a coordinate [m], and the coordinate [m] of a point.
    std::int32_t pointIndex(double coordinate) const;
    double pointCoordinate(std::int64_t index) const
    {
        return (static_cast<double>(index) + 0.5) * spacing();
    }

    /// H above the floor at sub-grid point (i, j), m; 0 where there is no sand.
    double depthAt(std::int32_t i, std::int32_t j) const;

private:
    void makeTiles(const Snapshot& snapshot);
    void fillTiles(const Snapshot& snapshot, const FloorHeight& floor);
    void raiseTile(Tile& tile, const Vec3& position, double radius) const;

    double diameter_;
    std::vector<std::uint32_t> settled_;
    std::vector<Tile> tiles_;
    CellMap tileIndex_;
    // The grains over each tile, as one list per tile behind one another.
    std::vector<std::uint32_t> overBegin_, over_;
};

}  // namespace sandflow
