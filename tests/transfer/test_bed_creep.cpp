#include "transfer/bed_creep.h"

#include "transfer_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandflow::testing {
namespace {

constexpr double kDiameter = 2.0 * kRadius;

CreepParams creepParams()
{
    CreepParams params;
    params.diameter = kDiameter;
    params.decay = 1.0 * kDiameter;
    params.depth = 2.0 * kDiameter;
    return params;
}

/// A box full of sand in cubic order: fixed up to kBedTop, above it mobile and flowing along x with
/// u_b (exp(z / lambda) - 1), which is what sand does above a bed that creeps at u_b.
struct FlowingBox {
    static constexpr double kBedTop = 8.0 * kDiameter;
    static constexpr double kTop = 12.0 * kDiameter;
    State state;
    double bedSpeed;

    explicit FlowingBox(double speed) : bedSpeed(speed)
    {
        std::uint32_t id = 0;
        const int across = static_cast<int>(kWidth / kDiameter);
        for (int k = 0; k < 12; ++k) {
            for (int j = 0; j < across; ++j) {
                for (int i = 0; i < across; ++i) {
                    const Vec3 at = kDiameter * Vec3(i + 0.5, j + 0.5, k + 0.5);
                    const double above = at.z() - kBedTop;
                    if (above < 0.0) {
                        addFrozen(state.dem, at, id++);
                    } else {
                        const double flow = speed * std::expm1(above / creepParams().decay);
                        addMobile(state.dem, at, id++, {flow, 0.0, 0.0});
                    }
                }
            }
        }
        for (double& H : state.columns.H) {
            H = kTop + 0.1 * kDiameter;  // no layer of grains on the line between two layers
        }
    }

    /// Speed of the bed [m/s] in the middle of the box, after speeds have been averaged.
    Vec3 creepFor(BedCreep<float>& creep, double seconds)
    {
        for (double time = 0.0; time < seconds; time += 0.02) {
            creep.carry(state.columns, 0.02, state.buried, state.dem);
        }
        const auto middle = state.columns.spanAt(0.5 * kWidth, 0.5 * kWidth, kBedTop);
        return creep.bedVelocity()[static_cast<std::size_t>(middle)];
    }
};

TEST(BedCreep, BedMovesAsTheProfileOfTheFlowAboveItSays)
{
    FlowingBox box(0.01);
    BedCreep<float> creep(creepParams());
    const Vec3 u = box.creepFor(creep, 0.5);
    EXPECT_NEAR(u.x(), 0.01, 0.002);  // flow is sampled at 0.5 and 1.5 d only
    EXPECT_NEAR(u.y(), 0.0, 1e-12);
}

TEST(BedCreep, ARigidBedAndStillSandStayWhereTheyAre)
{
    CreepParams rigid = creepParams();
    rigid.decay = 0.0;
    FlowingBox flowing(0.01);
    BedCreep<float> none(rigid);
    EXPECT_EQ(none.carry(flowing.state.columns, 0.02, flowing.state.buried, flowing.state.dem), 0u);

    FlowingBox still(0.0);
    const auto before = collectAll(still.state);
    BedCreep<float> creep(creepParams());
    EXPECT_EQ(creep.carry(still.state.columns, 0.02, still.state.buried, still.state.dem), 0u);
    for (const auto& [id, grain] : collectAll(still.state)) {
        EXPECT_EQ(grain.position, before.at(id).position);
    }
}

TEST(BedCreep, CarriesWhatLiesOnTheBedAndDiesOutBelowIt)
{
    FlowingBox box(0.01);
    BedCreep<float> creep(creepParams());
    const auto before = collectAll(box.state);
    EXPECT_GT(creep.carry(box.state.columns, 0.02, box.state.buried, box.state.dem), 0u);
    const std::uint32_t layer = 24 * 24;
    const std::uint32_t middle = 12 * 24 + 12;
    const auto shiftOf = [&](std::uint32_t height) {
        const std::uint32_t id = height * layer + middle;
        return collectAll(box.state).at(id).position.x() - before.at(id).position.x();
    };
    EXPECT_GT(shiftOf(8), 0.0);
    EXPECT_NEAR(shiftOf(11), shiftOf(8), 1e-9);  // the flow as a whole, besides its own motion
    EXPECT_LE(shiftOf(7), shiftOf(8));  // centres of the first fixed layer: where the bed begins
    EXPECT_GT(shiftOf(6), 0.0);
    EXPECT_LT(shiftOf(6), 0.5 * shiftOf(7));
    for (std::uint32_t height = 0; height < 6; ++height) {
        EXPECT_EQ(shiftOf(height), 0.0) << height;
    }
    // Who rests on the bed rests: its clock does not see the bed's motion.
    const auto k = static_cast<std::size_t>(mobileIndex(box.state.dem, 8 * layer + middle));
    const GrainRecord<float>& g = box.state.dem.mobile().record[k];
    const GrainMemory& memory = box.state.dem.mobile().memory[k];
    EXPECT_NEAR(g.x - memory.anchorX, 0.0, 1e-12);
}

TEST(BedCreep, StopsAtAWall)
{
    FlowingBox box(0.01);
    BedCreep<float> creep(creepParams());
    box.creepFor(creep, 0.3);
    for (const auto& [id, grain] : collectAll(box.state)) {
        EXPECT_LT(grain.position.x(), kWidth) << id;
    }
}

/// Largest overlap of fixed grains, in radii; those that overlap by more than a tenth.
struct Overlaps {
    double largest = 0.0;
    double share = 0.0;
};

Overlaps overlapsOf(const Dem<float>& dem)
{
    Overlaps out;
    const auto& all = dem.frozen().records();
    for (const GrainRecord<float>& a : all) {
        double deepest = 0.0;
        for (const GrainRecord<float>& b : all) {
            if (a.id != b.id) {
                const double radii = static_cast<double>(a.radius + b.radius);
                deepest = std::max(deepest, (radii - (positionOf(a) - positionOf(b)).norm()) / kRadius);
            }
        }
        out.largest = std::max(out.largest, deepest);
        out.share += deepest > 0.1 ? 1.0 / static_cast<double>(all.size()) : 0.0;
    }
    return out;
}

/// Random fixed grains between z = 0 and 6 d, as dense as poured sand, parted until they fit.
void addLooseBed(Dem<float>& dem)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::uint32_t id = 0;
    for (int n = 0; n < 700; ++n) {  // 0.58 of 8 x 8 x 10 d
        addFrozen(dem, kDiameter * Vec3(8.0 * unit(random), 8.0 * unit(random), 10.0 * unit(random)),
                  id++, GrainState::interface, kRadius * (0.92 + 0.16 * unit(random)));
    }
}

