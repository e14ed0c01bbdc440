#include "bcre/columns.h"

#include "core/errors.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sandflow {

namespace {

constexpr double kLastCell = 1e9;
constexpr std::int32_t kStepI[4] = {-1, 1, 0, 0};
constexpr std::int32_t kStepJ[4] = {0, 0, -1, 1};

static_assert(ColumnGrid::kTileEdge == 16, "the shifts and masks below are for edges of 16");

std::int32_t tileOf(std::int32_t index)
{
    return index >> 4;   // rounds down for negative indices as well
}

std::int32_t placeInTile(std::int32_t i, std::int32_t j)
{
    return (j & 15) * ColumnGrid::kTileEdge + (i & 15);
}

std::uint64_t packKey(std::int32_t i, std::int32_t j)
{
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) |
           static_cast<std::uint32_t>(j);
}

std::int32_t oppositeOf(std::int32_t direction)
{
    return direction ^ 1;
}

}  // namespace

ColumnGrid::ColumnGrid(double cellSize, SpanSource spans, WallTest wall)
    : cellSize_(cellSize), spans_(std::move(spans)), wall_(std::move(wall))
{
    SAND_CHECK(cellSize > 0.0 && std::isfinite(cellSize), "cell size {} m", cellSize);
    SAND_CHECK(static_cast<bool>(spans_), "a column grid needs a source of spans");
}

std::int32_t ColumnGrid::cellIndex(double coordinate) const noexcept
{
    const double cell = std::floor(coordinate / cellSize_);
    if (!(cell > -kLastCell)) {
        return static_cast<std::int32_t>(-kLastCell);
    }
    return static_cast<std::int32_t>(std::min(cell, kLastCell));
}

Vec2 ColumnGrid::centreOf(std::int32_t i, std::int32_t j) const
{
    return Vec2((i + 0.5) * cellSize_, (j + 0.5) * cellSize_);
}

std::int32_t ColumnGrid::tileAt(std::int32_t tileI, std::int32_t tileJ) const
{
    const auto found = tileIndex_.find(packKey(tileI, tileJ));
    return found == tileIndex_.end() ? kNone : found->second;
}

std::int32_t ColumnGrid::slotOf(std::int32_t i, std::int32_t j) const
{
    const std::int32_t tile = tileAt(tileOf(i), tileOf(j));
    return tile == kNone ? kNone : tile * kTileColumns + placeInTile(i, j);
}

std::pair<std::int32_t, std::int32_t> ColumnGrid::columnOfSlot(std::int32_t slot) const
{
    const Tile& tile = tiles_[static_cast<std::size_t>(slot / kTileColumns)];
    const std::int32_t place = slot % kTileColumns;
    return {tile.i * kTileEdge + place % kTileEdge, tile.j * kTileEdge + place / kTileEdge};
}

std::pair<std::int32_t, std::int32_t> ColumnGrid::spansOfSlot(std::int32_t slot) const
{
    const Tile& tile = tiles_[static_cast<std::size_t>(slot / kTileColumns)];
    const auto place = static_cast<std::size_t>(slot % kTileColumns);
    return {tile.firstSpan[place], tile.firstSpan[place + 1] - tile.firstSpan[place]};
}

std::pair<std::int32_t, std::int32_t> ColumnGrid::spansOf(std::int32_t i, std::int32_t j) const
{
    const std::int32_t slot = slotOf(i, j);
    return slot == kNone ? std::pair{kNone, 0} : spansOfSlot(slot);
}

std::int32_t ColumnGrid::spanAt(double x, double y, double z) const
{
    const auto [first, count] = spansOf(cellIndex(x), cellIndex(y));
    std::int32_t nearest = kNone;
    double nearestGap = 0.0;
    for (std::int32_t span = first; span < first + count; ++span) {
        const double gap = std::max({floor[span] - z, z - ceiling[span], 0.0});
        if (nearest == kNone || gap < nearestGap) {
            nearest = span;
            nearestGap = gap;
        }
    }
    return nearest;
}

