#pragma once

#include "core/vec3.h"
#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sandflow {

/// The two-layer height field of the BCRE model on a sparse, unbounded grid of columns.
///
///        airborne grains (not part of the field)
///     ~~~~~~~~~~~~~~~~~~~~~~~  H = h + R   top of the accumulated sand
///      o o  flowing layer  o      R        real grains, mobile
///     -----------------------  h          the static bed begins
///      # interface of fixed #             constant thickness
///     .......................
///      : buried, stored only :
///     =======================  floor      the solid below this span
///
/// Each column holds one or more spans: free vertical intervals [floor, ceiling] between solids.
/// All quantities of a span are flat arrays indexed by span. Columns are made in tiles, on demand.
/// Spans keep their index until rebuildSpans(); making the same columns in the same order gives the
/// same indices.
class ColumnGrid {
public:
    /// Free vertical intervals of the column with centre (x, y), ascending. None: all solid.
    struct FreeInterval {
        double floor;     ///< m, -1e30 when there is no solid below
        double ceiling;   ///< m, 1e30 when open above
        bool ragged = false;
    };
    using SpanSource = std::function<void(double x, double y, std::vector<FreeInterval>& out)>;
    /// True if sand cannot pass between two neighbouring columns at heights [lo, hi].
    using WallTest = std::function<bool(const Vec2& a, const Vec2& b, double lo, double hi)>;

    static constexpr int kTileEdge = 16;
    static constexpr int kTileColumns = kTileEdge * kTileEdge;
    static constexpr std::int32_t kNone = -1;
    /// A floor below this is no floor: sand that gets there is lost (see sink).
    static constexpr double kBottomless = -1e29;

    /// Where two spans of one column share a neighbour (above and below a table top, seen from the
    /// ground beside it), the neighbour links back to one of them; the others are listed here.
    struct ExtraLink {
        std::int32_t span;
        std::int32_t direction;   ///< as in link
        std::int32_t other;       ///< link[other][opposite direction] == span
    };

    /// An empty `wall` means that there are none.
    ColumnGrid(double cellSize, SpanSource spans, WallTest wall);

    double cellSize() const { return cellSize_; }
    std::size_t spanCount() const { return floor.size(); }

    /// floor(coordinate / cellSize), held within +-1e9 (NaN too), so it may be used anywhere.
    std::int32_t cellIndex(double coordinate) const noexcept;
    /// Makes the tile that holds column (i, j) if it is not there yet, with h = floor, R = 0, and
    /// links it to its neighbours. Not thread-safe; not for inner loops.
    void ensureColumn(std::int32_t i, std::int32_t j);

    /// First span of column (i, j) and how many; {kNone, 0} if its tile was never made.
    std::pair<std::int32_t, std::int32_t> spansOf(std::int32_t i, std::int32_t j) const;
    /// The span of the column over (x, y) that holds height z (nearest one if z is inside a solid);
    /// kNone if there is no such column or it is solid all the way.
    std::int32_t spanAt(double x, double y, double z) const;

    /// Columns are numbered tile by tile in the order they were made: slots 0..slotCount()-1.
    std::size_t slotCount() const { return tiles_.size() * kTileColumns; }
    /// The slot of column (i, j); kNone if its tile was never made.
    std::int32_t slotOf(std::int32_t i, std::int32_t j) const;
    std::pair<std::int32_t, std::int32_t> columnOfSlot(std::int32_t slot) const;
    std::pair<std::int32_t, std::int32_t> spansOfSlot(std::int32_t slot) const;

    /// Solids came or went: rebuilds the spans of every existing column and their links. Spans that
    /// kept floor and ceiling keep their values, others start empty; `changed` (cleared first) gets
    /// the columns that did not keep all their spans.
    void rebuildSpans(std::vector<std::pair<std::int32_t, std::int32_t>>& changed);

    // One value per span.
    std::vector<double> floor;       ///< m
    std::vector<double> ceiling;     ///< m
    std::vector<double> H;           ///< m, top of the accumulated sand; >= floor
    std::vector<double> h;           ///< m, top of the static bed; floor <= h <= H
    std::vector<double> R;           ///< m, H - h
    std::vector<double> dh;          ///< m, change of h in the last evolution
    /// 1: flowing sand that reaches the span leaves the field and h does not change (the edge of an
    /// open table). 0 by default, 1 where there is no floor.
    std::vector<std::uint8_t> sink;
    /// 1: parts of the column's area stand at quite other levels (a wall, the rim of an overhang), so
    /// what lies below h there need not be covered by sand.
    std::vector<std::uint8_t> ragged;
    std::vector<std::int32_t> columnI, columnJ;
    /// Neighbouring span at -x, +x, -y, +y; kNone at a wall or where no tile exists yet.
    std::vector<std::array<std::int32_t, 4>> link;
    /// Sorted by span, direction, other. Empty where no solid overhangs another.
    std::vector<ExtraLink> extraLinks;

private:
    struct Tile {
        std::int32_t i, j;                                     ///< column index / kTileEdge
        std::array<std::int32_t, kTileColumns + 1> firstSpan;  ///< x fastest; last: one past
    };

    std::int32_t tileAt(std::int32_t tileI, std::int32_t tileJ) const;
    void makeSpans(Tile& tile);
    void appendSpan(const FreeInterval& interval, std::int32_t i, std::int32_t j);
    void linkTile(const Tile& tile, bool towardsAll);
    void linkColumns(std::int32_t i, std::int32_t j, std::int32_t direction);
    void pickLinks(const std::pair<std::int32_t, std::int32_t>& from,
                   const std::pair<std::int32_t, std::int32_t>& to, std::int32_t direction);
    void addExtraLinks(const std::pair<std::int32_t, std::int32_t>& from, std::int32_t direction);
    void sortExtraLinks();
    Vec2 centreOf(std::int32_t i, std::int32_t j) const;

    double cellSize_;
    SpanSource spans_;
    WallTest wall_;
    std::vector<Tile> tiles_;
    std::unordered_map<std::uint64_t, std::int32_t> tileIndex_;   ///< packed (i, j) -> tiles_
};

}  // namespace sandflow
