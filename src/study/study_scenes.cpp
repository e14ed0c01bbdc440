#include "study/study_scenes.h"

namespace sandflow {

SolidSpec makeLevelFloor(bool rough)
{
    SolidSpec floor;
    floor.shape = SolidShape::plane;
    floor.name = "floor";
    floor.rough = rough;
    return floor;
}

SolidSpec makeContainer(const Vec2& half, double height, bool bottom)
{
    SolidSpec box;
    box.shape = SolidShape::box;
    box.name = "container";
    box.hollow = true;
    box.floor = bottom;
    box.min = Vec3(-half.x(), -half.y(), 0.0);
    box.max = Vec3(half.x(), half.y(), height);
    return box;
}

EmitterSpec makeSettledFill(const Vec2& half, double depth)
{
    EmitterSpec fill;
    fill.kind = EmitterKind::fill;
    fill.name = "sand";
    fill.min = Vec3(-half.x(), -half.y(), 0.0);
    fill.max = Vec3(half.x(), half.y(), depth);
    return fill;
}

EmitterSpec makeOneGrain(const Vec3& position, const Vec3& velocity)
{
    EmitterSpec grain;
    grain.kind = EmitterKind::single;
    grain.name = "grain";
    grain.position = position;
    grain.velocity = velocity;
    return grain;
}

}  // namespace sandflow
