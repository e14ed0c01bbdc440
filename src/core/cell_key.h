#pragma once

#include "core/errors.h"

#include <cmath>
#include <cstdint>

namespace sandflow {

/// Integer coordinates of a cubic cell of a uniform grid.
struct CellIndex {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t k = 0;

    bool operator==(const CellIndex&) const = default;
};

/// Bits per axis in a packed key, and the indices they can hold: [-kCellIndexLimit, limit - 1].
/// With cells of 1.5 cm that is 15 km to either side.
inline constexpr int kCellIndexBits = 21;
inline constexpr std::int32_t kCellIndexLimit = 1 << (kCellIndexBits - 1);

/// Index of the cell that holds `coordinate` [m]: floor(coordinate / cellSize). A multiplication
/// by the inverse, so that everyone who shares a cell size agrees on the borders. Throws
/// InternalError if the coordinate is not a number or farther out than a key can tell.
inline std::int32_t cellCoordinate(double coordinate, double inverseCellSize)
{
    const double cell = std::floor(coordinate * inverseCellSize);
    // Written so that NaN fails too; converting it, or too large a value, would be undefined.
    SAND_CHECK(cell >= -kCellIndexLimit && cell < kCellIndexLimit,
               "coordinate {} m lies outside the {} cells per side of the grid", coordinate,
               kCellIndexLimit);
    return static_cast<std::int32_t>(cell);
}

/// One 64-bit key for three indices, layout (high to low): 0 | k:21 | j:21 | i:21, each index
/// offset to be non-negative. Neighbours along x have keys that differ by one.
/// Throws InternalError for an index out of range: two cells must never share a key.
inline std::uint64_t packCellKey(std::int32_t i, std::int32_t j, std::int32_t k)
{
    const std::uint64_t a = static_cast<std::uint64_t>(std::int64_t{i} + kCellIndexLimit);
    const std::uint64_t b = static_cast<std::uint64_t>(std::int64_t{j} + kCellIndexLimit);
    const std::uint64_t c = static_cast<std::uint64_t>(std::int64_t{k} + kCellIndexLimit);
    SAND_CHECK(((a | b | c) >> kCellIndexBits) == 0, "cell ({}, {}, {}) cannot be keyed", i, j, k);
    return a | (b << kCellIndexBits) | (c << (2 * kCellIndexBits));
}

inline std::uint64_t packCellKey(const CellIndex& cell)
{
    return packCellKey(cell.i, cell.j, cell.k);
}

/// The indices a key was packed from.
inline CellIndex unpackCellKey(std::uint64_t key)
{
    constexpr std::uint64_t mask = (std::uint64_t{1} << kCellIndexBits) - 1;
    const auto index = [](std::uint64_t bits) {
        return static_cast<std::int32_t>(static_cast<std::int64_t>(bits) - kCellIndexLimit);
    };
    return {index(key & mask), index((key >> kCellIndexBits) & mask),
            index((key >> (2 * kCellIndexBits)) & mask)};
}

/// Spreads a key over all 64 bits. A product carries differences upwards only, a shift brings them
/// back down; two rounds let every bit of the key reach every bit of the hash. The constants are
/// 2^64 / golden ratio and 2^64 * (sqrt(2) - 1), made odd. The map is one to one.
constexpr std::uint64_t mixCellKey(std::uint64_t key)
{
    key ^= key >> 32;
    key *= 0x9E3779B97F4A7C15u;
    key ^= key >> 29;
    key *= 0x6A09E667F3BCC909u;
    key ^= key >> 32;
    return key;
}

}  // namespace sandflow
