#include "dem/contact_lists.h"

#include "dem/choose_passes.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

template <class Real>
ContactLists<Real>::ContactLists(double cellSize, double skin, double largestRadius)
    : skin_(skin),
      largestRadius_(largestRadius),
      findNear_(choosePasses<float>(KernelTarget::best, NormalLaw::linear, RollingLaw::none).findNear),
      cells_(cellSize),
      strays_(cellSize)
{
}

template <class Real>
void ContactLists<Real>::sortMobile(double horizon, MobileGrains<Real>& mobile)
{
    const auto n = static_cast<std::int64_t>(mobile.size());
    cells_.build(mobile.size(), [&](std::size_t k) {
        const SearchBall ball = ballAhead(mobile.record[k], horizon);
        return Vec3(ball.x, ball.y, ball.z);
    });

    mobile.next.resize(mobile.size());
    std::vector<std::uint32_t>& rowScratch = cellOfSlot_;  // not known yet
    rowScratch.resize(mobile.size());
    memoryScratch_.resize(mobile.memory.size());
    const std::span<const std::uint32_t> order = cells_.order();
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        mobile.next[k] = mobile.record[order[k]];
        rowScratch[k] = mobile.row[order[k]];
        if (mobile.judged) {
            memoryScratch_[k] = mobile.memory[order[k]];
        }
    }
    mobile.record.swap(mobile.next);
    mobile.row.swap(rowScratch);
    mobile.memory.swap(memoryScratch_);
    placeBalls(mobile);
    spreadSearchRadius();
}

/// The balls as the kernel sees them.
template <class Real>
void ContactLists<Real>::placeBalls(const MobileGrains<Real>& mobile)
{
    const auto chunkCount =
        static_cast<std::int64_t>((mobile.size() + kChunkSize - 1) / kChunkSize);
    chunks_.resize(static_cast<std::size_t>(chunkCount));
    origins_.resize(static_cast<std::size_t>(chunkCount));
    balls_.resize(mobile.size());
    columns_.resize(mobile.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t c = 0; c < chunkCount; ++c) {
        const std::size_t first = static_cast<std::size_t>(c) * kChunkSize;
        const std::size_t last = std::min<std::size_t>(first + kChunkSize, mobile.size());
        const SearchBall central = ballAhead(mobile.record[first]);
        origins_[c] = Vec3(central.x, central.y, central.z);
        for (std::size_t k = first; k < last; ++k) {
            const auto slot = static_cast<std::uint32_t>(k);
            giveBall(slot, ballAhead(mobile.record[k]), mobile.record[k].radius);
            columns_.set(k, ballOf(slot, mobile));
        }
    }
}

template <class Real>
void ContactLists<Real>::giveBall(std::uint32_t slot, const SearchBall& ball, Real radius)
{
    const Vec3f place = (Vec3(ball.x, ball.y, ball.z) - origins_[slot / kChunkSize]).cast<float>();
    // Left a little early rather than late; see ballOf.
    balls_[slot] = {place.x(), place.y(), place.z(),
                    (ball.reach - static_cast<float>(radius)) * 0.9999f};
}

/// A grain with a long reach can have partners cells away, and those must look as far to find it.
template <class Real>
void ContactLists<Real>::spreadSearchRadius()
{
    const std::span<const SortedCells::Cell> cells = cells_.cells();
    searchRadius_.assign(cells.size(), 1);
    cellReach_.assign(cells.size(), 0.0f);
    cellOfSlot_.resize(balls_.size());
    strays_.clear();
    strayCount_ = 0;
    const auto count = static_cast<std::int64_t>(cells.size());
    float longest = 0.0f;
#pragma omp parallel for schedule(static) reduction(max : longest)
    for (std::int64_t c = 0; c < count; ++c) {
        for (std::uint32_t k = cells[c].begin; k < cells[c].end; ++k) {
            cellReach_[c] = std::max(cellReach_[c], columns_.reach[k]);
            cellOfSlot_[k] = static_cast<std::uint32_t>(c);
        }
        longest = std::max(longest, cellReach_[c]);
    }
    longestReach_ = static_cast<double>(longest);
    const auto radiusFor = [&](float reach) {
        // Centres may have rounded across the border of a cell.
        return static_cast<int>(
            std::ceil(2.0001 * static_cast<double>(reach) / cells_.cellSize()));
    };
    SAND_CHECK(radiusFor(longest) < 100, "a grain needs {} cells of search: it is far too fast",
               radiusFor(longest));
    std::vector<std::pair<std::uint32_t, int>> wide;
    for (std::uint32_t c = 0; radiusFor(longest) > 1 && c < cells.size(); ++c) {
        if (const int radius = radiusFor(cellReach_[c]); radius > 1) {
            wide.emplace_back(c, radius);
        }
    }
    for (const auto& [c, radius] : wide) {
        cells_.visitNear(cells[c].index, radius, [&](const SortedCells::Cell& cell) {
            std::uint8_t& mark = searchRadius_[&cell - cells.data()];
            mark = std::max(mark, static_cast<std::uint8_t>(radius));
        });
    }
}

