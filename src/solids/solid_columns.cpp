#include "core/errors.h"
#include "solids/axis_frame.h"
#include "solids/primitive.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

constexpr double kFar = 1e30;  ///< m, "to the end of the column"
constexpr SolidInterval kMissed = {kFar, -kFar};

/// A surface whose normal is less than this out of the horizontal counts as vertical (0.6 degrees):
/// its height over a column would say nothing.
constexpr double kVertical = 0.01;

bool isWall(const Primitive& primitive)
{
    return std::abs(primitive.axis.z()) < kVertical;
}

/// Height at which the primitive's plane passes (x, y).
double planeHeight(const Primitive& plane, double x, double y)
{
    const Vec3& n = plane.axis;
    const double height =
        plane.point.z() - (n.x() * (x - plane.point.x()) + n.y() * (y - plane.point.y())) / n.z();
    return std::clamp(height, -kFar, kFar);
}

SolidInterval intervalOfPlane(const Primitive& plane, double x, double y)
{
    if (isWall(plane)) {
        const Vec3 atPoint(x, y, plane.point.z());
        const bool behind = plane.axis.dot(atPoint - plane.point) < 0.0;
        return behind ? SolidInterval{-kFar, kFar} : kMissed;
    }
    const double height = planeHeight(plane, x, y);
    return plane.axis.z() > 0.0 ? SolidInterval{-kFar, height} : SolidInterval{height, kFar};
}

bool isOver(const Primitive& box, double x, double y)
{
    return x >= box.min.x() && x <= box.max.x() && y >= box.min.y() && y <= box.max.y();
}

/// The slab hangs below the surface: sand rests on a plate's true height.
SolidInterval makeSlab(double height, double thin)
{
    return {height - thin, height};
}

SolidInterval intervalOfPanel(const Primitive& panel, double x, double y, double thin)
{
    if (panelNormalAxis(panel) != 2 || !isOver(panel, x, y)) {
        return kMissed;
    }
    return makeSlab(panel.max.z(), thin);
}

SolidInterval intervalOfDisc(const Primitive& disc, double x, double y, double thin)
{
    if (isWall(disc)) {
        return kMissed;
    }
    const double height = planeHeight(disc, x, y);
    const Vec3 offset = Vec3(x, y, height) - disc.point;
    if (offset.squaredNorm() > disc.radius * disc.radius) {
        return kMissed;
    }
    return makeSlab(height, thin);
}

/// Heights of the vertical line between the caps and inside the infinite cylinder. With the line at
/// base + o + s e_z, o horizontal: along(s) = a0 + s n_z, and from |o + s e_z|^2 - along^2 <= R^2
///     A s^2 + 2 B s + C <= 0,  A = n_x^2 + n_y^2,  B = -a0 n_z,  C = |o|^2 - a0^2 - R^2
SolidInterval intervalOfCylinder(const Primitive& cylinder, double x, double y)
{
    const Vec3& n = cylinder.axis;
    const Vec3 o(x - cylinder.point.x(), y - cylinder.point.y(), 0.0);
    const double a0 = n.dot(o);
    double lo = -kFar;
    double hi = kFar;

    if (n.z() == 0.0) {
        if (a0 < 0.0 || a0 > cylinder.height) {
            return kMissed;
        }
    } else {
        const double bottom = -a0 / n.z();
        const double top = (cylinder.height - a0) / n.z();
        lo = std::max(lo, std::min(bottom, top));
        hi = std::min(hi, std::max(bottom, top));
    }

    const double A = n.x() * n.x() + n.y() * n.y();
    const double B = -a0 * n.z();
    const double C = o.squaredNorm() - a0 * a0 - cylinder.radius * cylinder.radius;
    if (A == 0.0) {
        if (C > 0.0) {
            return kMissed;
        }
    } else {
        const double discriminant = B * B - A * C;
        if (discriminant < 0.0) {
            return kMissed;
        }
        // The root whose terms have one sign first, the other from the product C / A of both: no
        // cancellation for an axis that is nearly vertical (A small).
        const double q = -(B + std::copysign(std::sqrt(discriminant), B));
        const double first = q / A;
        const double second = q == 0.0 ? first : C / q;
        lo = std::max(lo, std::min(first, second));
        hi = std::min(hi, std::max(first, second));
    }
    return lo < hi ? SolidInterval{lo + cylinder.point.z(), hi + cylinder.point.z()} : kMissed;
}

/// The height ranges share more than a point.
bool overlap(double lo, double hi, double otherLo, double otherHi)
{
    return std::max(lo, otherLo) < std::min(hi, otherHi);
}

/// A centre exactly on the wall counts to the far side, so that a path from column to column over
/// the wall is cut once and only once.
bool blockedByPanel(const Primitive& panel, const Vec2& a, const Vec2& b, double lo, double hi)
{
    const int normalAxis = panelNormalAxis(panel);
    if (normalAxis == 2 || !overlap(lo, hi, panel.min.z(), panel.max.z())) {
        return false;
    }
    const int alongAxis = 1 - normalAxis;
    const double wall = panel.min[normalAxis];
    if ((a[normalAxis] < wall) == (b[normalAxis] < wall)) {
        return false;
    }
    const double share = (wall - a[normalAxis]) / (b[normalAxis] - a[normalAxis]);
    const double crossing = a[alongAxis] + share * (b[alongAxis] - a[alongAxis]);
    return crossing >= panel.min[alongAxis] && crossing <= panel.max[alongAxis];
}

