#include "grains/buried_grains.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

void BuriedGrains::add(const Vec3& position, double radius, std::uint32_t id)
{
    const Vec3 scaled = position / cellSize_;
    const CellIndex at = {cellCoordinate(scaled.x(), 1.0), cellCoordinate(scaled.y(), 1.0),
                          cellCoordinate(scaled.z(), 1.0)};
    const auto [slot, isNew] =
        cellOf_.insert(packCellKey(at), static_cast<std::uint32_t>(cells_.size()));
    if (isNew) {
        cells_.push_back({at, {}});
    }
    const auto fraction = [](double value, std::int32_t cell) {
        const double part = std::floor((value - cell) * 65536.0);
        return static_cast<std::uint16_t>(std::clamp(part, 0.0, 65535.0));
    };
    cells_[*slot].grains.push_back({fraction(scaled.x(), at.i), fraction(scaled.y(), at.j),
                                    fraction(scaled.z(), at.k), static_cast<float>(radius), id});
    ++count_;
    lowest_ = std::min(lowest_, at.k);

    const auto layer = static_cast<std::uint32_t>(at.k + kCellIndexLimit);
    const auto [top, isFirst] = columnTop_.insert(packCellKey(at.i, at.j, 0), layer);
    if (!isFirst) {
        *top = std::max(*top, layer);
    }
}

void BuriedGrains::clear()
{
    cellOf_.clear();
    columnTop_.clear();
    cells_.clear();
    lowest_ = kCellIndexLimit;
    count_ = 0;
}

std::int32_t BuriedGrains::lowestLayer(double z) const
{
    const double layer = std::floor(z / cellSize_);
    return static_cast<std::int32_t>(
        std::clamp(layer, -double{kCellIndexLimit}, double{kCellIndexLimit - 1}));
}

std::size_t BuriedGrains::bytes() const
{
    std::size_t sum = cells_.capacity() * sizeof(Cell);
    for (const Cell& cell : cells_) {
        sum += cell.grains.capacity() * sizeof(Grain);
    }
    return sum + 16 * 2 * (cellOf_.capacity() + columnTop_.capacity());
}

}  // namespace sandflow