template <class Real>
void ContactLists<Real>::search(const MobileGrains<Real>& mobile, FixedView frozen,
                                FixedView boundary, std::span<const Primitive> walls, double time,
                                const ContactBook<Real>& book)
{
    const auto chunkCount = static_cast<std::int64_t>(chunks_.size());
#pragma omp parallel
    {
        Surroundings near;
#pragma omp for schedule(dynamic, 1)
        for (std::int64_t c = 0; c < chunkCount; ++c) {
            searchChunk(static_cast<std::uint32_t>(c), mobile, frozen, boundary, book, near);
            searchWalls(static_cast<std::uint32_t>(c), mobile, walls, time, book);
        }
    }
}

/// Slots whose balls may meet one of this cell, but for mobile ones whose pairs with it are listed
/// under their own, lower slot of the chunk.
template <class Real>
void ContactLists<Real>::findSurroundings(std::uint32_t cell, std::uint32_t firstOfChunk,
                                          const FixedView& frozen, const FixedView& boundary,
                                          Surroundings& near) const
{
    const SortedCells::Cell& home = cells_.cells()[cell];
    const CellIndex& at = home.index;
    std::uint32_t most = 0;
    // Cells too far apart for the longest reach in either hold no partners: near a fast grain most
    // of the cells within the search radius do not.
    const auto collect = [&](const SortedCells& cells, auto reachOf, std::uint32_t skipBegin,
                             std::uint32_t skipEnd, std::vector<SlotRange>& ranges) {
        ranges.clear();
        const auto gap = [&](std::int32_t a, std::int32_t b) {
            return std::max(std::abs(a - b) - 1, 0) * cells.cellSize();
        };
        const auto add = [&](std::uint32_t begin, std::uint32_t end) {
            if (begin < end) {
                ranges.push_back({begin, end});
            }
        };
        cells.visitNear(at, searchRadius_[cell], [&](const SortedCells::Cell& other) {
            if (searchRadius_[cell] > 1) {
                const double dx = gap(other.index.i, at.i), dy = gap(other.index.j, at.j),
                             dz = gap(other.index.k, at.k);
                const double reach = static_cast<double>(cellReach_[cell]) + reachOf(other);
                if (dx * dx + dy * dy + dz * dz >= reach * reach) {
                    return;
                }
            }
            add(other.begin, std::min(other.end, skipBegin));
            add(std::max(other.begin, skipEnd), other.end);
        });
        // In slot order, so that lists do not depend on the search's. Cells that follow each other
        // along the curve become one range.
        std::sort(ranges.begin(), ranges.end(),
                  [](const SlotRange& a, const SlotRange& b) { return a.begin < b.begin; });
        std::size_t kept = 0;
        std::uint32_t sum = 0;
        for (const SlotRange& range : ranges) {
            sum += range.end - range.begin;
            if (kept > 0 && ranges[kept - 1].end == range.begin) {
                ranges[kept - 1].end = range.end;
            } else {
                ranges[kept++] = range;
            }
        }
        ranges.resize(kept);
        most = std::max(most, sum);
    };
    collect(
        cells_,
        [&](const SortedCells::Cell& other) {
            return static_cast<double>(cellReach_[&other - cells_.cells().data()]);
        },
        firstOfChunk, std::max(home.begin, firstOfChunk), near.mobile);
    const auto fixedReach = [&](const SortedCells::Cell&) { return largestRadius_; };
    collect(frozen.cells, fixedReach, 0, 0, near.frozen);
    collect(boundary.cells, fixedReach, 0, 0, near.boundary);
    if (near.found.size() < most + kMaxLanes) {
        near.found.resize(2 * most + kMaxLanes);
    }
}

