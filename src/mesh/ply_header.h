#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

enum class PlyFormat { ascii, littleEndian, bigEndian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t sizeOf(PlyType type);  ///< bytes
bool isInteger(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;  ///< of the number, or of the numbers in the list
    bool isList = false;
    PlyType countType = PlyType::uint8;  ///< lists: of the count before it
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    PlyElement vertex;         ///< with x, y and z, no lists
    PlyElement face;           ///< with one list of indices
    bool facesAreLast = true;  ///< no other element behind them
    std::size_t bodyAt = 0;    ///< byte at which the numbers begin
};

/// The list of a face that holds its corners.
bool isIndexList(const PlyProperty& property);

/// Throws InputError for anything that is not the header of a mesh of points and faces.
PlyHeader readPlyHeader(std::string_view bytes, const std::string& file);

}  // namespace sandflow
