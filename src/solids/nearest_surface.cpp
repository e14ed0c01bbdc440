#include "core/errors.h"
#include "solids/axis_frame.h"
#include "solids/primitive.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

/// Below this length the square of a vector underflows and its direction is lost, m.
constexpr double kPointLike = 1e-150;

/// Distance and direction from the nearest surface point to p; `onSurface` where they coincide.
SurfacePoint measureOffset(const Vec3& offset, const Vec3& onSurface)
{
    const double distance = offset.norm();
    if (!(distance > kPointLike)) {
        return {0.0, onSurface};
    }
    return {distance, offset / distance};
}

SurfacePoint nearestOnPlane(const Primitive& plane, const Vec3& p)
{
    return {plane.axis.dot(p - plane.point), plane.axis};
}

/// A point inside or on the box: out through the nearest face.
SurfacePoint nearestFace(const Primitive& box, const Vec3& p)
{
    SurfacePoint nearest{-1e300, Vec3::UnitZ()};
    for (int axis = 0; axis < 3; ++axis) {
        const double below = box.min[axis] - p[axis];
        const double above = p[axis] - box.max[axis];
        if (below > nearest.distance) {
            nearest = {below, -Vec3::Unit(axis)};
        }
        if (above > nearest.distance) {
            nearest = {above, Vec3::Unit(axis)};
        }
    }
    return nearest;
}

SurfacePoint nearestOnBox(const Primitive& box, const Vec3& p)
{
    const Vec3 closest = p.cwiseMax(box.min).cwiseMin(box.max);
    if (closest == p) {
        return nearestFace(box, p);
    }
    return measureOffset(p - closest, nearestFace(box, closest).normal);
}

SurfacePoint nearestOnPanel(const Primitive& panel, const Vec3& p)
{
    const Vec3 closest = p.cwiseMax(panel.min).cwiseMin(panel.max);
    return measureOffset(p - closest, Vec3::Unit(panelNormalAxis(panel)));
}

/// The offset with components `along` the axis and `outward` from it, seen from the surface.
SurfacePoint measureOffset(double along, double outward, const AxisPoint& at, const Vec3& axis,
                           const Vec3& onSurface)
{
    const double distance = std::sqrt(along * along + outward * outward);
    if (!(distance > kPointLike)) {
        return {0.0, onSurface};
    }
    return {distance, (along / distance) * axis + (outward / distance) * at.outward};
}

SurfacePoint nearestOnDisc(const Primitive& disc, const Vec3& p)
{
    const AxisPoint at = locateOnAxis(disc, p);
    return measureOffset(at.along, std::max(at.radial - disc.radius, 0.0), at, disc.axis,
                         disc.axis);
}

SurfacePoint nearestOnTube(const Primitive& tube, const Vec3& p)
{
    const AxisPoint at = locateOnAxis(tube, p);
    const double past = at.along - std::clamp(at.along, 0.0, tube.height);
    return measureOffset(past, at.radial - tube.radius, at, tube.axis, at.outward);
}

SurfacePoint nearestOnCylinder(const Primitive& cylinder, const Vec3& p)
{
    const AxisPoint at = locateOnAxis(cylinder, p);
    const double side = at.radial - cylinder.radius;
    const double bottom = -at.along;
    const double top = at.along - cylinder.height;

    // Out through the nearest of side, bottom and top; all three are negative inside.
    SurfacePoint nearest{side, at.outward};
    if (bottom > nearest.distance) {
        nearest = {bottom, -cylinder.axis};
    }
    if (top > nearest.distance) {
        nearest = {top, cylinder.axis};
    }
    if (nearest.distance <= 0.0) {
        return nearest;
    }
    const double past = at.along - std::clamp(at.along, 0.0, cylinder.height);
    return measureOffset(past, std::max(side, 0.0), at, cylinder.axis, nearest.normal);
}

}  // namespace

SurfacePoint nearestSurface(const Primitive& primitive, const Vec3& point)
{
    switch (primitive.kind) {
        case Primitive::Kind::halfSpace:
            return nearestOnPlane(primitive, point);
        case Primitive::Kind::solidBox:
            return nearestOnBox(primitive, point);
        case Primitive::Kind::panel:
            return nearestOnPanel(primitive, point);
        case Primitive::Kind::disc:
            return nearestOnDisc(primitive, point);
        case Primitive::Kind::solidCylinder:
            return nearestOnCylinder(primitive, point);
        case Primitive::Kind::tube:
            return nearestOnTube(primitive, point);
    }
    throw InternalError(
        fmt::format("unknown kind of primitive {}", static_cast<int>(primitive.kind)));
}

}  // namespace sandflow
