#include "dem/contact_lists.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

template <class Real>
void ContactLists<Real>::sortMobile(double horizon, MobileGrains<Real>& mobile)
{
    const auto n = static_cast<std::int64_t>(mobile.size());
    centreScratch_.resize(mobile.size());
    reachScratch_.resize(mobile.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        const GrainRecord<Real>& g = mobile.record[k];
        const Vec3 ahead = Vec3(g.vx, g.vy, g.vz) * (0.5 * horizon);
        centreScratch_[k] = Vec3(g.x, g.y, g.z) + ahead;
        reachScratch_[k] = 0.5 * skin_ + ahead.norm();
    }
    cells_.build(centreScratch_);

    mobile.next.resize(mobile.size());
    memoryScratch_.resize(mobile.size());
    centre_.resize(mobile.size());
    reach_.resize(mobile.size());
    search_.resize(mobile.size());
    const std::span<const std::uint32_t> order = cells_.order();
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        mobile.next[k] = mobile.record[order[k]];
        memoryScratch_[k] = mobile.memory[order[k]];
        centre_[k] = centreScratch_[order[k]];
        reach_[k] = reachScratch_[order[k]];
        search_[k] = {centre_[k].x(), centre_[k].y(), centre_[k].z(),
                      reach_[k] + static_cast<double>(mobile.next[k].radius)};
    }
    mobile.record.swap(mobile.next);
    mobile.memory.swap(memoryScratch_);

    const std::size_t chunkCount = (mobile.size() + kChunkSize - 1) / kChunkSize;
    chunks_.resize(chunkCount);
    origins_.resize(chunkCount);
    balls_.resize(mobile.size());
    cellOfSlot_.resize(mobile.size());
    for (std::uint32_t c = 0; c < cells_.cells().size(); ++c) {
        std::fill(cellOfSlot_.begin() + cells_.cells()[c].begin,
                  cellOfSlot_.begin() + cells_.cells()[c].end, c);
    }
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        const std::int64_t chunk = k / kChunkSize;
        const Vec3 origin = centre_[chunk * kChunkSize];
        const Vec3f ball = (centre_[k] - origin).cast<float>();
        // The ball is left a little early rather than late when its centre rounds.
        balls_[k] = {ball.x(), ball.y(), ball.z(), static_cast<float>(reach_[k]) * 0.9999f};
        if (k % kChunkSize == 0) {
            origins_[chunk] = origin;
        }
    }
    spreadSearchRadius();
}

/// A grain with a long reach can have partners cells away, and those must look as far to find it.
template <class Real>
void ContactLists<Real>::spreadSearchRadius()
{
    const std::span<const SortedCells::Cell> cells = cells_.cells();
    searchRadius_.assign(cells.size(), 1);
    cellReach_.assign(cells.size(), 0.0);
    longestReach_ = 0.0;
    strays_.clear();
    std::vector<std::pair<std::uint32_t, int>> wide;
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
        for (std::uint32_t k = cells[c].begin; k < cells[c].end; ++k) {
            cellReach_[c] = std::max(cellReach_[c], search_[k].reach);
        }
        longestReach_ = std::max(longestReach_, cellReach_[c]);
        const int radius =
            static_cast<int>(std::ceil(2.0 * cellReach_[c] / cells_.cellSize()));
        SAND_CHECK(radius < 100, "a grain needs {} cells of search: it is far too fast", radius);
        if (radius > 1) {
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
        SearchScratch scratch;
#pragma omp for schedule(dynamic, 1)
        for (std::int64_t c = 0; c < chunkCount; ++c) {
            searchChunk(static_cast<std::uint32_t>(c), mobile, frozen, boundary, walls, time, book,
                        scratch);
        }
    }
}

