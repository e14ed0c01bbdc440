#include "bcre/surface_height.h"

#include "bcre/span_blocks.h"
#include "core/errors.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

constexpr std::size_t kParallelGrains = 2048;
constexpr std::int32_t kSlotChunk = 16;

/// Looks up columns of the same tile in a row without asking the hash map again.
class SlotFinder {
public:
    explicit SlotFinder(const ColumnGrid& columns) : columns_(columns) {}

    std::int32_t find(std::int32_t i, std::int32_t j)
    {
        constexpr std::int32_t edge = ColumnGrid::kTileEdge;
        const std::int32_t baseI = i & ~(edge - 1);
        const std::int32_t baseJ = j & ~(edge - 1);
        if (!known_ || baseI != baseI_ || baseJ != baseJ_) {
            known_ = true;
            baseI_ = baseI;
            baseJ_ = baseJ;
            base_ = columns_.slotOf(baseI, baseJ);
        }
        return base_ == ColumnGrid::kNone ? base_ : base_ + (j - baseJ) * edge + (i - baseI);
    }

private:
    const ColumnGrid& columns_;
    bool known_ = false;
    std::int32_t baseI_ = 0;
    std::int32_t baseJ_ = 0;
    std::int32_t base_ = ColumnGrid::kNone;
};

/// The one of `count` spans from `first` that holds height z, else the nearest.
std::int32_t spanHolding(double z, std::int32_t first, std::int32_t count,
                         const ColumnGrid& columns)
{
    std::int32_t nearest = first;
    double nearestGap = 0.0;
    for (std::int32_t span = first; span < first + count; ++span) {
        const double gap = std::max({columns.floor[span] - z, z - columns.ceiling[span], 0.0});
        if (span == first || gap < nearestGap) {
            nearest = span;
            nearestGap = gap;
        }
    }
    return nearest;
}

}  // namespace

void SurfaceHeightMeter::measure(std::span<const AccumulatedGrain> grains, double diameter,
                                 double smoothing, ColumnGrid& columns)
{
    SAND_CHECK(diameter > 0.0, "grain diameter {} m", diameter);
    SAND_CHECK(smoothing >= 0.0 && smoothing <= 1.0, "smoothing {}", smoothing);
    placeGrains(grains, columns);
    sortGrains(grains);
    castRays(diameter, columns);
    if (smoothing > 0.0) {
        smooth(smoothing, columns);
    }
}

/// Finds the column of every grain and makes what is missing: every column that a grain can touch
/// must exist, and one all around (a column that is not there is a wall to its neighbours).
void SurfaceHeightMeter::placeGrains(std::span<const AccumulatedGrain> grains, ColumnGrid& columns)
{
    const double farthest = 1e9 * columns.cellSize();
    double largest = 0.0;
    for (const AccumulatedGrain& grain : grains) {
        largest = std::max(largest, grain.radius);
        if (!(std::abs(grain.position.x()) < farthest && std::abs(grain.position.y()) < farthest &&
              std::isfinite(grain.position.z()))) {
            throw PhysicsError(fmt::format(
                "a resting grain is at ({:.3g}, {:.3g}, {:.3g}) m, outside any height field; "
                "grains probably exploded, try a smaller time.step",
                grain.position.x(), grain.position.y(), grain.position.z()));
        }
    }
    reach_ = std::max(1, static_cast<int>(std::ceil(largest / columns.cellSize())));
    // Then the columns around a grain lie in at most 2 x 2 tiles, found at their corners.
    SAND_CHECK(2 * reach_ <= ColumnGrid::kTileEdge, "a grain of radius {} m on columns of {} m",
               largest, columns.cellSize());

    if (!findSlots(grains, columns)) {
        missing_.clear();
        for (std::size_t k = 0; k < grains.size(); ++k) {
            if (slotOfGrain_[k] == ColumnGrid::kNone) {
                missing_.emplace_back(columns.cellIndex(grains[k].position.y()),
                                      columns.cellIndex(grains[k].position.x()));
            }
        }
        makeMissing(columns);
        SAND_CHECK(findSlots(grains, columns), "columns that were made are not there");
    }
    countGrains(columns);
    makeMargins(columns);
}

/// Fills slotOfGrain_; false if some grain has no column yet.
bool SurfaceHeightMeter::findSlots(std::span<const AccumulatedGrain> grains,
                                   const ColumnGrid& columns)
{
    const auto count = static_cast<std::int64_t>(grains.size());
    slotOfGrain_.resize(grains.size());
    bool complete = true;
#pragma omp parallel if (grains.size() > kParallelGrains)
    {
        SlotFinder finder(columns);
#pragma omp for schedule(static) reduction(&& : complete)
        for (std::int64_t k = 0; k < count; ++k) {
            const std::int32_t slot = finder.find(columns.cellIndex(grains[k].position.x()),
                                                  columns.cellIndex(grains[k].position.y()));
            slotOfGrain_[k] = slot;
            complete = complete && slot != ColumnGrid::kNone;
        }
    }
    return complete;
}

