#include "emit_support.h"

namespace sandflow {
namespace {

using testing::contains;
using testing::emitAll;
using testing::flyTo;
using testing::makeScene;
using testing::refusalOf;
using testing::smallestGap;

EmitterSpec makeBlock(std::int64_t count)
{
    EmitterSpec block;
    block.kind = EmitterKind::block;
    block.name = "dam";
    block.count = count;
    block.min = Vec3(-0.1, 0.0, 0.2);
    block.max = Vec3(0.1, 0.15, 0.5);
    block.velocity = Vec3(1.0, -2.0, 0.5);
    block.start = 0.25;
    return block;
}

std::int64_t mostNamed(const Scene& scene)
{
    const std::string refusal = refusalOf(scene);
    const std::size_t at = refusal.find("at most ");
    return at == std::string::npos ? 0 : std::stoll(refusal.substr(at + 8));
}

TEST(Block, FillsItsBoxEvenlyWithoutOverlap)
{
    const std::int64_t most = mostNamed(makeScene(makeBlock(1000000)));
    ASSERT_GT(most, 5000);
    for (const std::int64_t count : {std::int64_t{1}, std::int64_t{7}, std::int64_t{1000}, most}) {
        const EmitterSpec spec = makeBlock(count);
        const auto block = makeEmitter(makeScene(spec), 0);
        EXPECT_EQ(block->nextTime(), 0.25);
        EXPECT_EQ(block->planned(), count);
        EXPECT_EQ(block->emitted(), 0);
        const std::vector<NewGrain> grains = emitAll(*block);
        ASSERT_EQ(grains.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(block->emitted(), count);
        Vec3 mean = Vec3::Zero();
        for (const NewGrain& grain : grains) {
            EXPECT_GE((grain.position - spec.min).minCoeff(), grain.radius - 1e-12);
            EXPECT_GE((spec.max - grain.position).minCoeff(), grain.radius - 1e-12);
            EXPECT_EQ(grain.velocity, spec.velocity);
            EXPECT_FALSE(grain.settled);
            mean += grain.position / static_cast<double>(count);
        }
        EXPECT_GE(smallestGap(grains, 0.001), -1e-15);
        if (count >= 1000) {
            EXPECT_LT((mean - 0.5 * (spec.min + spec.max)).norm(), 0.01);
        }
    }
}

TEST(Block, DenseBlockHoldsNearlyClosePacking)
{
    EmitterSpec spec = makeBlock(1000000);
    spec.min = Vec3::Zero();
    spec.max = Vec3::Constant(0.5);
    Scene scene = makeScene(spec);
    scene.grains.sizeSpread = 0.0;
    const double volume = 4.0 / 3.0 * kPi * std::pow(0.005, 3);
    EXPECT_GT(static_cast<double>(mostNamed(scene)) * volume / 0.125, 0.68);  // 0.74 less the rim
}

TEST(Block, BoxMadeForOneGrainHoldsOne)
{
    EmitterSpec spec = makeBlock(1);
    spec.max = spec.min + Vec3::Constant(0.0108);
    EXPECT_EQ(refusalOf(makeScene(spec)), "");
    spec.count = 2;
    EXPECT_EQ(mostNamed(makeScene(spec)), 1);
    spec.max.y() -= 1e-6;
    EXPECT_TRUE(contains(refusalOf(makeScene(spec)),
                         "emitters[0] (\"dam\"): the box is 0.0108 m "
                         "along y"));
}

TEST(Block, LateBlockHasFlownOn)
{
    const Scene scene = makeScene(makeBlock(500));
    std::vector<NewGrain> prompt;
    std::vector<NewGrain> late;
    makeEmitter(scene, 0)->emit(0.25, prompt);
    makeEmitter(scene, 0)->emit(0.26, late);
    ASSERT_EQ(prompt.size(), late.size());
    for (std::size_t k = 0; k < prompt.size(); ++k) {
        flyTo(scene.gravity, 0.26 - 0.25, prompt[k]);
        EXPECT_LT((prompt[k].position - late[k].position).norm(), 1e-14);
        EXPECT_LT((prompt[k].velocity - late[k].velocity).norm(), 1e-14);
    }
}

TEST(Single, IsPlacedAsWritten)
{
    EmitterSpec spec;
    spec.kind = EmitterKind::single;
    spec.position = Vec3(1.0, 2.0, 3.0);
    spec.velocity = Vec3(0.0, 0.0, -4.0);
    spec.spin = Vec3(5.0, 6.0, 7.0);
    spec.start = 0.5;
    std::vector<NewGrain> grains;
    const auto mean = makeEmitter(makeScene(spec), 0);
    mean->emit(0.5, grains);
    spec.grainRadius = 0.02;
    makeEmitter(makeScene(spec), 0)->emit(0.5, grains);
    ASSERT_EQ(grains.size(), 2U);
    EXPECT_EQ(grains[0].radius, 0.005);
    EXPECT_EQ(grains[1].radius, 0.02);
    EXPECT_EQ(grains[1].position, spec.position);
    EXPECT_EQ(grains[1].velocity, spec.velocity);
    EXPECT_EQ(grains[1].spin, spec.spin);
    EXPECT_EQ(mean->nextTime(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(mean->planned(), 1);
    spec.grainRadius = 0.0;
    EXPECT_TRUE(contains(refusalOf(makeScene(spec)), "radius must be positive"));
}

}  // namespace
}  // namespace sandflow
