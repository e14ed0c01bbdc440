#include "grains/sorted_cells.h"

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

template <class Entry>
void SortedCells::takeOrder(const std::vector<Entry>& entries, std::uint64_t shared)
{
    order_.resize(entries.size());
    cells_.clear();
    for (std::uint32_t e = 0; e < entries.size(); ++e) {
        order_[e] = entries[e].point;
        if (e == 0 || entries[e].key != entries[e - 1].key) {
            if (!cells_.empty()) {
                cells_.back().end = e;
            }
            cells_.push_back({cellOfKey(shared | entries[e].key), e, 0});
        }
    }
    if (!cells_.empty()) {
        cells_.back().end = static_cast<std::uint32_t>(entries.size());
    }
    buildRows();
}

template void SortedCells::takeOrder(const std::vector<KeySorter<std::uint32_t>::Entry>&,
                                     std::uint64_t);
template void SortedCells::takeOrder(const std::vector<KeySorter<std::uint64_t>::Entry>&,
                                     std::uint64_t);

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

}  // namespace sandflow