void SurfaceHeightMeter::countGrains(const ColumnGrid& columns)
{
    firstOfSlot_.assign(columns.slotCount() + 1, 0);
    for (const std::int32_t slot : slotOfGrain_) {
        ++firstOfSlot_[slot];
    }
}

/// Makes the tiles around columns that hold grains and lie near the rim of their tile.
void SurfaceHeightMeter::makeMargins(ColumnGrid& columns)
{
    constexpr std::int32_t edge = ColumnGrid::kTileEdge;
    missing_.clear();
    SlotFinder finder(columns);
    const auto slots = static_cast<std::int32_t>(columns.slotCount());
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        const std::int32_t inI = slot % edge;
        const std::int32_t inJ = slot / edge % edge;
        const bool inside =
            std::min(inI, inJ) >= reach_ && std::max(inI, inJ) < edge - reach_;
        if (inside || firstOfSlot_[slot] == 0) {
            continue;
        }
        const auto [i, j] = columns.columnOfSlot(slot);
        for (const std::int32_t nearJ : {j - reach_, j + reach_}) {
            for (const std::int32_t nearI : {i - reach_, i + reach_}) {
                if (finder.find(nearI, nearJ) == ColumnGrid::kNone) {
                    missing_.emplace_back(nearJ, nearI);
                }
            }
        }
    }
    makeMissing(columns);
    // New columns hold no grains; they come last.
    firstOfSlot_.resize(columns.slotCount() + 1, 0);
}

/// Makes the tiles of the columns (j, i) in missing_, row by row, so that the order of the spans
/// does not follow the order of the grains.
void SurfaceHeightMeter::makeMissing(ColumnGrid& columns)
{
    for (auto& [j, i] : missing_) {
        j &= ~(ColumnGrid::kTileEdge - 1);
        i &= ~(ColumnGrid::kTileEdge - 1);
    }
    std::sort(missing_.begin(), missing_.end());
    missing_.erase(std::unique(missing_.begin(), missing_.end()), missing_.end());
    for (const auto& [j, i] : missing_) {
        columns.ensureColumn(i, j);
    }
}

/// Second half of a counting sort by column; countGrains() was the first.
void SurfaceHeightMeter::sortGrains(std::span<const AccumulatedGrain> grains)
{
    std::int32_t end = 0;
    for (std::int32_t& first : firstOfSlot_) {
        end += first;
        first = end;
    }
    // Filled from the back: afterwards each entry points to the first grain of its column.
    sorted_.resize(grains.size());
    for (std::size_t k = grains.size(); k-- > 0;) {
        sorted_[--firstOfSlot_[slotOfGrain_[k]]] = grains[k];
    }
}

void SurfaceHeightMeter::castRays(double diameter, ColumnGrid& columns)
{
    const int raysPerEdge =
        std::max(1, static_cast<int>(std::ceil(columns.cellSize() / (0.5 * diameter) - 1e-9)));
    const std::size_t threads = static_cast<std::size_t>(omp_get_max_threads());
    if (scratch_.size() < threads) {
        scratch_.resize(threads);
    }
    for (Scratch& scratch : scratch_) {
        scratch.tops.resize(static_cast<std::size_t>(raysPerEdge) * raysPerEdge);
        scratch.nearby.reserve(static_cast<std::size_t>(2 * reach_ + 1) * (2 * reach_ + 1));
    }

    const auto slots = static_cast<std::int32_t>(columns.slotCount());
#pragma omp parallel for schedule(dynamic, kSlotChunk) if (sorted_.size() > kParallelGrains)
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        Scratch& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
        collectNearby(slot, columns, scratch.nearby);
        const auto [first, count] = columns.spansOfSlot(slot);
        for (std::int32_t span = first; span < first + count; ++span) {
            columns.H[span] =
                scratch.nearby.empty() || columns.floor[span] < ColumnGrid::kBottomless
                    ? columns.floor[span]
                    : meanTop(span, raysPerEdge, columns, scratch.nearby, scratch.tops);
        }
    }
}

