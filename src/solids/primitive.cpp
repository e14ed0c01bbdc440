#include "solids/primitive.h"

#include "core/errors.h"

#include <cmath>

namespace sandflow {

namespace {

void requirePositive(double value, const char* key, const std::string& name)
{
    if (!(value > 0.0) || !std::isfinite(value)) {
        throw InputError(fmt::format("{}: {} = {} m must be a positive number.", name, key, value));
    }
}

void requireFinite(const Vec3& value, const char* key, const std::string& name)
{
    if (!value.allFinite()) {
        throw InputError(
            fmt::format("{}: {} has a component that is not a finite number.", name, key));
    }
}

Vec3 makeUnit(const Vec3& direction, const char* key, const std::string& name)
{
    const double length = direction.stableNorm();
    if (!(length > 0.0) || !std::isfinite(length)) {
        throw InputError(fmt::format("{}: {} must be a direction, not a null vector.", name, key));
    }
    // stableNormalized of tiny vectors loses digits; scaling first keeps the result unit.
    return (direction / length).normalized();
}

/// What every primitive of a solid has in common.
Primitive startPrimitive(const SolidSpec& solid, int solidIndex, Primitive::Kind kind)
{
    Primitive primitive;
    primitive.kind = kind;
    primitive.solid = solidIndex;
    primitive.from = solid.from;
    primitive.until = solid.until;
    return primitive;
}

/// The face of the box at `at` along one axis.
Primitive makePanel(const SolidSpec& solid, int solidIndex, int normalAxis, double at)
{
    Primitive panel = startPrimitive(solid, solidIndex, Primitive::Kind::panel);
    panel.min = solid.min;
    panel.max = solid.max;
    panel.min[normalAxis] = at;
    panel.max[normalAxis] = at;
    panel.axis = Vec3::Unit(normalAxis);
    panel.point = 0.5 * (panel.min + panel.max);
    return panel;
}

std::vector<Primitive> buildPlane(const SolidSpec& solid, int solidIndex, const std::string& name)
{
    requireFinite(solid.point, "point", name);
    Primitive plane = startPrimitive(solid, solidIndex, Primitive::Kind::halfSpace);
    plane.point = solid.point;
    plane.axis = makeUnit(solid.normal, "normal", name);
    plane.rough = solid.rough;
    return {plane};
}

std::vector<Primitive> buildBox(const SolidSpec& solid, int solidIndex, const std::string& name)
{
    requireFinite(solid.min, "min", name);
    requireFinite(solid.max, "max", name);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(solid.min[axis] < solid.max[axis])) {
            throw InputError(fmt::format("{}: min.{} = {} m must be less than max.{} = {} m.", name,
                                         "xyz"[axis], solid.min[axis], "xyz"[axis],
                                         solid.max[axis]));
        }
    }
    if (!solid.hollow) {
        Primitive box = startPrimitive(solid, solidIndex, Primitive::Kind::solidBox);
        box.min = solid.min;
        box.max = solid.max;
        box.point = 0.5 * (solid.min + solid.max);
        return {box};
    }
    std::vector<Primitive> panels;
    for (int axis = 0; axis < 2; ++axis) {
        panels.push_back(makePanel(solid, solidIndex, axis, solid.min[axis]));
        panels.push_back(makePanel(solid, solidIndex, axis, solid.max[axis]));
    }
    if (solid.floor) {
        panels.push_back(makePanel(solid, solidIndex, 2, solid.min.z()));
    }
    return panels;
}

Primitive makeDisc(const SolidSpec& solid, int solidIndex, const Vec3& normal)
{
    Primitive disc = startPrimitive(solid, solidIndex, Primitive::Kind::disc);
    disc.point = solid.point;
    disc.axis = normal;
    disc.radius = solid.radius;
    return disc;
}

std::vector<Primitive> buildDisc(const SolidSpec& solid, int solidIndex, const std::string& name)
{
    requireFinite(solid.point, "point", name);
    requirePositive(solid.radius, "radius", name);
    return {makeDisc(solid, solidIndex, makeUnit(solid.normal, "normal", name))};
}

std::vector<Primitive> buildCylinder(const SolidSpec& solid, int solidIndex,
                                     const std::string& name)
{
    requireFinite(solid.point, "point", name);
    requirePositive(solid.radius, "radius", name);
    requirePositive(solid.height, "height", name);
    Primitive cylinder = startPrimitive(
        solid, solidIndex, solid.hollow ? Primitive::Kind::tube : Primitive::Kind::solidCylinder);
    cylinder.point = solid.point;
    cylinder.axis = makeUnit(solid.normal, "axis", name);
    cylinder.radius = solid.radius;
    cylinder.height = solid.height;
    if (solid.hollow && solid.floor) {
        return {cylinder, makeDisc(solid, solidIndex, cylinder.axis)};
    }
    return {cylinder};
}

}  // namespace

std::string nameSolid(const SolidSpec& solid, int index)
{
    return solid.name.empty() ? fmt::format("solids[{}]", index)
                              : fmt::format("solids[{}] (\"{}\")", index, solid.name);
}

std::vector<Primitive> buildPrimitives(const SolidSpec& solid, int solidIndex)
{
    const std::string name = nameSolid(solid, solidIndex);
    if (solid.rough && solid.shape != SolidShape::plane) {
        throw InputError(fmt::format("{}: only planes can be rough in this version.", name));
    }
    if (!(solid.from < solid.until)) {
        throw InputError(fmt::format("{}: from = {} s must be earlier than until = {} s.", name,
                                     solid.from, solid.until));
    }
    switch (solid.shape) {
        case SolidShape::plane:
            return buildPlane(solid, solidIndex, name);
        case SolidShape::box:
            return buildBox(solid, solidIndex, name);
        case SolidShape::cylinder:
            return buildCylinder(solid, solidIndex, name);
        case SolidShape::disc:
            return buildDisc(solid, solidIndex, name);
        case SolidShape::mesh:
            throw InternalError(fmt::format("{}: a mesh has no primitives", name));
    }
    throw InternalError(fmt::format("{}: unknown shape {}", name, static_cast<int>(solid.shape)));
}

}  // namespace sandflow
