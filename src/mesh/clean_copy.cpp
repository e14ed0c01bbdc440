#include "mesh/clean_copy.h"

#include "core/hash.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace sandflow {

static_assert(std::endian::native == std::endian::little, "clean copies are written as in memory");

std::uint64_t hashOfFace(std::span<const Vec3f> corners)
{
    std::uint64_t hash = corners.size();
    for (const Vec3f& corner : corners) {
        for (int axis = 0; axis < 3; ++axis) {
            // + 0 makes the two zeros one.
            hash = extendHash(hash, std::bit_cast<std::uint32_t>(corner[axis] + 0.0f));
        }
    }
    return hash;
}

bool PlyWriter::addPoint(const Vec3& p)
{
    const Vec3f rounded = p.cast<float>();
    if (!rounded.allFinite()) {
        return false;
    }
    points_.push_back(rounded);
    return true;
}

void PlyWriter::addFace(std::span<const std::uint32_t> corners)
{
    corners_.clear();
    appendBytes(faceBytes_, static_cast<std::uint16_t>(corners.size()));
    for (const std::uint32_t corner : corners) {
        appendBytes(faceBytes_, corner);
        corners_.push_back(points_[corner]);
    }
    ++faces_;
    faceSum_ += hashOfFace(corners_);
}

CleanCopy PlyWriter::finish() const
{
    CleanCopy copy;
    copy.fileName = "clean.ply";
    copy.bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list ushort uint vertex_indices\nend_header\n",
        points_.size(), faces_);
    copy.bytes.reserve(copy.bytes.size() + points_.size() * sizeof(Vec3f) + faceBytes_.size());
    copy.bytes.append(reinterpret_cast<const char*>(points_.data()),
                      points_.size() * sizeof(Vec3f));
    copy.bytes += faceBytes_;
    copy.faces = faces_;
    copy.faceSum = faceSum_;
    return copy;
}

}  // namespace sandflow