template <class Real>
void ContactLists<Real>::searchChunk(std::uint32_t chunk, const MobileGrains<Real>& mobile,
                                     const FixedView& frozen, const FixedView& boundary,
                                     std::span<const Primitive> walls, double time,
                                     const ContactBook<Real>& book, SearchScratch& scratch)
{
    ChunkContacts<Real>& out = chunks_[chunk];
    out.clear();
    const std::uint32_t first = chunk * kChunkSize;
    const std::uint32_t last =
        std::min<std::uint32_t>(first + kChunkSize, static_cast<std::uint32_t>(mobile.size()));
    out.grainCount = last - first;

    // Cells too far apart for the longest reach in either hold no partners: near a fast grain most
    // of the cells within the search radius do not.
    const auto collect = [&](const SortedCells& cells, const CellIndex& at, int radius,
                             double ownReach, auto reachOf, std::vector<Range>& ranges) {
        ranges.clear();
        const auto gap = [&](std::int32_t a, std::int32_t b) {
            return std::max(std::abs(a - b) - 1, 0) * cells.cellSize();
        };
        cells.visitNear(at, radius, [&](const SortedCells::Cell& cell) {
            const double dx = gap(cell.index.i, at.i), dy = gap(cell.index.j, at.j),
                         dz = gap(cell.index.k, at.k);
            const double reach = ownReach + reachOf(cell);
            if (dx * dx + dy * dy + dz * dz < reach * reach) {
                ranges.push_back({cell.begin, cell.end});
            }
        });
    };
    const auto mobileReach = [&](const SortedCells::Cell& cell) {
        return cellReach_[&cell - cells_.cells().data()];
    };
    const auto fixedReach = [&](const SortedCells::Cell&) { return largestRadius_; };
    const auto remembered = [&](const GrainRecord<Real>& a, std::uint32_t rowA, std::uint32_t idB,
                                std::uint32_t rowB, PairHistory<Real>& springs) {
        if (rowA != ContactBook<Real>::kNoRow) {  // a contact stands in the rows of both
            const auto* h = book.find(rowA, idB);
            springs = h ? *h : PairHistory<Real>{};
            return h != nullptr;
        }
        if (const auto* h = book.find(rowB, a.id)) {
            springs = {-h->sx, -h->sy, -h->sz, -h->qx, -h->qy, -h->qz};
            return true;
        }
        springs = {};
        return false;
    };

    std::uint32_t currentCell = 0xFFFFFFFFu;
    for (std::uint32_t i = first; i < last; ++i) {
        if (cellOfSlot_[i] != currentCell) {
            currentCell = cellOfSlot_[i];
            const CellIndex at = cells_.cells()[currentCell].index;
            const int radius = searchRadius_[currentCell];
            const double reach = cellReach_[currentCell];
            collect(cells_, at, radius, reach, mobileReach, scratch.mobile);
            collect(frozen.cells, at, radius, reach, fixedReach, scratch.frozen);
            collect(boundary.cells, at, radius, reach, fixedReach, scratch.boundary);
        }
        const GrainRecord<Real>& a = mobile.record[i];
        const std::uint32_t rowA = mobile.memory[i].row;
        const Vec3 at = centre_[i];
        const double reach = search_[i].reach;
        PairHistory<Real> springs;

        // Mobile partners, each list in slot order so that it does not depend on the search's.
        scratch.partners.clear();
        for (const Range& range : scratch.mobile) {
            for (std::uint32_t j = range.begin; j < range.end; ++j) {
                const SearchBall& b = search_[j];
                const double limit = reach + b.reach;
                const double dx = b.x - at.x(), dy = b.y - at.y(), dz = b.z - at.z();
                if (dx * dx + dy * dy + dz * dz < limit * limit && (j > i || j < first)) {
                    scratch.partners.push_back(j);
                }
            }
        }
        std::sort(scratch.partners.begin(), scratch.partners.end());
        for (const std::uint32_t j : scratch.partners) {
            const bool live = remembered(a, rowA, mobile.record[j].id, mobile.memory[j].row, springs);
            const std::uint32_t flag = live ? partner::kLive : 0u;
            if (j >= first && j < last) {
                out.own.push_back(own_pair::pack(i - first, j - first) | flag);
                out.ownHistory.push_back(springs);
            } else {
                out.foreign.push_back(partner::pack(PartnerSource::mobile, j) | flag);
                out.foreignSlot.push_back(static_cast<std::uint16_t>(i - first));
                out.foreignHistory.push_back(springs);
            }
        }
        // Fixed partners.
        const auto listFixed = [&](const FixedView& fixed, PartnerSource source,
                                   const std::vector<Range>& ranges) {
            scratch.partners.clear();
            for (const Range& range : ranges) {
                for (std::uint32_t j = range.begin; j < range.end; ++j) {
                    const GrainRecord<Real>& b = fixed.record[j];
                    const double limit = reach + static_cast<double>(b.radius);
                    const double dx = b.x - at.x(), dy = b.y - at.y(), dz = b.z - at.z();
                    if (dx * dx + dy * dy + dz * dz < limit * limit) {
                        scratch.partners.push_back(j);
                    }
                }
            }
            std::sort(scratch.partners.begin(), scratch.partners.end());
            for (const std::uint32_t j : scratch.partners) {
                const bool live = remembered(a, rowA, fixed.record[j].id,
                                             ContactBook<Real>::kNoRow, springs);
                out.foreign.push_back(partner::pack(source, j) | (live ? partner::kLive : 0u));
                out.foreignSlot.push_back(static_cast<std::uint16_t>(i - first));
                out.foreignHistory.push_back(springs);
            }
        };
        listFixed(frozen, PartnerSource::frozen, scratch.frozen);
        listFixed(boundary, PartnerSource::boundary, scratch.boundary);
    }
    searchWalls(chunk, mobile, walls, time, book);
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
    double chunkReach = 0.0;
    for (std::uint32_t i = first; i < last; ++i) {
        chunkReach = std::max(chunkReach, (centre_[i] - origins_[chunk]).norm() + reach_[i] +
                                              static_cast<double>(mobile.record[i].radius));
    }
    for (std::uint32_t w = 0; w < walls.size(); ++w) {
        if (walls[w].rough || !walls[w].existsAt(time) ||
            std::abs(nearestSurface(walls[w], origins_[chunk]).distance) > chunkReach) {
            continue;
        }
        for (std::uint32_t i = first; i < last; ++i) {
            const double reach = static_cast<double>(mobile.record[i].radius) + reach_[i];
            if (nearestSurface(walls[w], centre_[i]).distance < reach) {
                const auto* springs = book.find(mobile.memory[i].row, kFirstWallId + w);
                out.walls.push_back({(i - first) | (springs ? partner::kLive : 0u), w});
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
    const auto [centre, reach] = ballAhead(mobile.record[slot]);
    const SearchBall ball = {centre.x(), centre.y(), centre.z(), reach};
    const auto meets = [](const SearchBall& a, double x, double y, double z, double otherReach) {
        const double dx = a.x - x, dy = a.y - y, dz = a.z - z, limit = a.reach + otherReach;
        return dx * dx + dy * dy + dz * dz < limit * limit;
    };
    std::vector<SearchBall> older = {search_[slot]};
    for (const Stray& stray : strays_) {
        if (stray.slot == slot) {
            older.push_back(stray.ball);
        }
    }
    const auto metBefore = [&](double x, double y, double z, double otherReach) {
        return std::any_of(older.begin(), older.end(), [&](const SearchBall& b) {
            return meets(b, x, y, z, otherReach);
        });
    };

    // Mobile partners: by their first balls, which are in the cells, and by later ones.
    std::vector<std::uint32_t> partners;
    const CellIndex at = cells_.cellOf(centre);
    const auto radius = static_cast<std::int32_t>(
        std::ceil((reach + longestReach_) / cells_.cellSize()));
    cells_.visitNear(at, radius, [&](const SortedCells::Cell& cell) {
        for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
            const SearchBall& b = search_[j];
            if (j != slot && meets(ball, b.x, b.y, b.z, b.reach)) {
                partners.push_back(j);
            }
        }
    });
    for (const Stray& other : strays_) {
        if (other.slot != slot &&
            meets(ball, other.ball.x, other.ball.y, other.ball.z, other.ball.reach)) {
            partners.push_back(other.slot);
        }
    }
    std::sort(partners.begin(), partners.end());
    partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
    std::erase_if(partners, [&](std::uint32_t j) {
        const SearchBall& b = search_[j];
        return metBefore(b.x, b.y, b.z, b.reach) ||
               std::any_of(strays_.begin(), strays_.end(), [&](const Stray& other) {
                   return other.slot == j && metBefore(other.ball.x, other.ball.y, other.ball.z,
                                                       other.ball.reach);
               });
    });
    for (const std::uint32_t j : partners) {
        appendPair(slot, j);
    }

    const auto appendFixed = [&](const FixedView& fixed, PartnerSource source) {
        const auto cellsAway = static_cast<std::int32_t>(
            std::ceil((reach + largestRadius_) / fixed.cells.cellSize()));
        fixed.cells.visitNear(fixed.cells.cellOf(centre), cellsAway,
                              [&](const SortedCells::Cell& cell) {
            for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
                const GrainRecord<Real>& b = fixed.record[j];
                const auto otherReach = static_cast<double>(b.radius);
                if (meets(ball, b.x, b.y, b.z, otherReach) &&
                    !metBefore(b.x, b.y, b.z, otherReach)) {
                    appendForeign(slot, partner::pack(source, j));
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
            return nearestSurface(walls[w], Vec3(b.x, b.y, b.z)).distance < b.reach;
        };
        if (reaches(ball) && std::none_of(older.begin(), older.end(), reaches)) {
            chunk.walls.push_back({slot % kChunkSize, w});
            chunk.wallHistory.push_back({});
        }
    }

    strays_.push_back({slot, ball});
    const Vec3f relative = (centre - origins_[slot / kChunkSize]).template cast<float>();
    const double ownReach = reach - static_cast<double>(mobile.record[slot].radius);
    balls_[slot] = {relative.x(), relative.y(), relative.z(),
                    static_cast<float>(ownReach) * 0.9999f};
}

template <class Real>
void ContactLists<Real>::appendPair(std::uint32_t a, std::uint32_t b)
{
    if (a / kChunkSize == b / kChunkSize) {
        ChunkContacts<Real>& chunk = chunks_[a / kChunkSize];
        chunk.own.push_back(
            own_pair::pack(std::min(a, b) % kChunkSize, std::max(a, b) % kChunkSize));
        chunk.ownHistory.push_back({});
    } else {
        appendForeign(a, partner::pack(PartnerSource::mobile, b));
        appendForeign(b, partner::pack(PartnerSource::mobile, a));
    }
}

template <class Real>
void ContactLists<Real>::appendForeign(std::uint32_t slot, std::uint32_t packedPartner)
{
    ChunkContacts<Real>& chunk = chunks_[slot / kChunkSize];
    chunk.foreign.push_back(packedPartner);
    chunk.foreignSlot.push_back(static_cast<std::uint16_t>(slot % kChunkSize));
    chunk.foreignHistory.push_back({});
}

template <class Real>
std::size_t ContactLists<Real>::bytes() const
{
    std::size_t sum = balls_.capacity() * sizeof(Ball);
    for (const ChunkContacts<Real>& chunk : chunks_) {
        sum += chunk.bytes();
    }
    return sum;
}

template class ContactLists<float>;
template class ContactLists<double>;

}  // namespace sandflow