TEST(OverlapParter, ShearedSandMakesWayForItself)
{
    Dem<float> dem(makeSetup());
    dem.recordContacts();
    addLooseBed(dem);
    OverlapParter<float> parter;
    const auto still = [](const GrainRecord<float>&) -> Vec3 { return Vec3(0.0, 0.0, 1e-9); };
    for (int round = 0; round < 60; ++round) {
        parter.shiftAndPart(still, 0.0, BuriedGrains(0.03), dem);
    }
    EXPECT_LT(overlapsOf(dem).share, 0.01);
    // Up to a strain of two, in steps as a bed makes them.
    const auto shear = [](const GrainRecord<float>& g) -> Vec3 { return {0.04 * g.z, 0.0, 0.0}; };
    for (int step = 0; step < 50; ++step) {
        parter.shiftAndPart(shear, 1e-7, BuriedGrains(0.03), dem);
    }
    EXPECT_LT(overlapsOf(dem).share, 0.05);
    EXPECT_LT(overlapsOf(dem).largest, 0.3);
}

TEST(OverlapParter, NobodyIsPressedThroughASmoothWall)
{
    DemSetup setup = makeSetup();
    Primitive wall;  // z = 0
    setup.primitives.push_back(wall);
    wall.axis = -Vec3::UnitX();
    wall.point = Vec3(8.0 * kDiameter, 0.0, 0.0);
    wall.until = 0.0;  // gone: it holds nobody
    setup.primitives.push_back(wall);
    Dem<float> dem(setup);
    dem.recordContacts();
    addLooseBed(dem);
    OverlapParter<float> parter;
    const auto shear = [](const GrainRecord<float>& g) -> Vec3 { return {0.04 * g.z, 0.0, -1e-4}; };
    for (int step = 0; step < 30; ++step) {
        parter.shiftAndPart(shear, 1e-7, BuriedGrains(0.03), dem);
    }
    double farthest = 0.0;
    for (const GrainRecord<float>& g : dem.frozen().records()) {
        EXPECT_GT(g.z, 0.99 * static_cast<double>(g.radius)) << g.id;
        farthest = std::max(farthest, static_cast<double>(g.x));
    }
    EXPECT_GT(farthest, 8.0 * kDiameter);
}

TEST(OverlapParter, WhatDoesNotMoveIsAnObstacle)
{
    Dem<float> dem(makeSetup());
    dem.recordContacts();
    addFrozen(dem, Vec3(0.0, 0.0, 0.0), 1);
    addFrozen(dem, Vec3(0.0112, 0.0, 0.0), 2);
    OverlapParter<float> parter;
    const auto towards = [](const GrainRecord<float>& g) -> Vec3 {
        return g.id == 2 ? Vec3(-0.0018, 0.001, 0.0) : Vec3::Zero();
    };
    EXPECT_EQ(parter.shiftAndPart(towards, 1e-7, BuriedGrains(0.03), dem), 1u);
    const auto one = static_cast<std::size_t>(frozenIndex(dem, 1));
    const auto two = static_cast<std::size_t>(frozenIndex(dem, 2));
    EXPECT_EQ(positionOf(dem.frozen().record(one)), Vec3::Zero());
    const double apart = positionOf(dem.frozen().record(two)).norm();
    EXPECT_GE(apart, 0.99 * kDiameter);
    EXPECT_LE(apart, 1.01 * kDiameter);
}

}  // namespace
}  // namespace sandflow::testing
