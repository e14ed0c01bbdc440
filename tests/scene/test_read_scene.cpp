#include "scene_support.h"

#include <locale>

namespace sandflow {
namespace {

TEST(ReadScene, AbsentKeysKeepTheDefaultsOfTheModel)
{
    const Scene scene = parseScene(kOneGrain, "dir/one_grain.toml");
    EXPECT_EQ(scene.name, "one_grain");
    EXPECT_EQ(scene.sourcePath, "dir/one_grain.toml");
    EXPECT_EQ(scene.mode, Mode::surfaceFlow);
    EXPECT_EQ(scene.precision, Precision::single);
    EXPECT_EQ(scene.seed, 1U);
    EXPECT_EQ(scene.gravity, Vec3(0.0, 0.0, -9.81));
    EXPECT_EQ(scene.domain.min, Vec3::Constant(-1e30));
    EXPECT_EQ(scene.domain.max, Vec3::Constant(1e30));
    EXPECT_EQ(scene.grains.radius, 0.005);
    EXPECT_EQ(scene.contact.law, NormalLaw::linear);
    EXPECT_EQ(scene.contact.tangentialRatio, 2.0 / 7.0);
    EXPECT_FALSE(scene.contact.stiffness.has_value());
    EXPECT_FALSE(scene.time.duration.has_value());
    EXPECT_FALSE(scene.time.step.has_value());
    EXPECT_EQ(scene.surfaceFlow.reposeAngle, 36.0);
    EXPECT_FALSE(scene.surfaceFlow.reposeMargin.has_value());
    EXPECT_FALSE(scene.contact.reposeAngle.has_value());
    EXPECT_TRUE(scene.skip.sleep);
    EXPECT_TRUE(scene.solids.empty());
    EXPECT_FALSE(scene.camera.position.has_value());
    ASSERT_EQ(scene.emitters.size(), 1U);
    EXPECT_FALSE(scene.emitters[0].grainRadius.has_value());
    EXPECT_EQ(scene.emitters[0].name, "grain");
}

TEST(ReadScene, ReadsEveryKeyOfEveryTable)
{
    const Scene scene = parseScene(R"(
name = "all"
mode = "dem"
precision = "double"
seed = 9223372036854775807
gravity = [1, 2.5, -3]
[domain]
min = [-1, -2, -3]
max = [4, 5, 1e30]
[grains]
radius = 0.004
size_spread = 0.5
density = 2500
[contact]
law = "bell-yu-mucha"
restitution = 0.4
clip_attraction = false
friction = 0.6
rolling_friction = 0.2
tangential_ratio = 0.8
tangential_damping = 0.1
stiffness = "auto"
young_modulus = 1e7
poisson_ratio = 0.3
max_overlap = 0.25
[time]
frames_per_second = 25
settle = 2
duration = 7
step = 1e-5
step_safety = 0.5
[surface_flow]
interval = 0.03
cell_size = 4
exchange_rate = 50
repose_angle = 30
repose_margin = 5.5
slope_form = "tangent"
saturation_depth = 2.5
min_flow_depth = 3
interface_thickness = 2.5
smoothing = 0.1
max_change = 0.2
transport = true
transport_speed = 0.4
freeze_speed = 0.003
freeze_time = 0.09
caged_time = 0.4
bury_clearance = 1.7
creep_decay = 1.5
creep_depth = 2.5
settle_depth = 7
freeze_on_smooth = true
[skip]
sleep = false
[camera]
position = [1, 1, 1]
look_at = [0, 0, 0.1]
angle = 40
)" + kOneGrain,
                                   "s.toml");
    EXPECT_EQ(scene.name, "all");
    EXPECT_EQ(scene.mode, Mode::dem);
    EXPECT_EQ(scene.precision, Precision::real64);
    EXPECT_EQ(scene.seed, 9223372036854775807U);
    EXPECT_EQ(scene.gravity, Vec3(1.0, 2.5, -3.0));
    EXPECT_EQ(scene.domain.min, Vec3(-1, -2, -3));
    EXPECT_EQ(scene.domain.max, Vec3(4, 5, 1e30));
    EXPECT_EQ(scene.grains.radius, 0.004);
    EXPECT_EQ(scene.grains.sizeSpread, 0.5);
    EXPECT_EQ(scene.grains.density, 2500.0);
    EXPECT_EQ(scene.contact.law, NormalLaw::bellYuMucha);
    EXPECT_EQ(scene.contact.restitution, 0.4);
    EXPECT_FALSE(scene.contact.clipAttraction);
    EXPECT_EQ(scene.contact.friction, 0.6);
    EXPECT_EQ(scene.contact.rollingFriction, 0.2);
    EXPECT_EQ(scene.contact.tangentialRatio, 0.8);
    EXPECT_EQ(scene.contact.tangentialDamping, 0.1);
    EXPECT_FALSE(scene.contact.stiffness.has_value());
    EXPECT_EQ(scene.contact.youngModulus, 1e7);
    EXPECT_EQ(scene.contact.poissonRatio, 0.3);
    EXPECT_EQ(scene.contact.maxOverlap, 0.25);
    EXPECT_EQ(scene.time.framesPerSecond, 25.0);
    EXPECT_EQ(scene.time.settle, 2.0);
    EXPECT_EQ(scene.time.duration, 7.0);
    EXPECT_EQ(scene.time.step, 1e-5);
    EXPECT_EQ(scene.time.stepSafety, 0.5);
    EXPECT_EQ(scene.surfaceFlow.interval, 0.03);
    EXPECT_EQ(scene.surfaceFlow.cellSize, 4.0);
    EXPECT_EQ(scene.surfaceFlow.exchangeRate, 50.0);
    EXPECT_EQ(scene.surfaceFlow.reposeAngle, 30.0);
    EXPECT_EQ(scene.surfaceFlow.reposeMargin, 5.5);
    EXPECT_EQ(scene.surfaceFlow.slopeForm, SlopeForm::tangent);
    EXPECT_EQ(scene.surfaceFlow.saturationDepth, 2.5);
    EXPECT_EQ(scene.surfaceFlow.minFlowDepth, 3.0);
    EXPECT_EQ(scene.surfaceFlow.interfaceThickness, 2.5);
    EXPECT_EQ(scene.surfaceFlow.smoothing, 0.1);
    EXPECT_EQ(scene.surfaceFlow.maxChange, 0.2);
    EXPECT_TRUE(scene.surfaceFlow.transport);
    EXPECT_EQ(scene.surfaceFlow.transportSpeed, 0.4);
    EXPECT_EQ(scene.surfaceFlow.freezeSpeed, 0.003);
    EXPECT_EQ(scene.surfaceFlow.freezeTime, 0.09);
    EXPECT_EQ(scene.surfaceFlow.cagedTime, 0.4);
    EXPECT_EQ(scene.surfaceFlow.buryClearance, 1.7);
    EXPECT_EQ(scene.surfaceFlow.creepDecay, 1.5);
    EXPECT_EQ(scene.surfaceFlow.creepDepth, 2.5);
    EXPECT_EQ(scene.surfaceFlow.settleDepth, 7.0);
    EXPECT_TRUE(scene.surfaceFlow.freezeOnSmooth);
    EXPECT_FALSE(scene.skip.sleep);
    EXPECT_EQ(scene.camera.position, Vec3(1, 1, 1));
    EXPECT_EQ(scene.camera.lookAt, Vec3(0, 0, 0.1));
    EXPECT_EQ(scene.camera.angle, 40.0);
}

TEST(ReadScene, ReadsEveryShape)
{
    const Scene scene = parseScene(R"(
[[solids]]
shape = "plane"
[[solids]]
shape = "plane"
rough = false
point = [1, 2, 3]
normal = [0, 3, 4]
look = "glass"
[[solids]]
shape = "box"
name = "tub"
min = [-1, -1, 0]
max = [1, 1, 2]
hollow = true
floor = true
[[solids]]
shape = "cylinder"
from = 0.5
until = 2.5
point = [0, 0, 1]
axis = [0, 0, -2]
radius = 0.3
height = 0.7
hollow = true
[[solids]]
shape = "disc"
point = [0, 1, 0]
normal = [1, 0, 0]
radius = 0.2
[[solids]]
shape = "mesh"
mesh = "../meshes/bowl.obj"
look = "ceramic"
)" + kOneGrain,
                                   "s.toml");
    ASSERT_EQ(scene.solids.size(), 6U);
    EXPECT_EQ(scene.solids[0].shape, SolidShape::plane);
    EXPECT_TRUE(scene.solids[0].rough);
    EXPECT_EQ(scene.solids[0].until, 1e30);
    EXPECT_EQ(scene.solids[0].look, "floor");
    EXPECT_FALSE(scene.solids[1].rough);
    EXPECT_EQ(scene.solids[1].point, Vec3(1, 2, 3));
    EXPECT_TRUE(scene.solids[1].normal.isApprox(Vec3(0, 0.6, 0.8), 1e-15));
    EXPECT_EQ(scene.solids[1].look, "glass");
    EXPECT_EQ(scene.solids[2].shape, SolidShape::box);
    EXPECT_EQ(scene.solids[2].name, "tub");
    EXPECT_EQ(scene.solids[2].min, Vec3(-1, -1, 0));
    EXPECT_EQ(scene.solids[2].max, Vec3(1, 1, 2));
    EXPECT_TRUE(scene.solids[2].hollow);
    EXPECT_TRUE(scene.solids[2].floor);
    EXPECT_FALSE(scene.solids[2].rough);
    EXPECT_EQ(scene.solids[3].shape, SolidShape::cylinder);
    EXPECT_EQ(scene.solids[3].from, 0.5);
    EXPECT_EQ(scene.solids[3].until, 2.5);
    EXPECT_EQ(scene.solids[3].normal, Vec3(0, 0, -1));
    EXPECT_EQ(scene.solids[3].radius, 0.3);
    EXPECT_EQ(scene.solids[3].height, 0.7);
    EXPECT_FALSE(scene.solids[3].floor);
    EXPECT_EQ(scene.solids[4].shape, SolidShape::disc);
    EXPECT_EQ(scene.solids[4].normal, Vec3(1, 0, 0));
    EXPECT_EQ(scene.solids[5].shape, SolidShape::mesh);
    EXPECT_EQ(scene.solids[5].mesh, "../meshes/bowl.obj");
    EXPECT_EQ(scene.solids[5].look, "ceramic");
}

