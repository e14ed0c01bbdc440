#include "io/pov_solids.h"

#include "core/errors.h"
#include "io/number_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace sandflow {
namespace {

/// Thickness drawn for walls and plates, which have none in the simulation, in mean grain radii.
constexpr double kPaneThickness = 0.5;

struct LookMaterial {
    std::string_view look;
    std::string_view material;  ///< macro of materials.inc
};
constexpr LookMaterial kMaterials[] = {{"floor", "FloorLook()"},     {"glass", "GlassLook()"},
                                       {"ceramic", "CeramicLook()"}, {"wood", "WoodLook()"},
                                       {"stone", "StoneLook()"},     {"jade", "JadeLook()"},
                                       {"bronze", "BronzeLook()"}};

std::string_view chooseMaterial(const SolidSpec& solid)
{
    const auto found = std::ranges::find(kMaterials, solid.look, &LookMaterial::look);
    if (found != std::end(kMaterials)) {
        return found->material;
    }
    throw InputError(fmt::format("solid \"{}\": unknown look \"{}\": use floor, glass, ceramic, "
                                 "wood, stone, jade, bronze or none",
                                 solid.name, solid.look));
}

/// Comments of POV-Ray end at the line's end; a name must not.
std::string makeComment(std::string_view text)
{
    std::string comment = "  // ";
    for (char c : text) {
        comment += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return comment + '\n';
}

std::string formatBox(const SolidSpec& solid, double unit)
{
    const Vec3 min = solid.min / unit;
    const Vec3 max = solid.max / unit;
    if (!solid.hollow) {
        return fmt::format("box{{{},{}", povVector(min), povVector(max));
    }
    // The wall of the simulation is in the middle of the drawn one. The inner box sticks out where
    // the container is open, so that no skin of zero thickness is left there.
    const Vec3 wall = Vec3::Constant(0.5 * kPaneThickness);
    Vec3 innerMin = min + wall;
    if (!solid.floor) {
        innerMin.z() = min.z() - kPaneThickness;
    }
    Vec3 innerMax = max - wall;
    innerMax.z() = max.z() + kPaneThickness;
    Vec3 outerMax = max + wall;
    outerMax.z() = max.z();
    Vec3 outerMin = min - wall;
    if (!solid.floor) {
        outerMin.z() = min.z();
    }
    return fmt::format("difference{{box{{{},{}}} box{{{},{}}}", povVector(outerMin),
                       povVector(outerMax), povVector(innerMin), povVector(innerMax));
}

std::string formatCylinder(const SolidSpec& solid, double unit)
{
    const Vec3 base = solid.point / unit;
    const Vec3 axis = solid.normal.normalized();
    const double height = solid.height / unit;
    const double radius = solid.radius / unit;
    const Vec3 top = base + height * axis;
    if (!solid.hollow) {
        return fmt::format("cylinder{{{},{},{}", povVector(base), povVector(top),
                           povNumber(radius));
    }
    const double wall = 0.5 * kPaneThickness;
    const Vec3 outerBase = solid.floor ? Vec3(base - wall * axis) : base;
    const Vec3 innerBase = solid.floor ? Vec3(base + wall * axis) : Vec3(base - wall * axis);
    return fmt::format("difference{{cylinder{{{},{},{}}} cylinder{{{},{},{}}}",
                       povVector(outerBase), povVector(top), povNumber(radius + wall),
                       povVector(innerBase), povVector(top + kPaneThickness * axis),
                       povNumber(radius - wall));
}

/// The shape up to, but without, material and closing brace; "" for one that is not drawn.
std::string formatShape(const Scene& scene, std::size_t index, const Vec3& camera,
                        std::span<const SceneMesh> meshes)
{
    const SolidSpec& solid = scene.solids[index];
    const double unit = scene.grains.radius;
    switch (solid.shape) {
        case SolidShape::plane: {
            const Vec3 normal = solid.normal.normalized();
            if (normal.dot(camera - solid.point) <= 0.0) {
                return "";
            }
            const double distance = normal.dot(solid.point) / unit;
            // Walls would keep the light out; below the ground there is nothing to be shaded.
            return fmt::format("plane{{{},{} no_shadow", povVector(normal), povNumber(distance));
        }
        case SolidShape::box: return formatBox(solid, unit);
        case SolidShape::cylinder: return formatCylinder(solid, unit);
        case SolidShape::disc: {
            const Vec3 half = 0.5 * kPaneThickness * solid.normal.normalized();
            const Vec3 centre = solid.point / unit;
            return fmt::format("cylinder{{{},{},{}", povVector(centre - half),
                               povVector(centre + half), povNumber(solid.radius / unit));
        }
        case SolidShape::mesh:
            if (meshOf(meshes, index) == nullptr) {
                throw InputError(fmt::format(
                    "solid \"{}\": its mesh cannot be drawn: its triangles were not loaded",
                    solid.name));
            }
            return fmt::format("object{{{}", povMeshName(index));
    }
    throw InternalError(fmt::format("solid \"{}\" has no shape", solid.name));
}

std::string formatSolid(const Scene& scene, std::size_t index, const Vec3& camera,
                        std::span<const SceneMesh> meshes)
{
    const SolidSpec& solid = scene.solids[index];
    if (solid.look == "none") {
        return "";
    }
    const std::string_view material = chooseMaterial(solid);
    const std::string shape = formatShape(scene, index, camera, meshes);
    if (shape.empty()) {
        return makeComment(solid.name + ": not drawn, its back is to the camera");
    }
    std::string text = makeComment(solid.name);
    const bool begins = solid.from > 0.0;
    const bool ends = solid.until < 1e29;
    if (begins && ends) {
        text += fmt::format("  #if (RunTime >= {} & RunTime < {})\n", povNumber(solid.from),
                            povNumber(solid.until));
    } else if (begins) {
        text += fmt::format("  #if (RunTime >= {})\n", povNumber(solid.from));
    } else if (ends) {
        text += fmt::format("  #if (RunTime < {})\n", povNumber(solid.until));
    }
    text += fmt::format("  {} {}}}\n", shape, material);
    return begins || ends ? text + "  #end\n" : text;
}

}  // namespace

std::string povNumber(double number)
{
    SAND_CHECK(std::isfinite(number), "{} cannot be drawn", number);
    std::string text;
    appendNumber(text, number == 0.0 ? 0.0 : number);  // no "-0"
    return text;
}

std::string povVector(const Vec3& vector)
{
    return fmt::format("<{},{},{}>", povNumber(vector.x()), povNumber(vector.z()),
                       povNumber(vector.y()));
}

std::string povMeshName(std::size_t solid)
{
    return fmt::format("Solid{}", solid);
}

std::string formatPovSolids(const Scene& scene, const Vec3& camera,
                            std::span<const SceneMesh> meshes)
{
    std::string text = "#macro RunSolids()\n";
    for (std::size_t index = 0; index < scene.solids.size(); ++index) {
        text += formatSolid(scene, index, camera, meshes);
    }
    return text + "#end\n";
}

}  // namespace sandflow
