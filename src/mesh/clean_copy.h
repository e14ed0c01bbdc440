#pragma once

#include "core/vec3.h"

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
    std::string fileName;            ///< what assimp is told; its ending names the format
    std::string bytes;
    std::string buffer;              ///< glTF: the content of kBufferName
    std::uint64_t faces = 0;         ///< of three or more corners, once for every node with them
    std::uint64_t faceSum = 0;       ///< sum of hashOfFace over the same faces
    std::vector<std::string> repairs;  ///< one sentence each

    static constexpr const char* kBufferName = "geometry.bin";
};

/// Of the corners in their order, before any node moves them. Sums of these do not depend on the
/// order of the faces.
std::uint64_t hashOfFace(std::span<const Vec3f> corners);

/// Polygons with more corners are refused: assimp needs up to the cube of their number to split
/// one.
inline constexpr std::size_t kMaxCorners = 256;

/// Makes the clean copy of formats that have points and faces with indices, as binary PLY: text
/// numbers are rounded once, by us, and faces may have any number of corners.
class PlyWriter {
public:
    /// Returns whether the point is finite in single precision; if not it is not added.
    bool addPoint(const Vec3& p);
    /// Every index below pointCount(), 3 to kMaxCorners of them.
    void addFace(std::span<const std::uint32_t> corners);
    std::size_t pointCount() const { return points_.size(); }
    std::size_t faceCount() const { return static_cast<std::size_t>(faces_); }

    CleanCopy finish() const;

private:
    std::vector<Vec3f> points_;
    std::string faceBytes_;
    std::vector<Vec3f> corners_;  ///< of the face at hand
    std::uint64_t faces_ = 0;
    std::uint64_t faceSum_ = 0;
};

/// Appends the bytes of a number as they stand in memory; the formats here are little-endian.
template <typename Number>
void appendBytes(std::string& bytes, Number number)
{
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace sandflow
