#include "verification/bulk_orifice.h"

#include "core/vec3.h"
#include "mesh/write_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sandflow::verification {
namespace {

constexpr std::uint32_t kCorners = 96;  ///< of the hole; a multiple of 8, so that the plate's
                                        ///< corners are met

}  // namespace

/// Four rings of points: inner and outer edge, top and bottom.
///
///        outer +--------------+ inner   hole    +---------------+
///              |  plate       |                 |               |
///              +--------------+                 +---------------+
std::string writeOrificePlate(const OrificePlate& plate)
{
    TriangleMesh mesh;
    for (const double z : {plate.top, plate.top - plate.thickness}) {
        for (const bool outer : {false, true}) {
            for (std::uint32_t k = 0; k < kCorners; ++k) {
                const double angle = 2.0 * kPi * k / kCorners;
                const Vec2 u(std::cos(angle), std::sin(angle));
                const double reach =
                    outer ? plate.halfEdge / u.cwiseAbs().maxCoeff() : plate.holeRadius;
                mesh.points.emplace_back(reach * u.x(), reach * u.y(), z);
            }
        }
    }
    const auto ring = [](std::uint32_t which, std::uint32_t k) {
        return which * kCorners + k % kCorners;
    };
    const std::uint32_t innerTop = 0, outerTop = 1, innerBottom = 2, outerBottom = 3;
    // Two triangles per face between ring a and ring b; seen from outside, a lies left of b.
    const auto addBand = [&](std::uint32_t a, std::uint32_t b) {
        for (std::uint32_t k = 0; k < kCorners; ++k) {
            mesh.triangles.push_back({ring(a, k), ring(b, k), ring(b, k + 1)});
            mesh.triangles.push_back({ring(a, k), ring(b, k + 1), ring(a, k + 1)});
        }
    };
    addBand(innerTop, outerTop);
    addBand(outerTop, outerBottom);
    addBand(outerBottom, innerBottom);
    addBand(innerBottom, innerTop);
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        fmt::format("sandflow_orifice_{:.0f}um.ply", 1e6 * plate.holeRadius);
    return writeMesh(mesh, path.string());
}

}  // namespace sandflow::verification
