#pragma once

#include "solids/primitive.h"

#include <cmath>

namespace sandflow {

/// A point in the cylindrical coordinates of a disc, cylinder or tube.
struct AxisPoint {
    double along;   ///< m, from primitive.point along the axis
    double radial;  ///< m, from the axis, >= 0
    Vec3 outward;   ///< unit, from the axis towards the point; any perpendicular on the axis
};

/// Some unit vector perpendicular to a unit vector; UnitX for UnitZ.
inline Vec3 makePerpendicular(const Vec3& unit)
{
    // The world axis that is not close to `unit`, so that the projection does not vanish.
    const Vec3 other = std::abs(unit.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    return (other - unit.dot(other) * unit).normalized();
}

inline AxisPoint locateOnAxis(const Primitive& primitive, const Vec3& p)
{
    const Vec3 offset = p - primitive.point;
    const double along = primitive.axis.dot(offset);
    Vec3 across = offset - along * primitive.axis;
    // Close to the axis rounding leaves a part along it; a second projection removes that.
    across -= primitive.axis.dot(across) * primitive.axis;
    const double radial = across.norm();
    // 1e-15: less is rounding, and has no direction.
    if (!(radial > 1e-15 * (std::abs(along) + primitive.radius))) {
        return {along, 0.0, makePerpendicular(primitive.axis)};
    }
    return {along, radial, across / radial};
}

/// The axis (0, 1, 2) along which a panel has no extent.
inline int panelNormalAxis(const Primitive& panel)
{
    int axis = 2;
    (panel.max - panel.min).minCoeff(&axis);
    return axis;
}

}  // namespace sandflow
