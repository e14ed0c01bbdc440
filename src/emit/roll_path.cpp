#include "emit/roll_path.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

/// A direction of motion that makes less than this (cosine) towards a contact grazes it; that costs
/// an overlap of its square. Also what a push may fall short of 0 by.
constexpr double kTolerance = 1e-9;

/// Nearer to equilibrium than this (sine) the way down is noise.
constexpr double kBalanced = 1e-12;

constexpr double kNever = 1e30;

/// Unit horizontal direction in which a grain rolls off a sphere; any when exactly on top.
Vec3 rollOffDirection(const Vec3& normal)
{
    const double out = normal.head<2>().norm();
    return out > kBalanced ? Vec3(normal.x() / out, normal.y() / out, 0.0) : Vec3(Vec3::UnitX());
}

/// True when the unit direction v runs into none of the supports but the one or two it rolls on.
bool isFeasible(const SupportList& supports, const Vec3& v, int first, int second)
{
    for (int k = 0; k < supports.size(); ++k) {
        if (k != first && k != second && supports[k].normal.dot(v) < -kTolerance) {
            return false;
        }
    }
    return true;
}

/// True when pushes >= 0 along the three normals carry the weight.
bool carriesWeight(const Support& a, const Support& b, const Support& c)
{
    Eigen::Matrix3d normals;
    normals << a.normal, b.normal, c.normal;
    const double volume = normals.determinant();
    if (std::abs(volume) < 1e-9) {
        return false;
    }
    const Vec3 pushes = normals.inverse() * Vec3::UnitZ();
    return pushes.minCoeff() >= -kTolerance;
}

/// t at which `pressed` stops pressing while the grain rolls on it and on `other`. With N normals
/// n1, n2 and c = n1.n2 (constant on the circle), the push of 1 is (n1z - c n2z) / (1 - c^2), and
/// n_z = (p_z - c_z) / R for a sphere, 0 for a wall: linear in the grain's height.
double releaseAngle(const Arc& arc, const Support& pressed, const Support& other)
{
    const double c = pressed.normal.dot(other.normal);
    double slope = 0.0;
    double offset = 0.0;
    if (!pressed.isFlat()) {
        slope += 1.0 / pressed.reach;
        offset += pressed.centre.z() / pressed.reach;
    }
    if (!other.isFlat()) {
        slope -= c / other.reach;
        offset -= c * other.centre.z() / other.reach;
    }
    const double amplitude = arc.radius * arc.up.z();
    if (slope <= 0.0) {
        return kPi;  // the push does not shrink on the way down
    }
    const double cosine = (offset / slope - arc.centre.z()) / amplitude;
    const double t = std::acos(std::clamp(cosine, -1.0, 1.0));
    // Pressing now, so a zero behind us is rounding at the very start of the path.
    return std::max(t, arc.from);
}

}  // namespace

bool SupportList::has(std::int32_t id) const
{
    for (int k = 0; k < size_; ++k) {
        if (supports_[static_cast<std::size_t>(k)].id == id) {
            return true;
        }
    }
    return false;
}

Motion chooseMotion(const SupportList& supports)
{
    const Vec3 down = -Vec3::UnitZ();
    const int n = supports.size();
    if (isFeasible(supports, down, -1, -1)) {
        return {Motion::Kind::fall, -1, -1};
    }
    for (int i = 0; i < n; ++i) {
        const Vec3& normal = supports[i].normal;
        if (supports[i].id == Support::kFloor) {
            return {Motion::Kind::rest, i, -1};
        }
        // -z less its part along n, as a unit vector: noise near the top must not point into a
        // wall.
        const Vec3 downhill =
            normal.z() * rollOffDirection(normal) - normal.head<2>().norm() * Vec3::UnitZ();
        if (normal.z() > kTolerance && isFeasible(supports, downhill, i, -1)) {
            return {Motion::Kind::rollOne, i, -1};
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = i + 1; j < n; ++j) {
            const Vec3& a = supports[i].normal;
            const Vec3& b = supports[j].normal;
            const double c = a.dot(b);
            const double det = 1.0 - c * c;
            if (det < 1e-12) {
                continue;
            }
            const double pushA = (a.z() - c * b.z()) / det;
            const double pushB = (b.z() - c * a.z()) / det;
            const Vec3 along = a.cross(b).normalized();
            const Vec3 downhill = along.z() > 0.0 ? Vec3(-along) : along;
            if (pushA >= -kTolerance && pushB >= -kTolerance && downhill.z() < -kBalanced &&
                isFeasible(supports, downhill, i, j)) {
                return {Motion::Kind::rollTwo, i, j};
            }
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = i + 1; j < n; ++j) {
            for (int k = j + 1; k < n; ++k) {
                if (carriesWeight(supports[i], supports[j], supports[k])) {
                    return {Motion::Kind::rest, i, j};
                }
            }
        }
    }
    return {};
}

