#include "scenes.h"

#include <gtest/gtest.h>

#include <omp.h>

namespace sandflow {
namespace {

using namespace testing;

constexpr std::uint64_t kFrames = 25;

/// A jet into a silo: more than one chunk of mobile grains, and a bed deep enough to freeze.
Scene makeScene(Mode mode)
{
    Scene scene = makePour(2200, mode);
    scene.emitters[0].radius = 0.05;
    scene.emitters[0].rate = 3200.0;
    scene.emitters[0].speed = 1.0;
    scene.emitters[0].position.z() = 0.25;
    SolidSpec silo;
    silo.shape = SolidShape::cylinder;
    silo.name = "silo";
    silo.hollow = true;
    silo.radius = 0.07;
    silo.height = 0.4;
    scene.solids.push_back(silo);
    return scene;
}

std::vector<std::uint64_t> hashes(const Scene& scene, Ledger& last)
{
    std::vector<std::uint64_t> out;
    run(
        scene,
        [&](const Simulation& sim, const FrameReport& report) {
            out.push_back(sim.stateHash());
            last = report.ledger;
        },
        kFrames);
    EXPECT_EQ(out.size(), kFrames);
    return out;
}

class SameBits : public ::testing::TestWithParam<Mode> {
protected:
    void TearDown() override { omp_set_num_threads(2); }
};

TEST_P(SameBits, OnAnyNumberOfThreadsAndEveryTime)
{
    const Scene scene = makeScene(GetParam());
    Ledger ledger;
    omp_set_num_threads(1);
    const std::vector<std::uint64_t> one = hashes(scene, ledger);
    EXPECT_GT(ledger.emitted, 2100u) << "two chunks must have been full";
    if (GetParam() == Mode::surfaceFlow) {
        EXPECT_GT(ledger.interface, 50u) << "some must be frozen";
        EXPECT_GT(ledger.asleep, 10u);
    }
    for (const int threads : {1, 2, 3, 4}) {
        omp_set_num_threads(threads);
        EXPECT_EQ(hashes(scene, ledger), one) << threads << " threads";
    }
}

TEST_P(SameBits, ButNotWithAnotherSeed)
{
    Scene scene = makeScene(GetParam());
    Scene other = scene;
    other.seed = 2;
    Ledger ledger;
    const std::vector<std::uint64_t> a = hashes(scene, ledger), b = hashes(other, ledger);
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_NE(a[k], b[k]) << "frame " << k + 1;
        EXPECT_TRUE(k == 0 || a[k] != a[k - 1]);
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, SameBits, ::testing::Values(Mode::surfaceFlow, Mode::dem));

}  // namespace
}  // namespace sandflow
