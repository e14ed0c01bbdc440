#include "mesh/clean_copy.h"

#include "core/hash.h"
#include "mesh/refuse_mesh.h"
#include "mesh/split_polygon.h"

#include <fmt/format.h>

#include <bit>

namespace sandflow {

/// At worst a second: 1,000 spirals of 256 corners, or any number of quads and hexagons.
constexpr double kMostSplitWork = 1.5e10;

static_assert(std::endian::native == std::endian::little, "clean copies are written as in memory");

std::uint64_t hashOfFace(const std::array<Vec3f, 3>& corners)
{
    std::uint64_t hash = 0;
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

bool PlyWriter::addFace(std::span<const std::uint32_t> corners)
{
    const auto count = static_cast<double>(corners.size());
    splitWork_ += count > 6.0 ? count * count * count : 0.0;
    if (splitWork_ > kMostSplitWork) {
        refuseMesh(file_, "its polygons have too many corners; split them into triangles in a "
                          "modelling program");
    }
    corners_.clear();
    for (const std::uint32_t corner : corners) {
        corners_.push_back(points_[corner].cast<double>());
    }
    if (!splitPolygon(corners_, split_)) {
        return false;
    }
    for (const auto& triangle : split_) {
        faceBytes_ += '\x03';
        std::array<Vec3f, 3> places;
        for (std::size_t k = 0; k < 3; ++k) {
            appendBytes(faceBytes_, corners[triangle[k]]);
            places[k] = points_[corners[triangle[k]]];
        }
        faceSum_ += hashOfFace(places);
    }
    faces_ += split_.size();
    return true;
}

CleanCopy PlyWriter::finish() const
{
    CleanCopy copy;
    copy.fileName = "clean.ply";
    copy.bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
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
