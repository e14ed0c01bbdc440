#pragma once

#include "scene/scene_fields.h"

#include <string>
#include <vector>

/// Keys of [[solids]] and [[emitters]], as in scene_fields.h. `shape` and `kind` come first: they
/// decide which of the other keys exist, so a visitor that fills must fill them before it goes on.
namespace sandflow {

/// A solid of that shape with every default: only planes are rough.
inline SolidSpec makeDefaultSolid(SolidShape shape)
{
    SolidSpec solid;
    solid.shape = shape;
    solid.rough = shape == SolidShape::plane;
    return solid;
}

/// An emitter of that kind with every default.
inline EmitterSpec makeDefaultEmitter(EmitterKind kind)
{
    EmitterSpec emitter;
    emitter.kind = kind;
    return emitter;
}

/// A solid or emitter of the same shape or kind, everything else at its default.
inline SolidSpec makeDefaultLike(const SolidSpec& solid)
{
    return makeDefaultSolid(solid.shape);
}
inline EmitterSpec makeDefaultLike(const EmitterSpec& emitter)
{
    return makeDefaultEmitter(emitter.kind);
}

template <SpecOf<SolidSpec> T, class Visitor>
void visitSelector(T& solid, Visitor& visit)
{
    visit(Key{"shape", "", "What it is; decides which other keys it has.", Need::required},
          solid.shape, Choices<SolidShape>(words::kShapes));
}

template <SpecOf<SolidSpec> T, class Visitor>
void visitFields(T& solid, Visitor& visit)
{
    visitSelector(solid, visit);
    visit(Key{"name", "", "For messages and the picture."}, solid.name, Text{});
    visit(Key{"from", "s", "It exists from this time on."}, solid.from, limits::kTime);
    visit(Key{"until", "s", "It is gone from this time on; absent: it stays."}, solid.until,
          OpenRange{limits::kUntil, limits::kOpenEnd});
    visit(Key{"look", "", "Material in the generated picture."}, solid.look,
          Choices<const char*>(words::kLooks));
    switch (solid.shape) {
        case SolidShape::plane:
            visit(Key{"rough", "", "Covered with fixed grains, as a sanded floor; false: smooth."},
                  solid.rough, Flag{});
            visit(Key{"point", "m", "Any point of the plane."}, solid.point, limits::kCoordinate);
            visit(Key{"normal", "", "Out of the solid, towards the sand."}, solid.normal,
                  Direction{});
            return;
        case SolidShape::box:
        case SolidShape::cylinder:
        case SolidShape::disc:
        case SolidShape::mesh:
            visit(Key{"rough", "", "Must be false: only planes can be rough."}, solid.rough,
                  Flag{});
            break;
    }
    if (solid.shape == SolidShape::box) {
        visit(Key{"min", "m", "Lower corner.", Need::required}, solid.min, limits::kCoordinate);
        visit(Key{"max", "m", "Upper corner.", Need::required}, solid.max, limits::kCoordinate);
    }
    if (solid.shape == SolidShape::cylinder) {
        visit(Key{"point", "m", "Centre of its base."}, solid.point, limits::kCoordinate);
        visit(Key{"axis", "", "From the base to the top."}, solid.normal, Direction{});
        visit(Key{"radius", "m", "Its radius.", Need::required}, solid.radius, limits::kLength);
        visit(Key{"height", "m", "Its length along the axis.", Need::required}, solid.height,
              limits::kLength);
    }
    if (solid.shape == SolidShape::disc) {
        visit(Key{"point", "m", "Its centre."}, solid.point, limits::kCoordinate);
        visit(Key{"normal", "", "Perpendicular to it; either side works."}, solid.normal,
              Direction{});
        visit(Key{"radius", "m", "Its radius.", Need::required}, solid.radius, limits::kLength);
    }
    if (solid.shape == SolidShape::mesh) {
        visit(Key{"mesh", "", "File of triangles, relative to the scene file.", Need::required},
              solid.mesh, Text{.mayBeEmpty = false});
        visit(Key{"stand_in", "", "Another file, used where the first cannot be found."},
              solid.standIn, Text{});
        visit(Key{"up", "", "Which axis of the file points up."}, solid.up,
              Choices<UpAxis>(words::kUpAxes));
        visit(Key{"scale", "m", "Length of one unit of the file."}, solid.scale,
              limits::kMeshScale);
        visit(Key{"fit_height", "m", "Scaled to this height instead."}, solid.fitHeight,
              OptionalRange{limits::kLength});
        visit(Key{"fit_length", "m", "Scaled until its longer horizontal side is this instead."},
              solid.fitLength, OptionalRange{limits::kLength});
        visit(Key{"turn", "degrees", "Turned about z, counter-clockwise from above."}, solid.turn,
              limits::kTurn);
        visit(Key{"stand", "", "The middle of its bottom is put on point; false: its origin is."},
              solid.stand, Flag{});
        visit(Key{"point", "m", "Where it stands."}, solid.point, limits::kCoordinate);
        return;
    }
    if (solid.shape != SolidShape::disc) {
        visit(Key{"hollow", "", "A container of thin walls, open at the top, instead of a block."},
              solid.hollow, Flag{});
        visit(Key{"floor", "", "A hollow one is closed below; false: walls only."}, solid.floor,
              Flag{});
    }
}

template <SpecOf<EmitterSpec> T, class Visitor>
void visitSelector(T& emitter, Visitor& visit)
{
    visit(Key{"kind", "", "What it is; decides which other keys it has.", Need::required},
          emitter.kind, Choices<EmitterKind>(words::kKinds));
}

template <SpecOf<EmitterSpec> T, class Visitor>
void visitFields(T& emitter, Visitor& visit)
{
    const auto visitBox = [&] {
        visit(Key{"min", "m", "Lower corner of the box.", Need::required}, emitter.min,
              limits::kCoordinate);
        visit(Key{"max", "m", "Upper corner of the box.", Need::required}, emitter.max,
              limits::kCoordinate);
    };

    visitSelector(emitter, visit);
    visit(Key{"name", "", "For messages."}, emitter.name, Text{});
    visit(Key{"start", "s", "When it begins."}, emitter.start, limits::kTime);
    switch (emitter.kind) {
        case EmitterKind::jet:
        case EmitterKind::slot:
            visit(Key{"count", "grains", "Grains in all; then it stops.", Need::required},
                  emitter.count, limits::kCount);
            visit(Key{"rate", "grains/s", "Grains per second.", Need::required}, emitter.rate,
                  limits::kRate);
            visit(Key{"position", "m", "Centre of the opening.", Need::required}, emitter.position,
                  limits::kCoordinate);
            visit(Key{"direction", "", "Where the grains go, perpendicular to the opening."},
                  emitter.direction, Direction{});
            visit(Key{"speed", "m/s", "Speed of the grains as they leave.", Need::required},
                  emitter.speed, limits::kSpeed);
            if (emitter.kind == EmitterKind::jet) {
                visit(Key{"radius", "m", "Radius of the round opening.", Need::required},
                      emitter.radius, limits::kLength);
            } else {
                visit(Key{"size", "m", "The opening's width (horizontal) and height.",
                          Need::required},
                      emitter.size, limits::kLength);
            }
            break;
        case EmitterKind::block:
            visit(Key{"count", "grains", "Grains in the box, all at once.", Need::required},
                  emitter.count, limits::kCount);
            visitBox();
            visit(Key{"velocity", "m/s", "Of all its grains."}, emitter.velocity,
                  limits::kVelocity);
            break;
        case EmitterKind::fill:
            visit(Key{"count", "grains", "Settled grains in the box; 0: until it is full."},
                  emitter.count, limits::kCountOrFull);
            visitBox();
            break;
        case EmitterKind::pile:
            visit(Key{"count", "grains", "Settled grains of the cone.", Need::required},
                  emitter.count, limits::kCount);
            visit(Key{"position", "m", "Centre of the cone's base."}, emitter.position,
                  limits::kCoordinate);
            visit(Key{"slope_angle", "degrees", "Slope of the cone."}, emitter.slopeAngle,
                  limits::kSlope);
            break;
        case EmitterKind::single:
            visit(Key{"position", "m", "Centre of the grain.", Need::required}, emitter.position,
                  limits::kCoordinate);
            visit(Key{"velocity", "m/s", "Its velocity."}, emitter.velocity, limits::kVelocity);
            visit(Key{"spin", "rad/s", "Its angular velocity."}, emitter.spin, limits::kSpin);
            visit(Key{"radius", "m", "Its radius; absent: the mean radius of the grains."},
                  emitter.grainRadius, OptionalRange{limits::kGrainRadius});
            break;
    }
}

/// One solid or emitter of each shape or kind, with its name, every default set.
template <class Spec>
struct Variant {
    std::string name;
    Spec spec;
};

inline std::vector<Variant<SolidSpec>> makeVariants(const SolidSpec&)
{
    std::vector<Variant<SolidSpec>> variants;
    for (const auto& shape : words::kShapes) {
        variants.push_back({shape.name, makeDefaultSolid(shape.value)});
    }
    return variants;
}

inline std::vector<Variant<EmitterSpec>> makeVariants(const EmitterSpec&)
{
    std::vector<Variant<EmitterSpec>> variants;
    for (const auto& kind : words::kKinds) {
        variants.push_back({kind.name, makeDefaultEmitter(kind.value)});
    }
    return variants;
}

/// The lists of tables of the file: visit(name, meaning, list).
template <SpecOf<Scene> T, class Visitor>
void visitLists(T& scene, Visitor&& visit)
{
    visit("solids", "Rigid, fixed bodies. None is needed, but then the sand falls for ever.",
          scene.solids);
    visit("emitters", "Where sand comes from; at least one.", scene.emitters);
}

/// Writes down the names of the keys it meets.
struct KeyCollector {
    std::vector<std::string> names;

    template <class Value, class Rule>
    void operator()(const Key& key, const Value&, const Rule&)
    {
        names.emplace_back(key.name);
    }
};

}  // namespace sandflow
