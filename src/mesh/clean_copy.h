#pragma once

#include "core/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sandflow {

/// What a gate hands to assimp instead of the file: the same geometry and nothing else, in the one
/// dialect of PLY, STL or glTF that assimp is known to read rightly. assimp 5.2.5 crashes or hangs
/// on some malformed files and turns others into wrong geometry without a word, so every file is
/// read strictly first, and what assimp makes of the copy is compared with what the gate saw.
struct CleanCopy {
    std::string fileName;  ///< what assimp is told; its ending names the format
    std::string bytes;
    std::string buffer;                ///< glTF: the content of kBufferName
    std::uint64_t faces = 0;           ///< triangles, once for every node with them
    std::uint64_t faceSum = 0;         ///< sum of hashOfFace over the same triangles
    std::vector<std::string> repairs;  ///< one sentence each

    static constexpr const char* kBufferName = "geometry.bin";
};

/// Of the corners in their order, before any node moves them. Sums of these do not depend on the
/// order of the faces.
std::uint64_t hashOfFace(const std::array<Vec3f, 3>& corners);

/// Makes the clean copy of formats that have points and faces with indices, as binary PLY with
/// triangles. assimp's own readers of text round some numbers twice.
class PlyWriter {
public:
    /// `file` is the name for messages.
    explicit PlyWriter(const std::string& file) : file_(file) {}

    /// Returns whether the point is finite in single precision; if not it is not added.
    bool addPoint(const Vec3& p);
    /// Every index below pointCount(), 3 to kMaxCorners of them. Returns whether the polygon could
    /// be split into triangles. Throws InputError where all of them together would take long.
    bool addFace(std::span<const std::uint32_t> corners);
    std::size_t pointCount() const { return points_.size(); }

    CleanCopy finish() const;

private:
    std::vector<Vec3f> points_;
    std::string faceBytes_;
    // Of the polygon at hand.
    std::vector<Vec3> corners_;
    std::vector<std::array<std::uint32_t, 3>> split_;
    const std::string& file_;
    std::uint64_t faces_ = 0;  ///< triangles
    std::uint64_t faceSum_ = 0;
    double splitWork_ = 0.0;   ///< sum of cubes of the polygons' corners
};

/// Appends the bytes of a number as they stand in memory; the formats here are little-endian.
template <typename Number>
void appendBytes(std::string& bytes, Number number)
{
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace sandflow
