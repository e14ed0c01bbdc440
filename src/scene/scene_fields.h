#pragma once

#include "scene/scene_choices.h"

#include <concepts>
#include <type_traits>

/// The scene file's keys, once: which key belongs to which field, its unit, what it may be and what
/// it means. Reader, writer, key checks and the reference in scenes/README.md all walk these
/// functions, so that they cannot disagree. A visitor is called as visit(Key, field, rule).
/// Solids and emitters are in shape_fields.h.
namespace sandflow {

/// `const Spec` to look, `Spec` to fill.
template <class T, class Spec>
concept SpecOf = std::same_as<std::remove_const_t<T>, Spec>;

template <SpecOf<Scene> T, class Visitor>
void visitFields(T& scene, Visitor& visit)
{
    visit(Key{"name", "", "Name of the scene; the file's name if the key is absent."}, scene.name,
          Text{});
    visit(Key{"mode", "",
              "Method: the inside of a pile as a height field, or plain DEM of every grain."},
          scene.mode, Choices<Mode>(words::kModes));
    visit(Key{"precision", "", "Floating-point type of the grains' forces and motion."},
          scene.precision, Choices<Precision>(words::kPrecisions));
    visit(Key{"seed", "",
              "Start of all random numbers: another seed, another pour of the same kind."},
          scene.seed, limits::kSeed);
    visit(Key{"gravity", "m/s2", "Acceleration of gravity; z points up."}, scene.gravity,
          limits::kGravity);
}

template <SpecOf<DomainSpec> T, class Visitor>
void visitFields(T& domain, Visitor& visit)
{
    visit(Key{"min", "m", "Lower corner; a component of -1e30 leaves that side open."}, domain.min,
          OpenRange{limits::kDomainCoordinate, -limits::kOpenEnd});
    visit(Key{"max", "m", "Upper corner; a component of 1e30 leaves that side open."}, domain.max,
          OpenRange{limits::kDomainCoordinate, limits::kOpenEnd});
}

template <SpecOf<GrainSpec> T, class Visitor>
void visitFields(T& grains, Visitor& visit)
{
    visit(Key{"radius", "m", "Mean radius of a grain."}, grains.radius, limits::kGrainRadius);
    visit(Key{"size_spread", "",
              "Radii are uniform in radius x (1 - size_spread ... 1 + size_spread)."},
          grains.sizeSpread, limits::kSizeSpread);
    visit(Key{"density", "kg/m3", "Density of the grains' material (not of the heap)."},
          grains.density, limits::kDensity);
}

template <SpecOf<ContactSpec> T, class Visitor>
void visitFields(T& contact, Visitor& visit)
{
    visit(Key{"law", "", "Normal force over overlap."}, contact.law,
          Choices<NormalLaw>(words::kLaws));
    visit(Key{"restitution", "", "Normal speed after a collision of two grains over that before."},
          contact.restitution, limits::kRestitution);
    visit(Key{"clip_attraction", "", "Never pull while two grains part, as dry sand."},
          contact.clipAttraction, Flag{});
    visit(Key{"friction", "",
              "Coulomb's coefficient of sliding friction; auto: solved for repose_angle."},
          contact.friction, SolvedRange{limits::kFriction});
    visit(Key{"rolling_friction", "",
              "Largest rolling torque over (effective radius x normal force), 0 turns it off; "
              "auto: solved for repose_angle."},
          contact.rollingFriction, SolvedRange{limits::kFriction});
    visit(Key{"repose_angle", "degrees",
              "Slope at which a poured heap shall stand; rolling_friction is solved for it, or "
              "friction if that is auto or only rolling_friction is given."},
          contact.reposeAngle, TargetRange{limits::kSlope});
    visit(Key{"tangential_ratio", "", "Tangential over normal stiffness."}, contact.tangentialRatio,
          limits::kTangentialRatio);
    visit(Key{"tangential_damping", "", "Tangential over normal damping."},
          contact.tangentialDamping, limits::kTangentialDamping);
    visit(Key{"stiffness", "N/m",
              "Normal stiffness of the linear law; auto: the softest that keeps max_overlap."},
          contact.stiffness, AutoRange{limits::kStiffness});
    visit(Key{"young_modulus", "Pa",
              "Young's modulus of the other laws; auto: the softest that keeps max_overlap."},
          contact.youngModulus, AutoRange{limits::kYoungModulus});
    visit(Key{"poisson_ratio", "", "Poisson's ratio of the grains' material."},
          contact.poissonRatio, limits::kPoissonRatio);
    visit(Key{"max_overlap", "grain radii",
              "Overlap that auto stiffness allows and beyond which a run is refused."},
          contact.maxOverlap, limits::kMaxOverlap);
}

template <SpecOf<TimeSpec> T, class Visitor>
void visitFields(T& time, Visitor& visit)
{
    visit(Key{"frames_per_second", "1/s", "Frames written per simulated second."},
          time.framesPerSecond, limits::kFrameRate);
    visit(Key{"settle", "s", "Simulated after the last grain has entered."}, time.settle,
          limits::kTime);
    visit(Key{"duration", "s", "Simulated in all; when given, settle does not count."},
          time.duration, OptionalRange{limits::kDuration});
    visit(Key{"step", "s", "Time step; auto: step_safety x the stability bound."}, time.step,
          AutoRange{limits::kStep});
    visit(Key{"step_safety", "", "The auto step as a fraction of the stability bound."},
          time.stepSafety, limits::kStepSafety);
}

template <SpecOf<SurfaceFlowSpec> T, class Visitor>
void visitFields(T& flow, Visitor& visit)
{
    visit(Key{"interval", "s", "Simulated time between two updates of the height field."},
          flow.interval, limits::kInterval);
    visit(Key{"cell_size", "grain diameters", "Edge of a column of the height field."},
          flow.cellSize, limits::kCellSize);
    visit(Key{"exchange_rate", "1/(s rad)",
              "How fast flowing sand erodes or settles for each radian off the angle of repose."},
          flow.exchangeRate, limits::kExchangeRate);
    visit(Key{"repose_angle", "degrees",
              "With repose_margin, the slope at which the flow neither erodes nor settles; auto: "
              "where heaps of this friction and rolling friction stand."},
          flow.reposeAngle, AutoRange{limits::kSlope});
    visit(Key{"repose_margin", "degrees",
              "Added to repose_angle; auto: 0 to a number, 8 where that is auto."},
          flow.reposeMargin, AutoRange{limits::kReposeMargin});
    visit(Key{"slope_form", "", "Exchange in proportion to the slope's angle or to its tangent."},
          flow.slopeForm, Choices<SlopeForm>(words::kSlopeForms));
    visit(Key{"saturation_depth", "grain diameters",
              "Of a deeper flow, only about so much erodes or settles; when absent, all of it "
              "does."},
          flow.saturationDepth, OptionalRange{limits::kSaturationDepth});
    visit(Key{"min_flow_depth", "grain diameters", "Sand that is always kept moving on top."},
          flow.minFlowDepth, limits::kDepth);
    visit(Key{"interface_thickness", "grain diameters",
              "Layer of fixed grains between moving and buried sand."},
          flow.interfaceThickness, limits::kInterfaceThickness);
    visit(Key{"smoothing", "", "Share of the neighbours in a column's surface height."},
          flow.smoothing, limits::kShare);
    visit(Key{"max_change", "grain diameters",
              "Largest rise or fall of the still sand in one update."},
          flow.maxChange, limits::kMaxChange);
    visit(Key{"transport", "",
              "Move the flowing layer along the height field too, which the moving grains do "
              "already."},
          flow.transport, Flag{});
    visit(Key{"transport_speed", "m/s", "Speed of that, only with transport = true."},
          flow.transportSpeed, limits::kTransportSpeed);
    visit(Key{"freeze_speed", "m/s", "A grain that is slower over freeze_time counts as at rest."},
          flow.freezeSpeed, limits::kFreezeSpeed);
    visit(Key{"freeze_time", "s", "At rest for so long, a supported grain may be fixed."},
          flow.freezeTime, limits::kFreezeTime);
    visit(Key{"caged_time", "s", "At rest for so long, a grain caged by others may be fixed."},
          flow.cagedTime, limits::kFreezeTime);
    visit(Key{"freeze_on_smooth", "",
              "Fix grains of a slope over a smooth floor too, where the base slips."},
          flow.freezeOnSmooth, Flag{});
    visit(Key{"bury_clearance", "grain diameters",
              "Kept between the lowest moving grain and the buried ones."},
          flow.buryClearance, limits::kDepth);
    visit(Key{"creep_decay", "grain diameters",
              "The bed under flowing sand creeps along with it, slower by a factor of e over this "
              "depth; 0: it stays where it is."},
          flow.creepDecay, limits::kDepth);
    visit(Key{"creep_depth", "grain diameters", "Below the top of the bed: there creep ends."},
          flow.creepDepth, limits::kDepth);
    visit(Key{"settle_depth", "grain diameters",
              "Down to it sand of a bed that crept is set free once its flow has ended; 0: none."},
          flow.settleDepth, limits::kDepth);
}

template <SpecOf<SkipSpec> T, class Visitor>
void visitFields(T& skip, Visitor& visit)
{
    visit(Key{"sleep", "", "Do not compute grains that lie still until something disturbs them."},
          skip.sleep, Flag{});
}

template <SpecOf<CameraSpec> T, class Visitor>
void visitFields(T& camera, Visitor& visit)
{
    visit(Key{"position", "m", "Where the eye is; absent: framed from the scene."}, camera.position,
          OptionalRange{limits::kCoordinate});
    visit(Key{"look_at", "m", "What it looks at; absent: framed from the scene."}, camera.lookAt,
          OptionalRange{limits::kCoordinate});
    visit(Key{"angle", "degrees", "Horizontal angle of view."}, camera.angle, limits::kViewAngle);
}

/// The tables of the file, in the order in which they are written:
/// visit(name, meaning, table) for each.
template <SpecOf<Scene> T, class Visitor>
void visitTables(T& scene, Visitor&& visit)
{
    visit("domain", "The part of space that counts; a grain outside has left the scene for good.",
          scene.domain);
    visit("grains", "What the sand is made of.", scene.grains);
    visit("contact", "What happens where two grains, or a grain and a solid, touch.",
          scene.contact);
    visit("time", "How long, how often, how finely.", scene.time);
    visit("surface_flow", "The height field of mode \"surface-flow\"; mode \"dem\" ignores it.",
          scene.surfaceFlow);
    visit("skip", "Work that may be left out.", scene.skip);
    visit("camera", "The eye of the generated picture.", scene.camera);
}

}  // namespace sandflow
