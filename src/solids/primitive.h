#pragma once

#include "core/vec3.h"
#include "mesh/solid_interval.h"
#include "scene/scene.h"

#include <vector>

namespace sandflow {

/// Where a point stands against a solid's surface.
struct SurfacePoint {
    double distance;  ///< m, from the surface along the normal; negative inside a filled solid
    Vec3 normal;      ///< unit, out of the solid, towards the point
};

/// One convex or thin piece of a solid, so that a sphere has at most one contact with it.
/// A hollow container is several panels or one tube wall.
struct Primitive {
    enum class Kind {
        halfSpace,      ///< everything below a plane
        solidBox,       ///< axis-aligned, filled
        panel,          ///< thin axis-aligned rectangle: contact from both sides
        disc,           ///< thin round plate: contact from both sides
        solidCylinder,  ///< filled, with caps
        tube            ///< thin cylindrical wall without caps: contact from both sides
    };
    Kind kind = Kind::halfSpace;
    int solid = 0;        ///< index into Scene::solids
    double from = 0.0;    ///< s
    double until = 1e30;  ///< s
    bool rough = false;
    Vec3 point = Vec3::Zero();  ///< on the plane; disc centre; cylinder and tube: base centre
    Vec3 axis = Vec3::UnitZ();  ///< plane or disc normal, cylinder axis; unit
    Vec3 min = Vec3::Zero();    ///< box, panel (panel: min == max along its normal)
    Vec3 max = Vec3::Zero();
    double radius = 0.0;
    double height = 0.0;

    bool existsAt(double time) const { return time >= from && time < until; }
    /// No particles cover it: only contacts with the surface itself hold grains.
    bool isSmoothAt(double time) const { return !rough && existsAt(time); }
};

/// How messages call a solid: solids[2] ("table").
std::string nameSolid(const SolidSpec& solid, int index);

/// Splits a solid into primitives. Throws InputError for what cannot be built (empty
/// boxes, radii that are not positive, null directions, roughness on anything but a plane).
std::vector<Primitive> buildPrimitives(const SolidSpec& solid, int solidIndex);

/// Nearest surface point of one primitive, exact, also over edges and rims. The normal is always a
/// finite unit vector: on a thin plate it is the plate's axis, on the axis of a cylinder or tube
/// one of the directions that are equally near.
SurfacePoint nearestSurface(const Primitive& primitive, const Vec3& point);

/// The part of the vertical line through (x, y) inside the primitive; lo >= hi if it is missed.
/// A half-space whose surface is not steep gives [-1e30, z of its surface] ([z, 1e30] if it faces
/// down); a vertical one (|normal.z| < 0.01) the whole line if (x, y) is behind it; a disc or
/// horizontal panel a thin slab (thickness `thin`, m, below its surface); vertical panels, discs on
/// edge and tubes give none (they block links).
SolidInterval solidIntervalAt(const Primitive& primitive, double x, double y, double thin);

/// True if the straight path between two columns' centres, somewhere within heights [lo, hi],
/// crosses a thin vertical wall (panel, tube or disc on edge): then the columns are not neighbours
/// for the sand. Tubes part only columns on different sides. Exact for panels and vertical tubes; a
/// leaning tube is judged at half the common height.
bool blocksPath(const Primitive& primitive, const Vec2& a, const Vec2& b, double lo, double hi);

}  // namespace sandflow