Vec3 Arc::at(double t) const
{
    return centre + radius * (std::cos(t) * up + std::sin(t) * side);
}

void Arc::bounds(Vec3& lo, Vec3& hi) const
{
    const Vec3 start = at(from);
    const Vec3 end = at(to);
    lo = start.cwiseMin(end);
    hi = start.cwiseMax(end);
    for (int axis = 0; axis < 3; ++axis) {
        // The extremes of cos t up + sin t side lie at t = atan2(side, up) and half a turn on.
        const double extreme = std::atan2(side[axis], up[axis]);
        for (const double t : {extreme, extreme + kPi}) {
            if (t > from && t < to) {
                const double value = at(t)[axis];
                lo[axis] = std::min(lo[axis], value);
                hi[axis] = std::max(hi[axis], value);
            }
        }
    }
}

Arc arcOverOne(const Vec3& p, const Support& support)
{
    Arc arc;
    arc.centre = support.centre;
    arc.radius = support.reach;
    arc.up = Vec3::UnitZ();
    const Vec3 away = p - support.centre;
    arc.side = rollOffDirection(support.normal);
    arc.from = std::atan2(away.head<2>().norm(), away.z());
    arc.to = std::max(arc.from, 0.5 * kPi);
    return arc;
}

bool arcOverTwo(const Vec3& p, const Support& a, const Support& b, Arc& arc)
{
    const Support& sphere = a.isFlat() ? b : a;
    const Support& other = a.isFlat() ? a : b;
    Vec3 axis;
    double along = 0.0;  // from the sphere's centre to the circle's plane
    if (other.isFlat()) {
        axis = other.normal;
        along = (other.centre - sphere.centre).dot(axis);
    } else {
        const Vec3 between = other.centre - sphere.centre;
        const double distance = between.norm();
        axis = between / distance;
        along = (distance * distance + sphere.reach * sphere.reach - other.reach * other.reach) /
                (2.0 * distance);
    }
    const double lift = std::sqrt(std::max(0.0, 1.0 - axis.z() * axis.z()));
    const double square = sphere.reach * sphere.reach - along * along;
    if (lift < 1e-6 || square <= 1e-12 * sphere.reach * sphere.reach) {
        return false;
    }
    arc.centre = sphere.centre + along * axis;
    arc.radius = std::sqrt(square);
    arc.up = (Vec3::UnitZ() - axis.z() * axis) / lift;
    const Vec3 across = axis.cross(arc.up);
    const Vec3 away = p - arc.centre;
    arc.side = away.dot(across) >= 0.0 ? across : Vec3(-across);
    arc.from = std::atan2(away.dot(arc.side), away.dot(arc.up));
    arc.to = std::min(releaseAngle(arc, a, b), releaseAngle(arc, b, a));
    return true;
}

double firstRise(double a, double b, double c, double from)
{
    const double squared = a * a + b * b;
    if (c > 0.0 && c * c >= squared) {
        return kNever;
    }
    if (a * std::sin(from) + b * std::cos(from) > c) {
        return from;
    }
    // a sin t + b cos t = m cos(t - top) is above c within acos(c / m) of its top.
    const double m = std::sqrt(squared);
    const double top = std::atan2(a, b);
    double ahead = top - std::acos(std::clamp(c / m, -1.0, 1.0)) - from;
    while (ahead < 0.0) {
        ahead += 2.0 * kPi;
    }
    // A root a rounding error behind us is a root here.
    return ahead > 2.0 * kPi - 1e-7 ? from : from + ahead;
}

}  // namespace sandflow
