#include "transfer_state.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace sandflow {
namespace {

using namespace testing;

TEST(MatterTransfer, ErosionFreesInterfaceGrainsAboveTheBed)
{
    State s;
    s.setBed(0.1);
    addFrozen(s.dem, overColumn(1, 1, 0.095), 1);
    addFrozen(s.dem, overColumn(1, 2, 0.101), 3);                                 // on the line
    addFrozen(s.dem, overColumn(1, 3, 0.103), 5, GrainState::interface, 0.0046);  // above it
    const TransferReport report = s.run();
    EXPECT_EQ(report.dislodged, 1u);
    EXPECT_EQ(s.stateOf(1), GrainState::interface);
    EXPECT_EQ(s.stateOf(3), GrainState::interface) << "a little above the bed it stays";
    ASSERT_EQ(s.stateOf(5), GrainState::mobile);
    const GrainRecord<float>& g = s.dem.mobile().record[0];
    EXPECT_EQ(positionOf(g), overColumn(1, 3, 0.103));
    EXPECT_EQ(g.radius, 0.0046f);
    EXPECT_NEAR(1.0 / static_cast<double>(g.inverseMass), s.dem.massOf(0.0046), 1e-9);
    EXPECT_EQ(g.vx, 0.0f);
    EXPECT_EQ(g.vz, 0.0f);
}

TEST(MatterTransfer, DepositionTrapsGrainsAtRestBelowTheBed)
{
    State s;
    s.setBed(0.1);
    addMobile(s.dem, overColumn(2, 2, 0.095), 2, Vec3(0.001, 0.0, 0.0));  // at rest
    addMobile(s.dem, overColumn(3, 2, 0.095), 3, Vec3(0.5, 0.0, 0.0));    // moves
    addMobile(s.dem, overColumn(4, 2, 0.105), 4);                         // at rest above
    const TransferReport report = s.run();
    EXPECT_EQ(report.trapped, 1u);
    EXPECT_EQ(report.fellAsleep, 1u);
    EXPECT_EQ(s.stateOf(2), GrainState::interface);
    EXPECT_EQ(s.stateOf(3), GrainState::mobile);
    EXPECT_EQ(s.stateOf(4), GrainState::asleep);
    EXPECT_NEAR(report.trappedMomentum, 0.001 * s.dem.massOf(kRadius), 1e-9);
}

TEST(MatterTransfer, OverASlippingBaseNobodyIsFixedAndOnlyLongRestIsSleep)
{
    State s;
    s.setBed(0.1);
    addMobile(s.dem, overColumn(2, 2, 0.095), 2);  // at rest for a second
    addMobile(s.dem, overColumn(3, 2, 0.095), 4);  // at rest for half a second
    addMobile(s.dem, overColumn(4, 2, 0.095), 6);  // likewise, over a base that holds
    addFrozen(s.dem, overColumn(5, 2, 0.095), 8, GrainState::asleep);
    addFrozen(s.dem, overColumn(6, 2, 0.095), 10);
    std::vector<std::uint8_t> slips(s.columns.spanCount(), 1);
    const Vec3 held = overColumn(4, 2, 0.095);
    slips[s.columns.spanAt(held.x(), held.y(), held.z())] = 0;
    s.dem.rebuild(0.0, kStep);
    for (std::size_t k = 0; k < s.dem.mobile().size(); ++k) {
        s.dem.mobile().memory[k].stillTime = s.dem.mobile().record[k].id == 2 ? 1.01f : 0.5f;
    }
    s.transfer.plan(s.columns, s.dem, slips);
    s.dem.recordContacts();
    s.transfer.apply(s.columns, s.dem, s.buried);
    EXPECT_EQ(s.stateOf(2), GrainState::asleep);
    EXPECT_EQ(s.stateOf(4), GrainState::mobile);
    EXPECT_EQ(s.stateOf(6), GrainState::interface);
    EXPECT_EQ(s.stateOf(8), GrainState::asleep) << "a sleeper does not become part of the bed";
    EXPECT_EQ(s.stateOf(10), GrainState::interface) << "what is fixed stays fixed";
}

TEST(MatterTransfer, NobodySleepsWhenSleepIsOff)
{
    TransferParams params;
    params.sleep = false;
    State s(params);
    s.setBed(0.1);
    addMobile(s.dem, overColumn(4, 2, 0.105), 4);
    EXPECT_EQ(s.run().fellAsleep, 0u);
    EXPECT_EQ(s.stateOf(4), GrainState::mobile);
}

TEST(MatterTransfer, SleepersWakeOrSinkIntoTheBed)
{
    State s;
    s.setBed(0.1);
    addFrozen(s.dem, overColumn(1, 1, 0.11), 1, GrainState::asleep);
    addFrozen(s.dem, overColumn(2, 1, 0.11), 2, GrainState::asleep);
    addFrozen(s.dem, overColumn(3, 1, 0.09), 3, GrainState::asleep);
    s.dem.frozen().info(1).wakes = true;
    const TransferReport report = s.run();
    EXPECT_EQ(report.woken, 1u);
    EXPECT_EQ(report.dislodged, 0u) << "waking is no erosion";
    EXPECT_EQ(s.stateOf(1), GrainState::asleep);
    EXPECT_EQ(s.stateOf(2), GrainState::mobile);
    EXPECT_EQ(s.stateOf(3), GrainState::interface);
}

TEST(MatterTransfer, WhatIsDeepIsBuriedAndComesBackWhereItLay)
{
    State s;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> across(0.0, kWidth), up(0.005, 0.15);
    std::map<std::uint32_t, Vec3> where;
    for (std::uint32_t id = 0; id < 2000; ++id) {
        const double x = across(random), y = across(random), z = up(random);
        where[id] = Vec3(x, y, z);
        addFrozen(s.dem, where[id], id);
    }
    s.setBed(0.16);
    const TransferReport down = s.run();
    EXPECT_EQ(down.buried, s.buried.size());
    const double line = 0.16 - s.params.interfaceThickness;
    std::size_t below = 0;
    for (const auto& [id, p] : where) {
        const GrainState state = s.stateOf(id);
        if (p.z() < line - s.params.hysteresis - 1e-9) {
            EXPECT_EQ(state, GrainState::buried);
            ++below;
        } else {
            EXPECT_EQ(state, GrainState::interface);
        }
    }
    EXPECT_EQ(s.buried.size(), below);
    EXPECT_GT(below, 1500u);

    s.setBed(0.08);  // half of it is uncovered, the upper part is dislodged
    const TransferReport half = s.run();
    EXPECT_GT(half.uncovered, 500u);
    for (const auto& [id, known] : collectAll(s)) {
        EXPECT_LE((known.position - where.at(id)).cwiseAbs().maxCoeff(), kHalfUnit);
        const double z = where.at(id).z();
        if (z > 0.08 - s.params.interfaceThickness + 1e-6) {
            EXPECT_NE(s.stateOf(id), GrainState::buried) << z;
        }
    }
    s.setBed(0.0);
    s.run();
    EXPECT_EQ(s.buried.size(), 0u) << "no bed, nothing buried";
    EXPECT_EQ(collectAll(s).size(), where.size());
}

TEST(MatterTransfer, NothingIsBuriedNearAMovingGrain)
{
    State s;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> across(0.0, kWidth), up(0.005, 0.15);
    std::uint32_t id = 0;
    for (; id < 3000; ++id) {
        const double x = across(random), y = across(random), z = up(random);
        addFrozen(s.dem, Vec3(x, y, z), id);
    }
    s.setBed(0.16);
    s.run();
    ASSERT_GT(s.buried.size(), 2000u);
    // Moving grains get deep into the bed, here and there; odd ids do not rest.
    for (const auto& [i, j, z] :
         {std::tuple(1, 1, 0.02), {5, 2, 0.06}, {2, 6, 0.1}, {7, 7, 0.05}}) {
        id += 1 + id % 2;
        addMobile(s.dem, overColumn(i, j, z), id);
    }
    for (int round = 0; round < 2; ++round) {
        const TransferReport report = s.run();
        EXPECT_EQ(report.uncovered > 0, round == 0);
        EXPECT_EQ(report.buried, 0u) << "what was uncovered is not buried again";
        std::size_t checked = 0;
        s.buried.forEach([&](const Vec3& p, double, std::uint32_t) {
            for (const GrainRecord<float>& g : s.dem.mobile().record) {
                // Near: in the 3 x 3 quarters of columns about the moving grain.
                if (std::abs(s.columns.cellIndex(2 * g.x) - s.columns.cellIndex(2 * p.x())) <= 1 &&
                    std::abs(s.columns.cellIndex(2 * g.y) - s.columns.cellIndex(2 * p.y())) <= 1) {
                    EXPECT_LE(p.z(), g.z - s.params.buryClearance + kHalfUnit);
                    ++checked;
                }
            }
        });
        EXPECT_GT(checked, 100u);
    }
}

TEST(MatterTransfer, CountsAreConservedWhateverTheBedDoes)
{
    State s;
    std::mt19937 random(6);
    std::uniform_real_distribution<double> across(-0.05, kWidth + 0.05), up(0.0, 0.3),
        size(0.0046, 0.0054), unit(0.0, 1.0);
    std::map<std::uint32_t, Known> known;
    for (std::uint32_t n = 0; n < 3000; ++n) {  // some of them beyond the last column
        const double x = across(random), y = across(random), z = up(random);
        const double radius = size(random), kind = unit(random);
        const Vec3 p(x, y, z);
        // A few move, low down, and keep the sand around them from being buried.
        const bool moves = n % 500 == 0;
        const std::uint32_t id = 2 * n + (moves ? 1 : 0);
        known[id] = {p, static_cast<float>(radius)};
        if (moves || kind < 0.4) {
            addMobile(s.dem, p, id, Vec3::Zero(), radius);
        } else {
            addFrozen(s.dem, p, id, kind < 0.6 ? GrainState::asleep : GrainState::interface,
                      radius);
        }
    }
    TransferReport sum;
    for (int round = 0; round < 40; ++round) {
        const double height = up(random), slope = unit(random) - 0.5;
        fill(
            s.columns,
            [&](double x, double y) { return std::max(0.0, height + slope * (x - 0.5 * y)); },
            [](double, double) { return 0.02; });
        for (std::size_t k = 0; k < s.dem.frozen().size(); ++k) {
            s.dem.frozen().info(k).wakes =
                unit(random) < 0.1 && s.dem.frozen().info(k).state == GrainState::asleep;
        }
        const std::size_t mobile = s.dem.mobile().size(), frozen = s.dem.frozen().size(),
                          buried = s.buried.size();
        const TransferReport r = s.run();
        EXPECT_EQ(s.dem.mobile().size(), mobile + r.dislodged + r.woken - r.trapped - r.fellAsleep);
        EXPECT_EQ(s.dem.frozen().size(), frozen + r.trapped + r.fellAsleep + r.uncovered -
                                             r.dislodged - r.woken - r.buried);
        EXPECT_EQ(s.buried.size(), buried + r.buried - r.uncovered);
        const auto now = collectAll(s);
        ASSERT_EQ(now.size(), known.size());
        for (const auto& [id, g] : now) {
            // Buried again and again: still within half a unit of where it was first put.
            EXPECT_LE((g.position - known.at(id).position).cwiseAbs().maxCoeff(), kHalfUnit);
            EXPECT_EQ(g.radius, known.at(id).radius);
        }
        sum += r;
    }
    for (const std::uint64_t crossed :
         {sum.trapped, sum.dislodged, sum.buried, sum.uncovered, sum.fellAsleep, sum.woken}) {
        EXPECT_GT(crossed, 50u) << "every way was taken";
    }
}

TEST(MatterTransfer, ReleaseAllMakesEveryGrainMobile)
{
    State s;
    for (std::uint32_t id = 0; id < 4000; ++id) {  // side by side, 20 x 20 x 10
        const double x = 0.012 * (id % 20 + 0.5), y = 0.012 * (id / 20 % 20 + 0.5);
        const double z = 0.012 * (id / 400 + 0.5);
        if (id % 5 == 0) {
            addMobile(s.dem, Vec3(x, y, 0.2 + z), 2 * id + 1, Vec3(1.0, 0.0, 0.0));
        } else {
            addFrozen(s.dem, Vec3(x, y, z), 2 * id,
                      id % 3 == 0 ? GrainState::asleep : GrainState::interface);
        }
    }
    s.setBed(0.2);
    s.run();
    ASSERT_GT(s.buried.size(), 100u);
    const auto before = collectAll(s);
    s.dem.rebuild(0.0, kStep);
    s.dem.recordContacts();
    s.transfer.releaseAll(s.dem, s.buried);
    EXPECT_EQ(s.dem.mobile().size(), before.size());
    EXPECT_EQ(s.dem.frozen().size(), 0u);
    EXPECT_EQ(s.buried.size(), 0u);
    const auto after = collectAll(s);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [id, g] : after) {
        EXPECT_EQ(g.position, before.at(id).position);
        EXPECT_EQ(g.radius, before.at(id).radius);
    }
    s.dem.rebuild(0.0, kStep);
    EXPECT_TRUE(s.dem.listsHold());
}