/// Ranges of sorted_ that hold the grains of the columns around `slot`. Columns of a row lie next
/// to each other within a tile, so a row is at most two ranges.
void SurfaceHeightMeter::collectNearby(
    std::int32_t slot, const ColumnGrid& columns,
    std::vector<std::pair<std::int32_t, std::int32_t>>& nearby) const
{
    nearby.clear();
    const auto [i, j] = columns.columnOfSlot(slot);
    SlotFinder finder(columns);
    for (std::int32_t nearJ = j - reach_; nearJ <= j + reach_; ++nearJ) {
        for (std::int32_t nearI = i - reach_; nearI <= i + reach_; ++nearI) {
            const std::int32_t near = finder.find(nearI, nearJ);
            if (near == ColumnGrid::kNone || firstOfSlot_[near] == firstOfSlot_[near + 1]) {
                continue;
            }
            if (!nearby.empty() && nearby.back().second == firstOfSlot_[near]) {
                nearby.back().second = firstOfSlot_[near + 1];
            } else {
                nearby.emplace_back(firstOfSlot_[near], firstOfSlot_[near + 1]);
            }
        }
    }
}

/// Mean over the span's rays of the highest cap, from its floor up to its ceiling.
double SurfaceHeightMeter::meanTop(
    std::int32_t span, int raysPerEdge, const ColumnGrid& columns,
    const std::vector<std::pair<std::int32_t, std::int32_t>>& nearby,
    std::vector<double>& tops) const
{
    const double spacing = columns.cellSize() / raysPerEdge;
    const double firstX = columns.columnI[span] * columns.cellSize() + 0.5 * spacing;
    const double firstY = columns.columnJ[span] * columns.cellSize() + 0.5 * spacing;
    const auto [first, count] = columns.spansOf(columns.columnI[span], columns.columnJ[span]);
    const double last = raysPerEdge - 1;
    const double perSpacing = 1.0 / spacing;
    std::fill(tops.begin(), tops.end(), columns.floor[span]);
    for (const auto& [begin, end] : nearby) {
        for (std::int32_t g = begin; g < end; ++g) {
            const AccumulatedGrain& grain = sorted_[g];
            // Rays numbered from..to along each axis may hit it; outside 0..last there are none.
            const double x = (grain.position.x() - firstX) * perSpacing;
            const double y = (grain.position.y() - firstY) * perSpacing;
            const double width = grain.radius * perSpacing;
            if (x + width < 0.0 || x - width > last || y + width < 0.0 || y - width > last) {
                continue;
            }
            if (count > 1 && spanHolding(grain.position.z(), first, count, columns) != span) {
                continue;
            }
            const int fromI = static_cast<int>(std::max(x - width, 0.0));
            const int toI = static_cast<int>(std::min(x + width, last));
            const int fromJ = static_cast<int>(std::max(y - width, 0.0));
            const int toJ = static_cast<int>(std::min(y + width, last));
            const double height = std::min(grain.position.z() + grain.radius,
                                           columns.ceiling[span]);
            for (int rayJ = fromJ; rayJ <= toJ; ++rayJ) {
                const double dy = firstY + rayJ * spacing - grain.position.y();
                for (int rayI = fromI; rayI <= toI; ++rayI) {
                    double& top = tops[static_cast<std::size_t>(rayJ * raysPerEdge + rayI)];
                    const double dx = firstX + rayI * spacing - grain.position.x();
                    const double under = grain.radius * grain.radius - dx * dx - dy * dy;
                    if (under >= 0.0 && height > top) {
                        top = std::max(
                            top, std::min(grain.position.z() + std::sqrt(under), height));
                    }
                }
            }
        }
    }
    double sum = 0.0;
    for (const double top : tops) {
        sum += top;
    }
    // The mean of equal numbers may round below them.
    return std::max(sum / static_cast<double>(tops.size()), columns.floor[span]);
}

void SurfaceHeightMeter::smooth(double share, ColumnGrid& columns)
{
    const std::size_t count = columns.spanCount();
    smoothed_.resize(count);
    const double* H = columns.H.data();
    const double* floor = columns.floor.data();
    forSpanBlocks(count, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            double offset = 0.0;
            int neighbours = 0;
            for (const std::int32_t other : columns.link[s]) {
                if (other == ColumnGrid::kNone) {
                    continue;
                }
                ++neighbours;
                // Across a ledge the two bodies of sand do not touch.
                if (floor[other] <= H[s] && H[other] >= floor[s]) {
                    offset += H[other] - H[s];
                }
            }
            smoothed_[s] =
                neighbours == 0 ? H[s] : std::max(H[s] + share * offset / neighbours, floor[s]);
        }
    });
    columns.H.swap(smoothed_);
}

void measureSurfaceHeight(std::span<const AccumulatedGrain> grains, double diameter,
                          double smoothing, ColumnGrid& columns)
{
    SurfaceHeightMeter().measure(grains, diameter, smoothing, columns);
}

}  // namespace sandflow
