#include "core/hash.h"
#include "dem/kernel_rig.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>

namespace sandflow {
namespace {

using rig::KernelRig;

/// A block of grains of different sizes, jostling, on a floor of frozen grains and over a plane: it
/// spans chunks and has every kind of partner.
KernelRig<float> makeBed(const ContactCoefficients& law, KernelTarget target)
{
    KernelRig<float> bed(law, target);
    bed.dt = 2e-5;
    bed.gravity = Vec3(0.0, 0.0, -9.81);
    bed.walls.push_back({});
    std::uint64_t draws = 0;
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * unitFromBits(mixBits(++draws));
    };
    constexpr double kPitch = 0.0098;
    std::uint32_t frozen = 0;
    for (int k = 0; k < 12; ++k) {
        for (int j = 0; j < 12; ++j) {
            for (int i = 0; i < 16; ++i) {
                const Vec3 jitter(uniform(-4e-4, 4e-4), uniform(-4e-4, 4e-4), uniform(-4e-4, 4e-4));
                const Vec3 at = kPitch * Vec3(i, j, k + 0.5) + jitter;
                const double radius = uniform(0.0046, 0.0054);
                if (k == 1 && i < 8) {
                    bed.addFrozen(at, radius, 1000000 + frozen++, 0.05f);
                    continue;
                }
                GrainRecord<float>& g = bed.add(at, radius);
                g.vx = static_cast<float>(uniform(-0.5, 0.5));
                g.vy = static_cast<float>(uniform(-0.5, 0.5));
                g.vz = static_cast<float>(uniform(-0.5, 0.5));
                g.wx = static_cast<float>(uniform(-30, 30));
                g.wy = static_cast<float>(uniform(-30, 30));
                g.wz = static_cast<float>(uniform(-30, 30));
            }
        }
    }
    return bed;
}

/// All bits that a run leaves behind.
struct Trace {
    std::map<std::uint32_t, std::array<std::uint64_t, 13>> grains;
    std::vector<float> extremes;
    std::vector<std::uint32_t> wake;
    std::uint64_t springs = 0;
    int rebuilds = 0;
    bool operator==(const Trace&) const = default;
};

Trace runBed(const ContactCoefficients& law, KernelTarget target, int observeEvery)
{
    KernelRig<float> bed = makeBed(law, target);
    Trace trace;
    for (int step = 0; step < 250; ++step) {
        bed.step(step % observeEvery == observeEvery - 1);
        for (const ChunkReport& report : bed.reports) {
            EXPECT_FALSE(report.broke);
            trace.extremes.push_back(report.deepestOverlap);
            trace.extremes.push_back(report.fastestSquared);
            trace.wake.insert(trace.wake.end(), report.wake.begin(), report.wake.end());
        }
    }
    for (const ChunkContacts<float>& chunk : bed.lists.chunks()) {
        for (std::size_t p = 0; p < chunk.own.size(); ++p) {
            if (chunk.ownLive[p]) {
                trace.springs = extendHash(trace.springs, std::bit_cast<std::uint32_t>(
                                                              chunk.ownHistory[p].sx));
                trace.springs = extendHash(trace.springs, std::bit_cast<std::uint32_t>(
                                                              chunk.ownHistory[p].qz));
            }
        }
    }
    for (std::size_t k = 0; k < bed.mobile.size(); ++k) {
        const GrainRecord<float>& g = bed.mobile.record[k];
        const GrainLoad load = observeEvery == 1 ? bed.mobile.load[k] : GrainLoad{};
        const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x)}; };
        trace.grains[g.id] = {std::bit_cast<std::uint64_t>(g.x), std::bit_cast<std::uint64_t>(g.y),
                              std::bit_cast<std::uint64_t>(g.z), bits(g.vx), bits(g.vy), bits(g.vz),
                              bits(g.wx), bits(g.wy), bits(g.wz), bits(g.radius),
                              bits(load.contacts), bits(load.load), bits(load.netForce)};
    }
    trace.rebuilds = bed.rebuilds;
    return trace;
}

class KernelTargets : public testing::TestWithParam<std::tuple<NormalLaw, bool, bool>> {};

TEST_P(KernelTargets, LeaveTheSameBits)
{
    const auto [normal, rolls, clips] = GetParam();
    ContactCoefficients law = rig::makeLaw(normal, rolls);
    law.clipAttraction = clips;
    const Trace expected = runBed(law, KernelTarget::scalar, 1);
    // The bed has what it takes: it moved, was listed anew, woke frozen grains, spans chunks.
    EXPECT_GT(expected.grains.size(), 2 * kChunkSize);
    EXPECT_GT(expected.rebuilds, 1);
    EXPECT_FALSE(expected.wake.empty());
    EXPECT_NE(expected.springs, 0u);
    for (const KernelTarget target : availableKernelTargets()) {
        if (target != KernelTarget::scalar) {
            EXPECT_TRUE(runBed(law, target, 1) == expected) << nameOf(target);
        }
    }
}

std::string caseName(const testing::TestParamInfo<KernelTargets::ParamType>& info)
{
    const char* const laws[] = {"linear", "hertz", "bellYuMucha"};
    return std::string(laws[static_cast<int>(std::get<0>(info.param))])
           + (std::get<1>(info.param) ? "Rolls" : "Slips")
           + (std::get<2>(info.param) ? "Clipped" : "Pulls");
}

INSTANTIATE_TEST_SUITE_P(
    Laws, KernelTargets,
    testing::Combine(testing::Values(NormalLaw::linear, NormalLaw::hertz, NormalLaw::bellYuMucha),
                     testing::Bool(), testing::Bool()),
    caseName);

TEST(KernelTargets, ObservingChangesNothing)
{
    const ContactCoefficients law = rig::makeLaw(NormalLaw::linear, true);
    for (const KernelTarget target : availableKernelTargets()) {
        const Trace never = runBed(law, target, 1000);
        EXPECT_TRUE(runBed(law, target, 3) == never) << nameOf(target);
    }
}

TEST(KernelTargets, AreNamedAndBestIsTheLast)
{
    const std::vector<KernelTarget> targets = availableKernelTargets();
    EXPECT_EQ(targets.front(), KernelTarget::scalar);
    EXPECT_STREQ(kernelTargetName(), nameOf(targets.back()));
    EXPECT_STREQ(nameOf(KernelTarget::avx512), "avx512");
#if defined(__x86_64__)
    // A processor with AVX2 must not fall back to less because compiler flags went missing.
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        EXPECT_GE(targets.size(), 3u);
    }
#endif
}

TEST(KernelTargets, OneThatCannotRunIsRefused)
{
    const std::vector<KernelTarget> targets = availableKernelTargets();
    for (const KernelTarget target :
         {KernelTarget::sse4, KernelTarget::avx2, KernelTarget::avx512}) {
        const ContactCoefficients law = rig::makeLaw(NormalLaw::linear, true);
        if (std::find(targets.begin(), targets.end(), target) == targets.end()) {
            EXPECT_THROW(makeForceKernel<float>(law, false, target), InputError);
        } else {
            EXPECT_NE(makeForceKernel<float>(law, false, target), nullptr);
        }
    }
}

}  // namespace
}  // namespace sandflow