/// Share of the way from a to b at which the radius is reached; the ends are on different sides.
double crossingShare(const Vec3& a, const Vec3& b, const Primitive& tube)
{
    const auto across = [&](const Vec3& v) -> Vec3 { return v - tube.axis.dot(v) * tube.axis; };
    const Vec3 p = across(a - tube.point);
    const Vec3 step = across(b - a);
    // |p + s step|^2 = R^2, the one root in [0, 1].
    const double A = step.squaredNorm();
    const double B = p.dot(step);
    const double C = p.squaredNorm() - tube.radius * tube.radius;
    const double root = std::sqrt(std::max(B * B - A * C, 0.0));
    // Inside first: leaves by the larger root; outside first: enters by the smaller.
    return std::clamp((-B + (C < 0.0 ? root : -root)) / A, 0.0, 1.0);
}

/// One horizontal cut, half-way up the common heights: exact for a vertical tube, where every cut
/// is the same circle. Two crossings of the circle do not part the columns: sand passes beside it.
bool blockedByTube(const Primitive& tube, const Vec2& a, const Vec2& b, double lo, double hi)
{
    const double rise = tube.height * tube.axis.z();
    const double lean = tube.radius * tube.axis.head<2>().norm();
    const double bottom = std::max(lo, tube.point.z() + std::min(rise, 0.0) - lean);
    const double top = std::min(hi, tube.point.z() + std::max(rise, 0.0) + lean);
    if (!(bottom < top)) {
        return false;
    }
    const double cut = 0.5 * (bottom + top);
    const Vec3 from(a.x(), a.y(), cut);
    const Vec3 to(b.x(), b.y(), cut);
    const bool fromInside = locateOnAxis(tube, from).radial < tube.radius;
    const bool toInside = locateOnAxis(tube, to).radial < tube.radius;
    if (fromInside == toInside) {
        return false;
    }
    const Vec3 crossing = from + crossingShare(from, to, tube) * (to - from);
    const double along = tube.axis.dot(crossing - tube.point);
    return along >= 0.0 && along <= tube.height;
}

/// Only a disc on edge; any other is a floor.
bool blockedByDisc(const Primitive& disc, const Vec2& a, const Vec2& b, double lo, double hi)
{
    if (!isWall(disc)) {
        return false;
    }
    const Vec2 normal = disc.axis.head<2>();
    const double sideA = normal.dot(a - disc.point.head<2>());
    const double sideB = normal.dot(b - disc.point.head<2>());
    if ((sideA < 0.0) == (sideB < 0.0)) {
        return false;
    }
    const Vec2 crossing = a + (sideA / (sideA - sideB)) * (b - a);
    const double reach2 =
        disc.radius * disc.radius - (crossing - disc.point.head<2>()).squaredNorm();
    if (reach2 <= 0.0) {
        return false;
    }
    const double reach = std::sqrt(reach2);
    return overlap(lo, hi, disc.point.z() - reach, disc.point.z() + reach);
}

}  // namespace

SolidInterval solidIntervalAt(const Primitive& primitive, double x, double y, double thin)
{
    switch (primitive.kind) {
        case Primitive::Kind::halfSpace:
            return intervalOfPlane(primitive, x, y);
        case Primitive::Kind::solidBox:
            return isOver(primitive, x, y) ? SolidInterval{primitive.min.z(), primitive.max.z()}
                                           : kMissed;
        case Primitive::Kind::panel:
            return intervalOfPanel(primitive, x, y, thin);
        case Primitive::Kind::disc:
            return intervalOfDisc(primitive, x, y, thin);
        case Primitive::Kind::solidCylinder:
            return intervalOfCylinder(primitive, x, y);
        case Primitive::Kind::tube:
            return kMissed;
    }
    throw InternalError(
        fmt::format("unknown kind of primitive {}", static_cast<int>(primitive.kind)));
}

bool blocksPath(const Primitive& primitive, const Vec2& a, const Vec2& b, double lo, double hi)
{
    switch (primitive.kind) {
        case Primitive::Kind::panel:
            return blockedByPanel(primitive, a, b, lo, hi);
        case Primitive::Kind::tube:
            return blockedByTube(primitive, a, b, lo, hi);
        case Primitive::Kind::disc:
            return blockedByDisc(primitive, a, b, lo, hi);
        case Primitive::Kind::halfSpace:
        case Primitive::Kind::solidBox:
        case Primitive::Kind::solidCylinder:
            return false;  // what fills a column leaves it no free interval to link
    }
    throw InternalError(
        fmt::format("unknown kind of primitive {}", static_cast<int>(primitive.kind)));
}

}  // namespace sandflow
