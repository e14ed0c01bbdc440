#pragma once

#include "core/vec3.h"
#include "scene/normal_law.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// The scene as the solver sees it: plain data, SI units, every default written here and nowhere
/// else. The TOML reader fills it, the resolved writer prints it; nobody else knows the format.
namespace sandflow {

enum class Mode { surfaceFlow, dem };
enum class Precision { single, real64 };
enum class SlopeForm { angle, tangent };

/// [grains]
struct GrainSpec {
    double radius = 0.005;      ///< mean radius, m
    double sizeSpread = 0.08;   ///< radii are uniform in radius * (1 +- sizeSpread)
    double density = 2600.0;    ///< kg/m3
};

/// [contact] One law and one set of coefficients for grains and solids.
struct ContactSpec {
    NormalLaw law = NormalLaw::linear;
    double restitution = 0.3;             ///< normal, at grain-grain impact
    bool clipAttraction = true;           ///< never pull at separation (dry sand)
    double friction = 0.5;                ///< Coulomb coefficient mu
    double rollingFriction = 0.1;         ///< mu_r: torque cap mu_r R* Fn; 0 turns rolling off
    std::optional<double> reposeAngle;    ///< degrees; the reader has solved one of the two above
                                          ///< for it. A record, nothing else reads it
    double tangentialRatio = 2.0 / 7.0;   ///< kt / kn
    double tangentialDamping = 0.2;       ///< tangential dashpot over normal dashpot
    std::optional<double> stiffness;      ///< kn, N/m, linear law; absent = auto
    std::optional<double> youngModulus;   ///< Pa, Hertz and Bell-Yu-Mucha; absent = auto
    double poissonRatio = 0.25;           ///< Hertz: tangential stiffness
    double maxOverlap = 0.3;              ///< in r: what auto stiffness allows and a run refuses
};

/// [time]
struct TimeSpec {
    double framesPerSecond = 30.0;
    double settle = 1.0;               ///< s simulated after the last grain was emitted
    std::optional<double> duration;    ///< s; replaces "settle after the last grain"
    std::optional<double> step;        ///< s; absent = auto
    double stepSafety = 0.8;           ///< auto step as a fraction of the stability bound
};

/// [surface_flow] Steps 1 and 2 of the method. Lengths in mean grain diameters d where marked.
struct SurfaceFlowSpec {
    double interval = 0.02;              ///< s between evaluations of steps 1 and 2
    double cellSize = 3.0;               ///< d, edge of a column
    double exchangeRate = 100.0;         ///< gamma, 1/(s rad)
    std::optional<double> reposeAngle = 36.0;  ///< degrees; absent = auto, that of the material
    std::optional<double> reposeMargin;  ///< degrees, theta0 = reposeAngle + it; absent = auto:
                                         ///< see repose_angle.h
    SlopeForm slopeForm = SlopeForm::angle;
    std::optional<double> saturationDepth;  ///< xi, d; absent: the exchange grows with all of R
    double minFlowDepth = 1.5;           ///< R_min, d
    double interfaceThickness = 2.2;     ///< d
    double smoothing = 0.3;              ///< share of the neighbours in H
    double maxChange = 0.3;              ///< d, largest |dh| in one interval
    bool transport = false;              ///< v_d dR/dx of eq. 2; off: the grains carry R
    double transportSpeed = 0.3;         ///< v_d, m/s, only with transport
    double freezeSpeed = 0.03;           ///< m/s, mean over freezeTime
    double freezeTime = 0.06;            ///< s at rest before a supported grain may freeze
    bool freezeOnSmooth = false;         ///< also where the base of a heap may slip
    double cagedTime = 0.32;             ///< s at rest after which any caged grain may freeze
    double buryClearance = 1.3;          ///< d kept between mobile and buried grains
    double creepDecay = 0.6;             ///< d, over which the bed's creep falls by e; 0: rigid bed
    double creepDepth = 2.0;             ///< d below the top of the bed where its creep ends
    double settleDepth = 40.0;           ///< d, of the sand set free when the flow has ended; 0: none
};

/// [skip] Work left out; every switch can be turned off (--no-skip turns all off).
struct SkipSpec {
    bool sleep = true;   ///< still mobile grains are not computed until disturbed
};

enum class UpAxis { y, z };

enum class SolidShape { plane, box, cylinder, disc, mesh };

/// [[solids]] Rigid and fixed. Which fields count depends on shape; the reader refuses the rest.
struct SolidSpec {
    SolidShape shape = SolidShape::plane;
    std::string name;                        ///< for messages and the picture
    double from = 0.0;                       ///< s, exists from
    double until = 1e30;                     ///< s, exists until
    bool rough = false;                      ///< planes: covered with fixed grains (default true for
                                             ///< planes, set by the reader)
    Vec3 point = Vec3::Zero();               ///< plane: a point on it; disc, cylinder,
                                             ///< mesh: centre of base
    Vec3 normal = Vec3::UnitZ();             ///< plane, disc: unit normal; cylinder: unit axis
    Vec3 min = Vec3::Zero();                 ///< box
    Vec3 max = Vec3::Zero();                 ///< box
    bool hollow = false;                     ///< box, cylinder: a container open at the top (thin
                                             ///< side walls; floor = true adds the bottom)
    bool floor = false;                      ///< hollow box, cylinder: closed below
    double radius = 0.0;                     ///< disc, cylinder
    double height = 0.0;                     ///< cylinder, along its axis
    std::string mesh;                        ///< file, relative to the scene file
    std::string standIn;                     ///< mesh: file used where the other cannot be found
    UpAxis up = UpAxis::z;                   ///< mesh: which axis of the file points up
    double scale = 1.0;                      ///< mesh: metres per unit of the file
    std::optional<double> fitHeight;         ///< mesh: m, vertical extent; replaces scale
    std::optional<double> fitLength;         ///< mesh: m, longer horizontal extent; replaces scale
    double turn = 0.0;                       ///< mesh: degrees about z, counter-clockwise from above
    bool stand = true;                       ///< mesh: the middle of its box's bottom comes to point
    std::string look = "floor";              ///< POV-Ray material, one of words::kLooks
};

enum class EmitterKind { jet, slot, block, fill, pile, single };

/// [[emitters]] Which fields count depends on kind; the reader refuses the rest.
struct EmitterSpec {
    EmitterKind kind = EmitterKind::jet;
    std::string name;
    double start = 0.0;                  ///< s
    std::int64_t count = 0;              ///< grains in all (jet, slot, block, fill, pile)
    double rate = 0.0;                   ///< grains/s (jet, slot)
    Vec3 position = Vec3::Zero();        ///< jet, slot: centre; single: centre; pile: centre of base
    Vec3 direction = -Vec3::UnitZ();     ///< jet, slot: unit
    double speed = 0.0;                  ///< m/s along direction (jet, slot)
    double radius = 0.0;                 ///< jet: of the disc, m
    Vec2 size = Vec2::Zero();            ///< slot: width (horizontal), height, m
    Vec3 min = Vec3::Zero();             ///< block, fill: box
    Vec3 max = Vec3::Zero();             ///< block, fill: box
    Vec3 velocity = Vec3::Zero();        ///< block, single, m/s
    Vec3 spin = Vec3::Zero();            ///< single, rad/s
    double slopeAngle = 25.0;            ///< pile, degrees
    std::optional<double> grainRadius;   ///< single: m; absent = the scene's mean
};

/// [camera] For the generated POV-Ray scene. Absent parts are framed from the scene.
struct CameraSpec {
    std::optional<Vec3> position;
    std::optional<Vec3> lookAt;
    double angle = 32.0;                 ///< degrees, horizontal
};

/// A grain outside is EXITED. Infinite by default.
struct DomainSpec {
    Vec3 min = Vec3::Constant(-1e30);
    Vec3 max = Vec3::Constant(1e30);
};

struct Scene {
    std::string name;
    std::string sourcePath;              ///< where it was read, "" if made in code
    Mode mode = Mode::surfaceFlow;
    Precision precision = Precision::single;
    std::uint64_t seed = 1;
    Vec3 gravity = Vec3(0.0, 0.0, -kGravity);
    DomainSpec domain;
    GrainSpec grains;
    ContactSpec contact;
    TimeSpec time;
    SurfaceFlowSpec surfaceFlow;
    SkipSpec skip;
    std::vector<SolidSpec> solids;
    std::vector<EmitterSpec> emitters;
    CameraSpec camera;

    double diameter() const { return 2.0 * grains.radius; }
};

}  // namespace sandflow