TEST(ReadScene, ReadsEveryKindOfEmitter)
{
    const Scene scene = parseScene(kJet + R"(start = 0.5
[[emitters]]
kind = "slot"
count = 64325
rate = 53604.2
position = [-1, 0, 0.09]
direction = [2, 0, 0]
speed = 2.5
size = [1, 0.08]
[[emitters]]
kind = "block"
count = 7
min = [0, 0, 0]
max = [1, 1, 1]
velocity = [0, 0, -2]
[[emitters]]
kind = "fill"
min = [0, 0, 0]
max = [1, 1, 1]
[[emitters]]
kind = "pile"
count = 1000
slope_angle = 20
[[emitters]]
kind = "single"
position = [0, 0, 2]
velocity = [1, 0, 0]
spin = [0, 50, 0]
radius = 0.006
)",
                                   "s.toml");
    ASSERT_EQ(scene.emitters.size(), 6U);
    const auto& emitters = scene.emitters;
    EXPECT_EQ(emitters[0].kind, EmitterKind::jet);
    EXPECT_EQ(emitters[0].start, 0.5);
    EXPECT_EQ(emitters[0].count, 100);
    EXPECT_EQ(emitters[0].rate, 50.0);
    EXPECT_EQ(emitters[0].direction, Vec3(0, 0, -1));
    EXPECT_EQ(emitters[0].radius, 0.05);
    EXPECT_EQ(emitters[1].kind, EmitterKind::slot);
    EXPECT_EQ(emitters[1].direction, Vec3(1, 0, 0));
    EXPECT_EQ(emitters[1].size, Vec2(1, 0.08));
    EXPECT_EQ(emitters[2].kind, EmitterKind::block);
    EXPECT_EQ(emitters[2].max, Vec3(1, 1, 1));
    EXPECT_EQ(emitters[2].velocity, Vec3(0, 0, -2));
    EXPECT_EQ(emitters[3].kind, EmitterKind::fill);
    EXPECT_EQ(emitters[3].count, 0);
    EXPECT_EQ(emitters[4].kind, EmitterKind::pile);
    EXPECT_EQ(emitters[4].slopeAngle, 20.0);
    EXPECT_EQ(emitters[5].kind, EmitterKind::single);
    EXPECT_EQ(emitters[5].spin, Vec3(0, 50, 0));
    EXPECT_EQ(emitters[5].grainRadius, 0.006);
    EXPECT_EQ(emitters[5].radius, 0.0) << "radius of a single grain is not that of a jet";
}