TEST(MatterTransfer, AllSandInAnImpactZoneIsSetFree)
{
    State s;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> across(0.0, kWidth), up(0.005, 0.155);
    for (std::uint32_t id = 0; id < 2000; ++id) {
        const double x = across(random), y = across(random), z = up(random);
        addFrozen(s.dem, Vec3(x, y, z), id);
    }
    s.setBed(0.16);
    s.run();
    ASSERT_GT(s.buried.size(), 1000u);

    const std::vector<ImpactZone> zones = {{Vec3(0.11, 0.13, 0.16), 0.06}};
    s.dem.rebuild(0.0, kStep);
    wakeZones(zones, s.dem);
    s.transfer.plan(s.columns, s.dem);
    s.dem.recordContacts();
    s.transfer.apply(s.columns, s.dem, s.buried, zones);
    std::size_t freed = 0;
    for (const auto& [id, known] : collectAll(s)) {
        const bool isHeld = zones[0].holds(known.position);
        EXPECT_EQ(s.stateOf(id) == GrainState::mobile, isHeld) << "grain " << id;
        freed += isHeld ? 1 : 0;
        // What lies below the zone pushes back.
        const Vec3 below = known.position - Vec3(0.11, 0.13, 0.1);
        if (std::hypot(below.x(), below.y()) < 0.01 && below.z() < 0.0 && below.z() > -0.01) {
            EXPECT_EQ(s.stateOf(id), GrainState::interface);
        }
    }
    EXPECT_GT(freed, 50u);
}

}  // namespace
}  // namespace sandflow
