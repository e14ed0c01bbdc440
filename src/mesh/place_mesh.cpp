#include "mesh/place_mesh.h"

#include "core/errors.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Right-handed axes with y up to right-handed axes with z up: a quarter turn about x.
Vec3 fromYUp(const Vec3& p)
{
    return {p.x(), -p.z(), p.y()};
}

/// Cosine and sine; exact for quarter turns, which are the usual ones.
Vec2 directionOf(double degrees)
{
    const double inCircle = std::remainder(degrees, 360.0);
    const double quarters = std::round(inCircle / 90.0);
    const double rest = (inCircle - 90.0 * quarters) * (kPi / 180.0);
    const Vec2 direction(std::cos(rest), std::sin(rest));
    switch ((static_cast<int>(quarters) + 4) % 4) {
        case 1:
            return {-direction.y(), direction.x()};
        case 2:
            return -direction;
        case 3:
            return {direction.y(), -direction.x()};
        default:
            return direction;
    }
}

double fitted(double wanted, double extent, const char* what)
{
    if (!(extent > 0.0) || !std::isfinite(wanted / extent)) {
        throw InputError(fmt::format("the mesh has no {} that could be made {} m; give its scale",
                                     what, wanted));
    }
    return wanted / extent;
}

}  // namespace

double scaleOf(const TriangleMesh& mesh, const MeshPlacement& placement)
{
    SAND_CHECK(!mesh.triangles.empty(), "an empty mesh has no size");
    const Vec3 size = boundsOf(mesh).sizes();
    const double height = placement.yUp ? size.y() : size.z();
    const double length = std::max(size.x(), placement.yUp ? size.z() : size.y());
    if (placement.fitHeight) {
        return fitted(*placement.fitHeight, height, "height");
    }
    if (placement.fitLength) {
        return fitted(*placement.fitLength, length, "length");
    }
    return placement.scale;
}

TriangleMesh placeMesh(TriangleMesh mesh, const MeshPlacement& placement)
{
    const double scale = scaleOf(mesh, placement);
    SAND_CHECK(scale > 0.0 && std::isfinite(scale), "scale = {}", scale);
    const Vec2 turn = directionOf(placement.turnDegrees);
    for (Vec3& p : mesh.points) {
        const Vec3 upright = scale * (placement.yUp ? fromYUp(p) : p);
        p = {turn.x() * upright.x() - turn.y() * upright.y(),
             turn.y() * upright.x() + turn.x() * upright.y(), upright.z()};
    }
    Vec3 base = Vec3::Zero();
    if (placement.stand) {
        const Eigen::AlignedBox3d box = boundsOf(mesh);
        base = {box.center().x(), box.center().y(), box.min().z()};
    }
    for (Vec3& p : mesh.points) {
        p += placement.point - base;
    }
    return mesh;
}

}  // namespace sandflow