template <class Real>
void ContactLists<Real>::searchChunk(std::uint32_t chunk, const MobileGrains<Real>& mobile,
                                     const FixedView& frozen, const FixedView& boundary,
                                     const ContactBook<Real>& book, Surroundings& near)
{
    ChunkContacts<Real>& out = chunks_[chunk];
    out.clearAndFit();
    const std::uint32_t first = chunk * kChunkSize;
    const std::uint32_t last =
        std::min<std::uint32_t>(first + kChunkSize, static_cast<std::uint32_t>(mobile.size()));
    out.grainCount = last - first;

    std::uint32_t currentCell = 0xFFFFFFFFu;
    for (std::uint32_t i = first; i < last; ++i) {
        if (cellOfSlot_[i] != currentCell) {
            currentCell = cellOfSlot_[i];
            findSurroundings(currentCell, first, frozen, boundary, near);
        }
        const SearchBall ball = ballOf(i, mobile);
        const std::uint32_t row = mobile.row[i];
        const std::uint32_t slot = i - first;
        const auto find = [&](const BallColumns& columns, const std::vector<SlotRange>& ranges) {
            NearWork sieve;
            sieve.x = columns.x.data(), sieve.y = columns.y.data(), sieve.z = columns.z.data();
            sieve.reach = columns.reach.data();
            sieve.ranges = ranges.data();
            sieve.rangeCount = static_cast<std::uint32_t>(ranges.size());
            sieve.at[0] = static_cast<float>(ball.x);
            sieve.at[1] = static_cast<float>(ball.y);
            sieve.at[2] = static_cast<float>(ball.z);
            // Wider than all that floats may round.
            const double size = std::abs(ball.x) + std::abs(ball.y) + std::abs(ball.z);
            sieve.ownReach = ball.reach * 1.0001f + static_cast<float>(1e-6 * (size + longestReach_));
            sieve.found = near.found.data();
            sieve.foundCount = 0;
            findNear_(sieve);
            return std::span<const std::uint32_t>(near.found.data(), sieve.foundCount);
        };
        PairHistory<Real> springs;

        for (const std::uint32_t j : find(columns_, near.mobile)) {
            const SearchBall other = ballOf(j, mobile);
            if ((j <= i && j >= first) || !ball.meets(other)) {
                continue;
            }
            const bool live = book.recall(row, ball.id, mobile.row[j], other.id, springs);
            if (j >= first && j < last) {
                out.appendOwn(slot, j - first, live, springs);
            } else {
                out.appendForeign(slot, PartnerSource::mobile, j, live, springs);
            }
        }
        const auto listFixed = [&](const FixedView& fixed, const std::vector<SlotRange>& ranges,
                                   PartnerSource source) {
            if (ranges.empty()) {
                return;
            }
            for (const std::uint32_t j : find(fixed.balls, ranges)) {
                const SearchBall other = ballOfFixed(fixed.record[j]);
                if (ball.meets(other)) {
                    const bool live =
                        book.recall(row, ball.id, fixed.rowOf(j), other.id, springs);
                    out.appendForeign(slot, source, j, live, springs);
                }
            }
        };
        listFixed(frozen, near.frozen, PartnerSource::frozen);
        listFixed(boundary, near.boundary, PartnerSource::boundary);
    }
}

template <class Real>
void ContactLists<Real>::searchWalls(std::uint32_t chunk, const MobileGrains<Real>& mobile,
                                     std::span<const Primitive> walls, double time,
                                     const ContactBook<Real>& book)
{
    if (walls.empty()) {
        return;
    }
    ChunkContacts<Real>& out = chunks_[chunk];
    const std::uint32_t first = chunk * kChunkSize;
    const std::uint32_t last =
        std::min<std::uint32_t>(first + kChunkSize, static_cast<std::uint32_t>(mobile.size()));
    // A ball about the whole chunk tells at once which walls are out of its reach.
    const auto centreOf = [&](std::uint32_t i) {
        const SearchBall ball = ballOf(i, mobile);
        return Vec3(ball.x, ball.y, ball.z);
    };
    double chunkReach = 0.0;
    for (std::uint32_t i = first; i < last; ++i) {
        chunkReach = std::max(chunkReach, (centreOf(i) - origins_[chunk]).norm() +
                                              static_cast<double>(columns_.reach[i]));
    }
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
        if (walls[w].rough || !walls[w].existsAt(time) ||
            std::abs(nearestSurface(walls[w], origins_[chunk]).distance) > chunkReach) {
            continue;
        }
        for (std::uint32_t i = first; i < last; ++i) {
            if (nearestSurface(walls[w], centreOf(i)).distance <
                static_cast<double>(columns_.reach[i])) {
                const auto* springs = book.find(mobile.row[i], kFirstWallId + w);
                out.walls.push_back({static_cast<std::uint16_t>(i - first), springs != nullptr, w});
                out.wallHistory.push_back(springs ? *springs : PairHistory<Real>{});
            }
        }
    }
}

