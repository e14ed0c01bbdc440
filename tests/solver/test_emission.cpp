#include "dem/restitution.h"
#include "scenes.h"
#include "solver/overlap_guard.h"

#include <gtest/gtest.h>

#include <random>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kRadius = 0.005;

TEST(BlockedEmitter, HoldsGrainsBackWhileTheirPlaceIsTaken)
{
    // Five grains for one place on the floor: the first rests there for good.
    Scene scene = makeEmptyScene();
    scene.mode = Mode::dem;
    scene.grains.sizeSpread = 0.0;
    for (int n = 0; n < 5; ++n) {
        scene.emitters.push_back(makeSingle(Vec3(0.0, 0.0, 1.02 * kRadius)));
    }
    scene.time.duration = 0.3;
    const auto simulation = run(scene, [](const Simulation&, const FrameReport& report) {
        EXPECT_EQ(report.ledger.emitted, 1u);
        EXPECT_EQ(report.heldBack, 4u);
        EXPECT_TRUE(report.ledger.balances());
    });
    EXPECT_EQ(snapshotOf(*simulation).size(), 1u);
}

TEST(BlockedEmitter, LetsThemInOneByOneAsThePlaceIsFreed)
{
    // High up the place is free again as soon as the last grain has fallen by a diameter (32 ms).
    Scene scene = makeEmptyScene();
    for (int n = 0; n < 5; ++n) {
        scene.emitters.push_back(makeSingle(Vec3(0.0, 0.0, 1.5)));
    }
    scene.time.duration = 0.4;
    std::uint64_t before = 0;
    const auto simulation = run(scene, [&](const Simulation& sim, const FrameReport& report) {
        EXPECT_GE(report.ledger.emitted, before);
        EXPECT_LE(report.ledger.emitted, before + 1);
        before = report.ledger.emitted;
        EXPECT_EQ(report.ledger.emitted + report.heldBack, 5u);
        EXPECT_LE(deepestPair(snapshotOf(sim)), OverlapGuard<float>::kLimit);
        EXPECT_LE(report.deepestOverlap, OverlapGuard<float>::kLimit * kRadius);
    });
    EXPECT_EQ(simulation->ledger().emitted, 5u);
}

TEST(BlockedEmitter, AJetIntoAFullHeapNeverOverlaps)
{
    // The spout is 4 cm above the floor: the heap grows into it.
    Scene scene = makePour(1200, Mode::surfaceFlow);
    scene.emitters[0].position.z() = 0.04;
    scene.time.settle = 0.3;
    std::uint64_t held = 0;
    run(scene, [&](const Simulation& sim, const FrameReport& report) {
        held = std::max(held, report.heldBack);
        EXPECT_TRUE(report.ledger.balances());
        EXPECT_EQ(sim.countLeaks(), 0u);
        EXPECT_LT(report.deepestOverlap, 0.35 * kRadius);
    });
    EXPECT_GT(held, 50u) << "the test must block the spout";
}

/// Mobile and frozen grains at random, no two closer than a radius.
Dem<float> makeCrowd(const DemSetup& setup)
{
    Dem<float> dem(setup);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.06, 0.06);
    std::vector<Vec3> taken;
    dem.recordContacts();
    for (std::uint32_t id = 0; taken.size() < 250; ++id) {
        const double x = place(random), y = place(random), z = 0.06 + place(random);
        const Vec3 p(x, y, z);
        const bool isFree = std::none_of(taken.begin(), taken.end(), [&](const Vec3& q) {
            return (p - q).norm() < 2.0 * kRadius;
        });
        if (!isFree) {
            continue;
        }
        taken.push_back(p);
        if (id % 2 == 0) {
            dem.addMobile(p, Vec3::Zero(), Vec3::Zero(), kRadius, id);
        } else {
            dem.frozen().add(dem.makeRecord(p, kRadius, id), {});
        }
    }
    dem.rebuild(0.0, 1e-4);
    return dem;
}

TEST(OverlapGuard, LetsInExactlyThoseWithRoom)
{
    DemSetup setup;
    setup.law.stiffness = 3000.0;
    setup.largestRadius = 0.006;
    setup.primitives.push_back({});  // smooth plane z = 0
    Scene scene;
    scene.solids.push_back(SolidSpec());
    const SolidSet solids(scene);
    const Dem<float> dem = makeCrowd(setup);
    constexpr double kLimit = OverlapGuard<float>::kLimit;

    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-0.07, 0.07), size(0.004, 0.006);
    const auto overlapWithCrowd = [&](const NewGrain& g) {
        double deepest = g.radius - g.position.z();  // the plane
        deepest /= g.radius;
        for (const auto* records : {&dem.mobile().record, &dem.frozen().records()}) {
            for (const GrainRecord<float>& o : *records) {
                const double radii = g.radius + static_cast<double>(o.radius);
                const double gap = (g.position - Vec3(o.x, o.y, o.z)).norm() - radii;
                deepest =
                    std::max(deepest, -gap / std::min(g.radius, static_cast<double>(o.radius)));
            }
        }
        return deepest;
    };
    OverlapGuard<float> guard;
    std::size_t letIn = 0, held = 0;
    for (int n = 0; n < 3000; ++n) {
        const double x = place(random), y = place(random), z = 0.06 + place(random);
        NewGrain grain;
        grain.position = Vec3(x, y, z);
        grain.radius = size(random);
        std::vector<NewGrain> waiting = {grain}, accepted;
        guard.admit(dem, solids, 0.0, n % 2 == 0 ? 1 : 0, waiting, accepted);
        ASSERT_EQ(waiting.size() + accepted.size(), 1u);
        const double overlap = overlapWithCrowd(grain);
        EXPECT_EQ(accepted.size() == 1, overlap <= kLimit)
            << "overlap " << overlap << " at " << grain.position.transpose();
        letIn += accepted.size();
        held += waiting.size();
    }
    EXPECT_GT(letIn, 100u);
    EXPECT_GT(held, 100u);
}

TEST(OverlapGuard, ThoseTurnedAwayComeAfterTheNewOnesAndClearEachOther)
{
    DemSetup setup;
    setup.law.stiffness = 3000.0;
    const Dem<float> dem(setup);
    const SolidSet solids{Scene()};
    const auto grainAt = [](double x) {
        NewGrain g;
        g.position = Vec3(x, 0.0, 1.0);
        g.radius = kRadius;
        return g;
    };
    // Old: 0.0, 0.004 (in the way of the first), 0.103 (in the way of a new one). New: 0.1, 0.2.
    std::vector<NewGrain> waiting = {grainAt(0.0), grainAt(0.004), grainAt(0.103), grainAt(0.1),
                                     grainAt(0.2)};
    std::vector<NewGrain> accepted;
    OverlapGuard<float> guard;
    guard.admit(dem, solids, 0.0, 3, waiting, accepted);
    std::vector<double> in, left;
    for (const NewGrain& g : accepted) {
        in.push_back(g.position.x());
    }
    for (const NewGrain& g : waiting) {
        left.push_back(g.position.x());
    }
    EXPECT_EQ(in, (std::vector<double>{0.1, 0.2, 0.0}));
    EXPECT_EQ(left, (std::vector<double>{0.004, 0.103}));
}

}  // namespace
}  // namespace sandflow