void ColumnGrid::ensureColumn(std::int32_t i, std::int32_t j)
{
    const std::int32_t tileI = tileOf(i);
    const std::int32_t tileJ = tileOf(j);
    if (tileAt(tileI, tileJ) != kNone) {
        return;
    }
    Tile tile{tileI, tileJ, {}};
    makeSpans(tile);
    tileIndex_.emplace(packKey(tileI, tileJ), static_cast<std::int32_t>(tiles_.size()));
    tiles_.push_back(tile);
    linkTile(tiles_.back(), true);
    sortExtraLinks();
}

/// Appends the spans of all columns of a tile, empty of sand and unlinked.
void ColumnGrid::makeSpans(Tile& tile)
{
    std::vector<FreeInterval> intervals;
    for (std::int32_t place = 0; place < kTileColumns; ++place) {
        const std::int32_t i = tile.i * kTileEdge + place % kTileEdge;
        const std::int32_t j = tile.j * kTileEdge + place / kTileEdge;
        tile.firstSpan[place] = static_cast<std::int32_t>(spanCount());
        intervals.clear();
        const Vec2 centre = centreOf(i, j);
        spans_(centre.x(), centre.y(), intervals);
        for (std::size_t k = 0; k < intervals.size(); ++k) {
            SAND_CHECK(intervals[k].floor < intervals[k].ceiling,
                       "span [{}, {}] m of column ({}, {})", intervals[k].floor,
                       intervals[k].ceiling, i, j);
            SAND_CHECK(k == 0 || intervals[k - 1].ceiling <= intervals[k].floor,
                       "spans of column ({}, {}) do not ascend", i, j);
            appendSpan(intervals[k], i, j);
        }
    }
    tile.firstSpan[kTileColumns] = static_cast<std::int32_t>(spanCount());
}

void ColumnGrid::appendSpan(const FreeInterval& interval, std::int32_t i, std::int32_t j)
{
    floor.push_back(interval.floor);
    ceiling.push_back(interval.ceiling);
    H.push_back(interval.floor);
    h.push_back(interval.floor);
    R.push_back(0.0);
    dh.push_back(0.0);
    sink.push_back(interval.floor < kBottomless ? 1 : 0);
    ragged.push_back(interval.ragged ? 1 : 0);
    columnI.push_back(i);
    columnJ.push_back(j);
    link.push_back({kNone, kNone, kNone, kNone});
}

/// Links the columns of a tile to those at +x and +y, in whatever tile they are; with `towardsAll`
/// also its lower rims to the tiles before it. So every pair of columns is treated once.
void ColumnGrid::linkTile(const Tile& tile, bool towardsAll)
{
    for (std::int32_t place = 0; place < kTileColumns; ++place) {
        const std::int32_t column = place % kTileEdge;
        const std::int32_t row = place / kTileEdge;
        const std::int32_t i = tile.i * kTileEdge + column;
        const std::int32_t j = tile.j * kTileEdge + row;
        linkColumns(i, j, 1);
        linkColumns(i, j, 3);
        if (towardsAll && column == 0) {
            linkColumns(i, j, 0);
        }
        if (towardsAll && row == 0) {
            linkColumns(i, j, 2);
        }
    }
}

void ColumnGrid::linkColumns(std::int32_t i, std::int32_t j, std::int32_t direction)
{
    const auto here = spansOf(i, j);
    const auto there = spansOf(i + kStepI[direction], j + kStepJ[direction]);
    if (here.second == 0 || there.second == 0) {
        return;
    }
    pickLinks(here, there, direction);
    pickLinks(there, here, oppositeOf(direction));
    if (here.second + there.second > 2) {
        addExtraLinks(here, direction);
        addExtraLinks(there, oppositeOf(direction));
    }
}

