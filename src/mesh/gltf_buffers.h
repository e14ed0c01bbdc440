#pragma once

#include "mesh/json_value.h"
#include "mesh/mesh_gates.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// The numbers of a glTF file: its buffers, seen through its accessors. Everything is checked
/// against the bytes that are there.
class GltfBuffers {
public:
    /// `root` must outlive this; `binaryChunk` is that of a GLB file. Throws InputError.
    GltfBuffers(const JsonValue& root, std::string_view binaryChunk, const std::string& file,
                const ReadSibling& read);

    /// Of an accessor of three floats.
    std::vector<Vec3f> readPoints(std::size_t accessor) const;
    /// Of an accessor of unsigned integers.
    std::vector<std::uint32_t> readIndices(std::size_t accessor) const;
    std::size_t size() const { return size_; }  ///< bytes of all buffers

private:
    /// The bytes of an accessor: element i begins at first + i * stride.
    struct Elements {
        const char* first;
        std::size_t count;
        std::size_t stride;
        std::size_t componentType;
    };

    Elements find(std::size_t accessor, std::string_view type) const;
    std::string loadBuffer(const JsonValue& buffer, std::size_t index, const ReadSibling& read);

    const JsonValue& root_;
    const std::string& file_;
    std::string_view binaryChunk_;
    std::vector<std::string> buffers_;
    std::size_t size_ = 0;
};

/// The item of a top-level array; refuses the file if there is none.
const JsonValue& gltfItem(const JsonValue& root, std::string_view array, std::size_t index,
                          const std::string& file);
/// The index under a key, `fallback` if the key is missing; refuses anything else.
std::size_t gltfIndex(const JsonValue& object, std::string_view key, std::size_t fallback,
                      const std::string& file);

}  // namespace sandflow
