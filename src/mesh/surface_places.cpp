#include "mesh/surface_places.h"

#include "core/errors.h"
#include "core/hash.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

SurfacePlaces::SurfacePlaces(const TriangleMesh& mesh, std::uint64_t count, std::uint64_t seed)
    : mesh_(mesh), seed_(seed)
{
    areaUpTo_.reserve(mesh.triangles.size());
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3& origin = mesh.points[a];
        area += 0.5 * (mesh.points[b] - origin).cross(mesh.points[c] - origin).norm();
        areaUpTo_.push_back(area);
    }
    SAND_CHECK(area > 0.0 && count > 0, "{} places on {} m2", count, area);
    stretch_ = area / static_cast<double>(count);

    const std::size_t slots = areaUpTo_.size();
    slotsPerArea_ = static_cast<double>(slots) / area;
    slotBegin_.reserve(slots);
    std::uint32_t triangle = 0;
    for (std::size_t slot = 0; slot < slots; ++slot) {
        while (areaUpTo_[triangle] * slotsPerArea_ < static_cast<double>(slot)) {
            ++triangle;
        }
        slotBegin_.push_back(triangle);
    }
}

/// The first triangle that ends beyond `along` [m2]: never one without area.
std::uint32_t SurfacePlaces::triangleAt(double along) const
{
    const auto slot = static_cast<std::size_t>(along * slotsPerArea_);
    std::uint32_t triangle = slotBegin_[std::min(slot, slotBegin_.size() - 1)];
    // Backwards only where the two roundings of a slot's border differ.
    while (triangle > 0 && areaUpTo_[triangle - 1] > along) {
        --triangle;
    }
    while (areaUpTo_[triangle] <= along) {
        ++triangle;
    }
    return triangle;
}

SurfacePlace SurfacePlaces::at(std::uint64_t number) const
{
    const std::uint64_t bits = extendHash(seed_, number);
    // Rounding must not carry the last place beyond the last triangle.
    const double along = std::min((static_cast<double>(number) + unitFromBits(bits)) * stretch_,
                                  std::nextafter(areaUpTo_.back(), 0.0));
    const std::uint32_t triangle = triangleAt(along);
    const double before = triangle == 0 ? 0.0 : areaUpTo_[triangle - 1];

    // The share of the triangle's area that lies before the place says how far from corner a it is
    // (the area up to there grows with the square), chance says where between the sides.
    //
    //        a
    //       / \          s = 0
    //      /   \         .
    //     / . p \        s = sqrt(share)
    //    b-------c       s = 1
    const double share = std::min((along - before) / (areaUpTo_[triangle] - before), 1.0);
    const double s = std::sqrt(share);
    const double t = unitFromBits(mixBits(bits));
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Vec3 point =
        (1.0 - s) * mesh_.points[a] + (s * (1.0 - t)) * mesh_.points[b] + (s * t) * mesh_.points[c];
    return {point, triangle};
}

}  // namespace sandflow