/// A pair is listed exactly if some ball of the one meets some ball of the other. So a new ball
/// brings the pairs whose balls it meets and that no older ball of its grain met.
template <class Real>
void ContactLists<Real>::followStray(std::uint32_t slot, const MobileGrains<Real>& mobile,
                                     const FixedView& frozen, const FixedView& boundary,
                                     std::span<const Primitive> walls, double time)
{
    const bool hasOlder = strays_.anyOf(slot, [](const SearchBall&) { return true; });
    const bool isNew = cameLater(slot) && !hasOlder;
    strayCount_ += isNew ? 0 : 1;
    if (!isNew && !hasOlder) {
        strays_.add(slot, ballOf(slot, mobile));
    }
    giveBall(slot, ballAhead(mobile.record[slot]), mobile.record[slot].radius);
    const SearchBall ball = ballOf(slot, mobile);
    const Vec3 centre(ball.x, ball.y, ball.z);
    const auto metBefore = [&](const SearchBall& other) {
        return strays_.anyOf(slot, [&](const SearchBall& older) { return older.meets(other); });
    };

    // Mobile partners: by their first balls, which are in the cells, and by later ones.
    std::vector<std::uint32_t>& partners = strayPartners_;
    partners.clear();
    const auto cellsAway = [&](double otherReach) {
        return static_cast<std::int32_t>(
            std::ceil((static_cast<double>(ball.reach) + otherReach) / cells_.cellSize()));
    };
    const CellIndex at = cells_.cellOf(centre);
    cells_.visitNear(at, cellsAway(longestReach_), [&](const SortedCells::Cell& cell) {
        for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
            if (ball.meets(ballOf(j, mobile))) {
                partners.push_back(j);
            }
        }
    });
    strays_.visitMeeting(ball, [&](std::uint32_t j) { partners.push_back(j); });
    std::sort(partners.begin(), partners.end());
    partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
    for (const std::uint32_t j : partners) {
        if (j != slot && !metBefore(ballOf(j, mobile)) && !strays_.anyOf(j, metBefore)) {
            appendPair(slot, j);
        }
    }

    const auto appendFixed = [&](const FixedView& fixed, PartnerSource source) {
        fixed.cells.visitNear(at, cellsAway(largestRadius_), [&](const SortedCells::Cell& cell) {
            for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
                const SearchBall other = ballOfFixed(fixed.record[j]);
                if (ball.meets(other) && !metBefore(other)) {
                    appendForeign(slot, source, j);
                }
            }
        });
    };
    appendFixed(frozen, PartnerSource::frozen);
    appendFixed(boundary, PartnerSource::boundary);

    ChunkContacts<Real>& chunk = chunks_[slot / kChunkSize];
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
        if (walls[w].rough || !walls[w].existsAt(time)) {
            continue;
        }
        const auto reaches = [&](const SearchBall& b) {
            return nearestSurface(walls[w], Vec3(b.x, b.y, b.z)).distance <
                   static_cast<double>(b.reach);
        };
        if (reaches(ball) && !strays_.anyOf(slot, reaches)) {
            chunk.walls.push_back({static_cast<std::uint16_t>(slot % kChunkSize), false, w});
            chunk.wallHistory.push_back({});
        }
    }
    strays_.add(slot, ball);
}

template <class Real>
void ContactLists<Real>::openSlot(std::uint32_t slot, const GrainRecord<Real>& grain)
{
    if (slot % kChunkSize == 0) {
        chunks_.emplace_back();
        origins_.emplace_back(grain.x, grain.y, grain.z);
    }
    ++chunks_[slot / kChunkSize].grainCount;
    balls_.emplace_back();  // it is not in the cells: what finds it are the stray balls
}

template <class Real>
void ContactLists<Real>::appendPair(std::uint32_t a, std::uint32_t b)
{
    if (a / kChunkSize == b / kChunkSize) {
        chunks_[a / kChunkSize].appendOwn(std::min(a, b) % kChunkSize, std::max(a, b) % kChunkSize,
                                          false, {});
    } else {
        appendForeign(a, PartnerSource::mobile, b);
        appendForeign(b, PartnerSource::mobile, a);
    }
}

template <class Real>
void ContactLists<Real>::appendForeign(std::uint32_t slot, PartnerSource source,
                                       std::uint32_t index)
{
    chunks_[slot / kChunkSize].appendForeign(slot % kChunkSize, source, index, false, {});
}

template <class Real>
std::size_t ContactLists<Real>::bytes() const
{
    std::size_t sum = balls_.capacity() * sizeof(Ball) + columns_.bytes() +
                      frozenColumns_.balls.bytes() + boundaryColumns_.balls.bytes() +
                      cellOfSlot_.capacity() * sizeof(std::uint32_t) +
                      memoryScratch_.capacity() * sizeof(GrainMemory) + cells_.bytes();
    for (const ChunkContacts<Real>& chunk : chunks_) {
        sum += chunk.bytes();
    }
    return sum;
}

template class ContactLists<float>;
template class ContactLists<double>;

}  // namespace sandflow
