#include "grains/sorted_cells.h"

#include <bit>
#include <omp.h>

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

/// Every third bit, side by side again.
std::uint64_t gatherBits(std::uint64_t v)
{
    v &= 0x1249249249249249u;
    v = (v | v >> 2) & 0x10C30C30C30C30C3u;
    v = (v | v >> 4) & 0x100F00F00F00F00Fu;
    v = (v | v >> 8) & 0x001F0000FF0000FFu;
    v = (v | v >> 16) & 0x001F00000000FFFFu;
    v = (v | v >> 32) & 0x1FFFFF;
    return v;
}

/// Where the curve counts indices from. With this pattern of bits the cells about the origin, where
/// scenes lie, differ in few low bits only, and fewer bits are sorted in fewer passes; counted from
/// the lowest index, cells -1 and 0 would differ in every bit.
constexpr std::uint64_t kMortonOffset = 0x155555;
constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kCellIndexBits) - 1;

CellIndex cellOfKey(std::uint64_t key)
{
    const auto index = [](std::uint64_t bits) {
        const std::uint64_t wrapped =
            (gatherBits(bits) - kMortonOffset + kCellIndexLimit) & kIndexMask;
        return static_cast<std::int32_t>(wrapped) - kCellIndexLimit;
    };
    return {index(key), index(key >> 1), index(key >> 2)};
}

}  // namespace

std::uint64_t SortedCells::curveKey(const CellIndex& cell)
{
    const auto bits = [](std::int32_t index) {
        return spreadBits(static_cast<std::uint64_t>(std::int64_t{index}) + kMortonOffset);
    };
    return bits(cell.i) | bits(cell.j) << 1 | bits(cell.k) << 2;
}

void SortedCells::sortEntries()
{
    sortByKey();

    order_.resize(entries_.size());
    cells_.clear();
    std::uint64_t previous = ~std::uint64_t{0};
    for (std::uint32_t e = 0; e < entries_.size(); ++e) {
        order_[e] = entries_[e].point;
        if (entries_[e].key != previous) {
            previous = entries_[e].key;
            if (!cells_.empty()) {
                cells_.back().end = e;
            }
            cells_.push_back({cellOfKey(previous), e, 0});
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
        // Cells of a row come in pairs along the curve: ask once for both.
        if (c > 0 && cells_[c - 1].index.j == at.j && cells_[c - 1].index.k == at.k) {
            rowOfCell_[c] = rowOfCell_[c - 1];
        } else {
            const auto [row, isNew] = rowOf_.insert(packCellKey(0, at.j, at.k),
                                                    static_cast<std::uint32_t>(rows_.size()));
            if (isNew) {
                rows_.push_back({0, 0});
            }
            rowOfCell_[c] = *row;
        }
        ++rows_[rowOfCell_[c]].end;
        low_ = c == 0 ? at : CellIndex{0, std::min(low_.j, at.j), std::min(low_.k, at.k)};
        high_ = c == 0 ? at : CellIndex{0, std::max(high_.j, at.j), std::max(high_.k, at.k)};
    }
    tabulateRows();
    std::uint32_t sum = 0;
    for (Row& row : rows_) {
        const std::uint32_t count = row.end;
        row.begin = row.end = sum;
        sum += count;
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        // Along the curve the cells of a row ascend, except where indices wrap, kilometres away.
        Row& row = rows_[rowOfCell_[c]];
        std::uint32_t at = row.end++;
        for (; at > row.begin && rowCells_[at - 1].i > cells_[c].index.i; --at) {
            rowCells_[at] = rowCells_[at - 1];
        }
        rowCells_[at] = {cells_[c].index.i, c};
    }
}

/// Rows of sand that lies together are found in a table in place of the hash, in a quarter of the
/// time. Sand scattered far and wide has none.
void SortedCells::tabulateRows()
{
    rowTable_.clear();
    if (cells_.empty()) {
        return;
    }
    tableWidth_ = static_cast<std::size_t>(high_.j - low_.j) + 1;
    const std::size_t size = tableWidth_ * (static_cast<std::size_t>(high_.k - low_.k) + 1);
    if (size > 16 * rows_.size() + 1024) {
        return;
    }
    rowTable_.assign(size, kNoRowHere);
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        rowTable_[tableIndex(cells_[c].index.j, cells_[c].index.k)] = rowOfCell_[c];
    }
}

/// Stable radix sort from the lowest digit. Bits above the highest in which two keys differ need no
/// pass: a heap a hundred cells wide takes two. A stable sort has one result, however many threads
/// share it.
void SortedCells::sortByKey()
{
    constexpr int kMostBits = 11;  // per pass: a count per digit fits the first-level cache
    const auto n = static_cast<std::int64_t>(entries_.size());
    const bool many = entries_.size() > kFewPoints;
    std::uint64_t differ = 0;
#pragma omp parallel for schedule(static) reduction(| : differ) if (many)
    for (std::int64_t k = 0; k < n; ++k) {
        differ |= entries_[k].key ^ entries_[0].key;
    }
    const int bits = 64 - std::countl_zero(differ);
    if (bits == 0) {
        return;
    }
    const int passes = (bits + kMostBits - 1) / kMostBits;
    const int digitBits = (bits + passes - 1) / passes;
    const std::size_t digits = std::size_t{1} << digitBits;
    const std::int64_t blocks = many ? omp_get_max_threads() : 1;
    const auto blockBegin = [&](std::int64_t b) { return n * b / blocks; };

    scratch_.resize(entries_.size());
    digitCount_.resize(static_cast<std::size_t>(blocks) * digits);
    for (int shift = 0; shift < bits; shift += digitBits) {
        const auto digitOf = [&](const Entry& e) { return e.key >> shift & (digits - 1); };
#pragma omp parallel for schedule(static, 1) if (many)
        for (std::int64_t b = 0; b < blocks; ++b) {
            std::uint32_t* count = digitCount_.data() + static_cast<std::size_t>(b) * digits;
            std::fill(count, count + digits, 0);
            for (std::int64_t k = blockBegin(b); k < blockBegin(b + 1); ++k) {
                ++count[digitOf(entries_[k])];
            }
        }
        std::uint32_t sum = 0;
        for (std::size_t digit = 0; digit < digits; ++digit) {
            for (std::int64_t b = 0; b < blocks; ++b) {
                std::uint32_t& count = digitCount_[static_cast<std::size_t>(b) * digits + digit];
                const std::uint32_t here = count;
                count = sum;
                sum += here;
            }
        }
#pragma omp parallel for schedule(static, 1) if (many)
        for (std::int64_t b = 0; b < blocks; ++b) {
            std::uint32_t* place = digitCount_.data() + static_cast<std::size_t>(b) * digits;
            for (std::int64_t k = blockBegin(b); k < blockBegin(b + 1); ++k) {
                scratch_[place[digitOf(entries_[k])]++] = entries_[k];
            }
        }
        entries_.swap(scratch_);
    }
}

}  // namespace sandflow
