#include "scene/scene_checks.h"

#include "scene/field_format.h"
#include "scene/repose_angle.h"
#include "scene/scene_choices.h"
#include "scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace sandflow {
namespace {

/// max > min in every component; `table` holds the two keys.
void checkBox(const std::string& table, const Vec3& min, const Vec3& max,
              const SceneComplaint& complain)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (!(max[axis] > min[axis])) {
            complain(
                {table + ".max", table + ".min"},
                fmt::format("the box ends at {1} = {2} where it begins at {1} = {0}, expected "
                            "max above min",
                            formatShortest(min[axis]), "xyz"[axis], formatShortest(max[axis])));
        }
    }
}

void checkGravity(const Scene& scene, const SceneComplaint& complain)
{
    // The height field is a function of x and y: sand must rest on what is below it in z.
    if (scene.mode == Mode::surfaceFlow && !(scene.gravity.z() < 0.0)) {
        complain({"gravity", "mode"},
                 "does not point down, expected a negative z in mode \"surface-flow\"");
    }
}

void checkContact(const ContactSpec& contact, const SceneComplaint& complain)
{
    const bool linear = contact.law == NormalLaw::linear;
    if (!linear && contact.stiffness) {
        complain({"contact.stiffness", "contact.law"},
                 "belongs to law = \"linear\", expected young_modulus with this law");
    }
    if (linear && contact.youngModulus) {
        complain({"contact.young_modulus", "contact.law"},
                 "does not belong to law = \"linear\", expected stiffness with this law");
    }
}

void checkNeutralSlope(const Scene& scene, const SceneComplaint& complain)
{
    const ReposeReport repose = reportRepose(scene);
    if (!limits::kSlope.contains(repose.neutralSlope())) {
        complain({"surface_flow.repose_margin", "surface_flow.repose_angle"},
                 fmt::format("makes the neutral slope {:.4g} + {:.4g} degrees, expected a sum "
                             "above 0 and below 90",
                             repose.angle, repose.margin));
    }
}

void checkSolid(const std::string& table, const SolidSpec& solid, const SceneComplaint& complain)
{
    if (!(solid.until > solid.from)) {
        complain({table + ".until", table + ".from"},
                 fmt::format("it is gone at {} s but exists from {} s, expected until above from",
                             formatShortest(solid.until), formatShortest(solid.from)));
    }
    if (solid.rough && solid.shape != SolidShape::plane) {
        complain({table + ".rough", table + ".shape"}, "is true, but only planes can be rough");
    }
    if (solid.floor && !solid.hollow) {
        complain({table + ".floor", table + ".hollow"},
                 "is true, but only a hollow solid has a floor (hollow = true)");
    }
    if (solid.fitHeight && solid.fitLength) {
        complain({table + ".fit_length", table + ".fit_height"},
                 "is given beside fit_height, expected one of the two");
    }
    if ((solid.fitHeight || solid.fitLength) && solid.scale != 1.0) {
        complain({table + ".scale", table + ".fit_height", table + ".fit_length"},
                 "is given beside a size to fit, expected one of the two");
    }
    if (solid.shape == SolidShape::box) {
        checkBox(table, solid.min, solid.max, complain);
    }
}

void checkEmitter(const std::string& table, const EmitterSpec& emitter, const GrainSpec& grains,
                  const SceneComplaint& complain)
{
    if (emitter.kind == EmitterKind::block || emitter.kind == EmitterKind::fill) {
        checkBox(table, emitter.min, emitter.max, complain);
    }
    if (emitter.kind == EmitterKind::single && emitter.grainRadius) {
        const double low = grains.radius * (1.0 + grains.sizeSpread) / limits::kLargestSizeRatio;
        const double high = grains.radius * (1.0 - grains.sizeSpread) * limits::kLargestSizeRatio;
        if (*emitter.grainRadius < low || *emitter.grainRadius > high) {
            complain({table + ".radius", "grains.radius", "grains.size_spread"},
                     fmt::format("is {}, expected {:.4g} to {:.4g} m, as grain sizes may differ by "
                                 "a factor of 5",
                                 formatShortest(*emitter.grainRadius), low, high));
        }
    }
}

/// Single grains of different sizes also differ from each other.
void checkSingles(const Scene& scene, const SceneComplaint& complain)
{
    const EmitterSpec* smallest = nullptr;
    const EmitterSpec* largest = nullptr;
    for (const EmitterSpec& emitter : scene.emitters) {
        if (!emitter.grainRadius) {
            continue;
        }
        if (smallest == nullptr || *emitter.grainRadius < *smallest->grainRadius) {
            smallest = &emitter;
        }
        if (largest == nullptr || *emitter.grainRadius > *largest->grainRadius) {
            largest = &emitter;
        }
    }
    if (smallest != nullptr &&
        *largest->grainRadius > limits::kLargestSizeRatio * *smallest->grainRadius) {
        const auto name = [&](const EmitterSpec* emitter) {
            return fmt::format("emitters[{}].radius", emitter - scene.emitters.data());
        };
        complain({name(largest), name(smallest)},
                 fmt::format("is {} but {} is {}, expected grain sizes within a factor of 5",
                             formatShortest(*largest->grainRadius), name(smallest),
                             formatShortest(*smallest->grainRadius)));
    }
}

void checkTotal(const Scene& scene, const SceneComplaint& complain)
{
    std::int64_t total = 0;
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        const EmitterSpec& emitter = scene.emitters[i];
        total += emitter.kind == EmitterKind::single ? 1 : emitter.count;
        if (total > limits::kMostGrains) {
            complain({fmt::format("emitters[{}].count", i)},
                     fmt::format("brings the scene to {} grains, expected at most {}", total,
                                 limits::kMostGrains));
        }
    }
}

}  // namespace

void checkScene(const Scene& scene, const SceneComplaint& complain)
{
    checkGravity(scene, complain);
    checkBox("domain", scene.domain.min, scene.domain.max, complain);
    checkContact(scene.contact, complain);
    checkNeutralSlope(scene, complain);
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        checkSolid(fmt::format("solids[{}]", i), scene.solids[i], complain);
    }
    if (scene.emitters.empty()) {
        complain({"emitters"}, "there is none, expected at least one [[emitters]]");
    }
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        checkEmitter(fmt::format("emitters[{}]", i), scene.emitters[i], scene.grains, complain);
    }
    checkSingles(scene, complain);
    checkTotal(scene, complain);
    if (scene.camera.position && scene.camera.position == scene.camera.lookAt) {
        complain({"camera.look_at", "camera.position"},
                 "is the camera's own position, expected another point");
    }
}

}  // namespace sandflow