/// Links each span of `from` to the span of `to` with which it shares most free height, among those
/// that no wall separates from it.
void ColumnGrid::pickLinks(const std::pair<std::int32_t, std::int32_t>& from,
                           const std::pair<std::int32_t, std::int32_t>& to, std::int32_t direction)
{
    const Vec2 centreFrom = centreOf(columnI[from.first], columnJ[from.first]);
    const Vec2 centreTo = centreOf(columnI[to.first], columnJ[to.first]);
    for (std::int32_t a = from.first; a < from.first + from.second; ++a) {
        double widest = 0.0;
        for (std::int32_t b = to.first; b < to.first + to.second; ++b) {
            const double lo = std::max(floor[a], floor[b]);
            const double hi = std::min(ceiling[a], ceiling[b]);
            if (hi - lo > widest && !(wall_ && wall_(centreFrom, centreTo, lo, hi))) {
                widest = hi - lo;
                link[a][direction] = b;
            }
        }
    }
}

/// Spans of `from` whose neighbour links back to another span become its extra links.
void ColumnGrid::addExtraLinks(const std::pair<std::int32_t, std::int32_t>& from,
                               std::int32_t direction)
{
    for (std::int32_t a = from.first; a < from.first + from.second; ++a) {
        const std::int32_t b = link[a][direction];
        if (b != kNone && link[b][oppositeOf(direction)] != a) {
            extraLinks.push_back({b, oppositeOf(direction), a});
        }
    }
}

void ColumnGrid::sortExtraLinks()
{
    const auto order = [](const ExtraLink& extra) {
        return std::tuple(extra.span, extra.direction, extra.other);
    };
    std::sort(extraLinks.begin(), extraLinks.end(),
              [&](const ExtraLink& a, const ExtraLink& b) { return order(a) < order(b); });
}

void ColumnGrid::rebuildSpans(std::vector<std::pair<std::int32_t, std::int32_t>>& changed)
{
    changed.clear();
    const auto oldFloor = std::exchange(floor, {});
    const auto oldCeiling = std::exchange(ceiling, {});
    const auto oldTop = std::exchange(H, {});
    const auto oldBed = std::exchange(h, {});
    const auto oldFlow = std::exchange(R, {});
    const auto oldChange = std::exchange(dh, {});
    const auto oldSink = std::exchange(sink, {});
    ragged.clear();
    columnI.clear();
    columnJ.clear();
    link.clear();
    extraLinks.clear();

    for (Tile& tile : tiles_) {
        const auto oldFirst = tile.firstSpan;
        makeSpans(tile);
        for (std::int32_t place = 0; place < kTileColumns; ++place) {
            std::int32_t old = oldFirst[place];
            const std::int32_t oldEnd = oldFirst[place + 1];
            std::int32_t kept = 0;
            for (std::int32_t span = tile.firstSpan[place]; span < tile.firstSpan[place + 1];
                 ++span) {
                // Both lists ascend, so one walk finds every span that is still there.
                while (old < oldEnd && oldFloor[old] < floor[span]) {
                    ++old;
                }
                if (old < oldEnd && oldFloor[old] == floor[span] &&
                    oldCeiling[old] == ceiling[span]) {
                    H[span] = oldTop[old];
                    h[span] = oldBed[old];
                    R[span] = oldFlow[old];
                    dh[span] = oldChange[old];
                    sink[span] = oldSink[old];
                    ++kept;
                }
            }
            const std::int32_t count = tile.firstSpan[place + 1] - tile.firstSpan[place];
            if (kept != count || kept != oldEnd - oldFirst[place]) {
                changed.emplace_back(tile.i * kTileEdge + place % kTileEdge,
                                     tile.j * kTileEdge + place / kTileEdge);
            }
        }
    }
    for (const Tile& tile : tiles_) {
        linkTile(tile, false);
    }
    sortExtraLinks();
}

}  // namespace sandflow
