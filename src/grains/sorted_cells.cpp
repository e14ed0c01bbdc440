#include "grains/sorted_cells.h"

#include <array>

namespace sandflow {
namespace {

/// Every bit of a 21-bit number moved to three times its place.
std::uint64_t spreadBits(std::uint64_t v)
{
    v &= 0x1FFFFF;
    v = (v | v << 32) & 0x001F00000000FFFFu;
    v = (v | v << 16) & 0x001F0000FF0000FFu;
    v = (v | v << 8) & 0x100F00F00F00F00Fu;
    v = (v | v << 4) & 0x10C30C30C30C30C3u;
    v = (v | v << 2) & 0x1249249249249249u;
    return v;
}

std::uint64_t mortonKey(const CellIndex& c)
{
    return spreadBits(static_cast<std::uint64_t>(c.i + kCellIndexLimit)) |
           spreadBits(static_cast<std::uint64_t>(c.j + kCellIndexLimit)) << 1 |
           spreadBits(static_cast<std::uint64_t>(c.k + kCellIndexLimit)) << 2;
}

}  // namespace

void SortedCells::build(std::span<const Vec3> points)
{
    const auto n = static_cast<std::int64_t>(points.size());
    entries_.resize(points.size());
    indexOf_.resize(points.size());
    // A point out of range throws; an exception must not leave the parallel loop, so ask first.
    for (const Vec3& p : points) {
        SAND_CHECK(p.allFinite() && p.cwiseAbs().maxCoeff() * inverse_ < kCellIndexLimit - 1,
                   "point ({}, {}, {}) m cannot be placed in the grid", p.x(), p.y(), p.z());
    }
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        indexOf_[k] = cellOf(points[k]);
        entries_[k] = {mortonKey(indexOf_[k]), static_cast<std::uint32_t>(k)};
    }
    sortByKey();

    order_.resize(points.size());
    cells_.clear();
    std::uint64_t previous = ~std::uint64_t{0};
    for (std::uint32_t e = 0; e < entries_.size(); ++e) {
        order_[e] = entries_[e].point;
        if (entries_[e].key != previous) {
            previous = entries_[e].key;
            if (!cells_.empty()) {
                cells_.back().end = e;
            }
            cells_.push_back({indexOf_[entries_[e].point], e, 0});
        }
    }
    if (!cells_.empty()) {
        cells_.back().end = static_cast<std::uint32_t>(entries_.size());
    }
    buildRows();
}

void SortedCells::buildRows()
{
    rowOf_.clear();
    rows_.clear();
    rowOfCell_.resize(cells_.size());
    rowCells_.resize(cells_.size());
    low_ = {0, 0, 0};
    high_ = {-1, -1, -1};  // no cells: nothing is near
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        const CellIndex& at = cells_[c].index;
        const auto [row, isNew] = rowOf_.insert(packCellKey(0, at.j, at.k),
                                                static_cast<std::uint32_t>(rows_.size()));
        if (isNew) {
            rows_.push_back({0, 0});
        }
        rowOfCell_[c] = *row;
        ++rows_[*row].end;
        low_ = c == 0 ? at : CellIndex{0, std::min(low_.j, at.j), std::min(low_.k, at.k)};
        high_ = c == 0 ? at : CellIndex{0, std::max(high_.j, at.j), std::max(high_.k, at.k)};
    }
    std::uint32_t sum = 0;
    for (Row& row : rows_) {
        const std::uint32_t count = row.end;
        row.begin = row.end = sum;
        sum += count;
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        // Inserted in order: rows are short.
        Row& row = rows_[rowOfCell_[c]];
        std::uint32_t at = row.end++;
        for (; at > row.begin && cells_[rowCells_[at - 1]].index.i > cells_[c].index.i; --at) {
            rowCells_[at] = rowCells_[at - 1];
        }
        rowCells_[at] = c;
    }
}

/// Radix sort from the lowest digit (stable); digits that all keys share are passed over, so a heap
/// a few hundred cells wide costs three passes, not six.
void SortedCells::sortByKey()
{
    constexpr int kBits = 11, kDigits = 6;
    constexpr std::uint64_t kMask = (1u << kBits) - 1;
    std::array<std::array<std::uint32_t, 1u << kBits>, kDigits> count{};
    for (const Entry& e : entries_) {
        for (int d = 0; d < kDigits; ++d) {
            ++count[d][(e.key >> (d * kBits)) & kMask];
        }
    }
    scratch_.resize(entries_.size());
    for (int d = 0; d < kDigits; ++d) {
        if (entries_.empty() ||
            count[d][(entries_[0].key >> (d * kBits)) & kMask] == entries_.size()) {
            continue;
        }
        std::uint32_t sum = 0;
        for (std::uint32_t& c : count[d]) {
            const std::uint32_t here = c;
            c = sum;
            sum += here;
        }
        for (const Entry& e : entries_) {
            scratch_[count[d][(e.key >> (d * kBits)) & kMask]++] = e;
        }
        entries_.swap(scratch_);
    }
}

}  // namespace sandflow