TEST(ReadScene, NormalisesDirectionsOfAnyLength)
{
    const auto direction = [](const std::string& vector) {
        return parseScene(kJet + "direction = " + vector + "\n", "s.toml").emitters[0].direction;
    };
    const double half = std::sqrt(0.5);
    EXPECT_TRUE(direction("[1e308, 0, -1e308]").isApprox(Vec3(half, 0, -half), 1e-15));
    EXPECT_TRUE(direction("[5e-324, 5e-324, 0]").isApprox(Vec3(half, half, 0), 1e-15));
    EXPECT_EQ(direction("[0, 0, 1e-200]"), Vec3(0, 0, 1));
}

struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(ReadScene, TheLocaleMakesNoDifference)
{
    const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
    Scene scene;
    std::string refusal;
    EXPECT_NO_THROW(scene = parseScene("seed = 12345\ngrains.radius = 0.0045\n" + kJet, "s.toml",
                                       {"contact.friction=0.25"}));
    refusal = refusalOf("grains.density = 0.5\n" + kJet);
    std::locale::global(before);
    EXPECT_EQ(scene.seed, 12345U);
    EXPECT_EQ(scene.grains.radius, 0.0045);
    EXPECT_EQ(scene.contact.friction, 0.25);
    EXPECT_EQ(scene.emitters[0].radius, 0.05);
    EXPECT_EQ(refusal,
              "s.toml:1:18: grains.density: is 0.5, expected a number from 1 to 50000 "
              "kg/m3");
}

}  // namespace
}  // namespace sandflow
