#include "transfer/bed_settling.h"

#include "transfer_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sandflow::testing {
namespace {

constexpr double kInterval = 0.02;  // s

SettlingParams settlingParams()
{
    SettlingParams params;
    params.depth = 0.1;
    params.least = 0.002;
    params.ending = 0.8;
    params.lately = 0.5;
    return params;
}

/// A bed that creeps at different speeds [m/s] in the left and in the right half of the box.
struct CreepingBed {
    ColumnGrid columns = makeFlatBox(kEdge, kEdge, kCell);
    BedSettling settling;

    explicit CreepingBed(const SettlingParams& params = settlingParams()) : settling(params)
    {
        std::fill(columns.H.begin(), columns.H.end(), 0.3);
    }

    bool isLeft(std::size_t span) const { return columns.columnI[span] < kEdge / 2; }

    const std::vector<double>& pass(double left, double right)
    {
        std::vector<Vec3> velocity(columns.spanCount());
        for (std::size_t s = 0; s < velocity.size(); ++s) {
            velocity[s] = Vec3(isLeft(s) ? left : right, 0.0, 0.0);
        }
        return settling.endedFlows(columns, velocity, kInterval);
    }

    /// Seconds of flow; fails if anything is set free meanwhile.
    void flow(double seconds, double left, double right)
    {
        for (double time = 0.0; time < seconds; time += kInterval) {
            ASSERT_TRUE(pass(left, right).empty()) << time;
        }
    }
};

TEST(BedSettling, SandThatCreptIsSetFreeOnceWhenItsFlowHasEnded)
{
    CreepingBed bed;
    bed.flow(1.0, 0.01, 0.01);
    const std::vector<double> line = bed.pass(0.001, 0.001);
    ASSERT_EQ(line.size(), bed.columns.spanCount());
    for (const double z : line) {
        EXPECT_DOUBLE_EQ(z, 0.2);  // 0.1 below H
    }
    EXPECT_TRUE(bed.pass(0.001, 0.001).empty());
}

TEST(BedSettling, ABedThatHardlyMovedHoldsAsItDid)
{
    CreepingBed bed;
    bed.flow(0.18, 0.01, 0.01);  // 1.8 mm
    EXPECT_TRUE(bed.pass(0.0, 0.0).empty());
}

TEST(BedSettling, ARegionWaitsForAllOfItsFlow)
{
    CreepingBed bed;
    bed.flow(3.0, 0.01, 0.01);
    EXPECT_TRUE(bed.pass(0.0, 0.017).empty());  // 8.5 mm/s on average
    EXPECT_FALSE(bed.pass(0.0, 0.014).empty());
}

TEST(BedSettling, AFlowThatWanesSlowlyHasNotEnded)
{
    CreepingBed bed;
    for (double time = 0.0; time < 20.0; time += kInterval) {
        const double speed = 0.02 * std::exp(-time / 5.0);
        ASSERT_TRUE(bed.pass(speed, speed).empty()) << time;
    }
}

TEST(BedSettling, RegionsApartDoNotWaitForEachOther)
{
    CreepingBed bed;
    bed.flow(1.0, 0.01, 0.0);
    // The right half never crept: it owes nothing.
    const std::vector<double> line = bed.pass(0.0, 0.0);
    ASSERT_EQ(line.size(), bed.columns.spanCount());
    for (std::size_t s = 0; s < line.size(); ++s) {
        EXPECT_EQ(line[s] < BedSettling::kNowhere, bed.isLeft(s)) << s;
    }
}

TEST(BedSettling, NothingIsEverSetFreeWithoutDepth)
{
    SettlingParams off = settlingParams();
    off.depth = 0.0;
    CreepingBed bed(off);
    bed.flow(1.0, 0.01, 0.01);
    EXPECT_TRUE(bed.pass(0.0, 0.0).empty());
}

TEST(MatterTransfer, SetsFreeWhatLiesAboveALine)
{
    State state;
    state.setBed(0.3);
    std::uint32_t id = 0;
    for (int i = 1; i < kEdge - 1; ++i) {
        for (int k = 1; k <= 9; ++k) {
            const Vec3 at = overColumn(i, 3, 0.02 * k + 0.001);
            if (k <= 5) {
                state.buried.add(at, kRadius, id++);
            } else {
                addFrozen(state.dem, at, id++);
            }
        }
    }
    const auto before = collectAll(state);
    std::vector<double> line(state.columns.spanCount(), BedSettling::kNowhere);
    for (std::size_t s = 0; s < line.size(); ++s) {
        if (state.columns.columnI[s] < kEdge / 2) {
            line[s] = 0.07;
        }
    }
    const TransferReport report =
        state.transfer.setFreeAbove(line, state.columns, state.dem, state.buried);
    EXPECT_EQ(report.dislodged, 18u);  // 3 columns, k = 4 to 9
    ASSERT_EQ(collectAll(state).size(), before.size());
    for (const auto& [grain, known] : before) {
        const bool above = known.position.x() < 0.5 * kWidth && known.position.z() > 0.07;
        EXPECT_EQ(state.stateOf(grain) == GrainState::mobile, above) << grain;
    }
    EXPECT_EQ(state.transfer.setFreeAbove({}, state.columns, state.dem, state.buried).dislodged, 0u);
}

}  // namespace
}  // namespace sandflow::testing
