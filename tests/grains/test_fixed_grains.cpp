#include "grains/fixed_grains.h"
#include "grains/frozen_info.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace sandflow {
namespace {

using Frozen = FixedGrains<float, FrozenInfo>;

GrainRecord<float> makeRecord(const Vec3& p, std::uint32_t id)
{
    GrainRecord<float> g;
    g.x = p.x(), g.y = p.y(), g.z = p.z();
    g.radius = 0.005f;
    g.id = id;
    g.wakeForce = static_cast<float>(id);
    return g;
}

/// Ids and sleepers alternate, so that a record that lost its info shows.
Frozen makeRandom(std::size_t count)
{
    Frozen grains(0.02);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.1, 0.1);
    for (std::uint32_t id = 0; id < count; ++id) {
        const double x = place(random), y = place(random), z = place(random);
        FrozenInfo info;
        info.state = id % 2 == 0 ? GrainState::asleep : GrainState::interface;
        info.restForce = Vec3f(static_cast<float>(id), 0.0f, 0.0f);
        grains.add(makeRecord(Vec3(x, y, z), id), info);
    }
    return grains;
}

void expectRecordsMatchInfos(const Frozen& grains)
{
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const std::uint32_t id = grains.record(k).id;
        EXPECT_EQ(grains.record(k).wakeForce, static_cast<float>(id));
        EXPECT_EQ(grains.info(k).restForce.x(), static_cast<float>(id));
        EXPECT_EQ(grains.info(k).state, id % 2 == 0 ? GrainState::asleep : GrainState::interface);
    }
}

/// Entry k of the cells must be grain k.
void expectSortedAlongCells(const Frozen& grains)
{
    std::size_t entries = 0;
    for (const SortedCells::Cell& cell : grains.cells().cells()) {
        for (std::uint32_t k = cell.begin; k < cell.end; ++k) {
            const GrainRecord<float>& g = grains.record(k);
            EXPECT_EQ(grains.cells().cellOf(Vec3(g.x, g.y, g.z)), cell.index);
            ++entries;
        }
    }
    EXPECT_EQ(entries, grains.size());
}

TEST(FixedGrains, SortingKeepsRecordsAndInfosTogether)
{
    Frozen grains = makeRandom(1000);
    grains.sort();
    ASSERT_EQ(grains.size(), 1000u);
    expectRecordsMatchInfos(grains);
    expectSortedAlongCells(grains);
    std::map<std::uint32_t, int> seen;
    for (const GrainRecord<float>& g : grains.records()) {
        ++seen[g.id];
    }
    EXPECT_EQ(seen.size(), 1000u) << "none lost, none doubled";
}

TEST(FixedGrains, SortingAgainChangesNothing)
{
    Frozen grains = makeRandom(300);
    grains.sort();
    const std::vector<GrainRecord<float>> before = grains.records();
    grains.removeUnless([](std::size_t) { return true; });
    grains.sort();
    for (std::size_t k = 0; k < before.size(); ++k) {
        EXPECT_EQ(grains.record(k).id, before[k].id);
    }
    expectSortedAlongCells(grains);
}

TEST(FixedGrains, RemovesExactlyThoseNotKeptAndKeepsTheOrder)
{
    Frozen grains = makeRandom(500);
    std::vector<std::uint32_t> expected;
    for (const GrainRecord<float>& g : grains.records()) {
        if (g.id % 3 != 0) {
            expected.push_back(g.id);
        }
    }
    std::size_t asked = 0;
    grains.removeUnless([&](std::size_t k) {
        ++asked;
        return grains.record(k).id % 3 != 0;
    });
    EXPECT_EQ(asked, 500u);
    ASSERT_EQ(grains.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(grains.record(k).id, expected[k]);
    }
    expectRecordsMatchInfos(grains);
    grains.sort();
    expectRecordsMatchInfos(grains);
    expectSortedAlongCells(grains);
}

TEST(FixedGrains, GrainsAddedAfterSortingAreSortedIn)
{
    Frozen grains = makeRandom(200);
    grains.sort();
    FrozenInfo info;
    info.state = GrainState::asleep;
    info.restForce.x() = 1000.0f;
    grains.add(makeRecord(Vec3(-0.3, 0.0, 0.0), 1000), info);
    grains.sort();
    ASSERT_EQ(grains.size(), 201u);
    expectRecordsMatchInfos(grains);
    expectSortedAlongCells(grains);
}

TEST(FixedGrains, RemovingAllLeavesNoCells)
{
    Frozen grains = makeRandom(50);
    grains.sort();
    grains.removeUnless([](std::size_t) { return false; });
    grains.sort();
    EXPECT_EQ(grains.size(), 0u);
    EXPECT_TRUE(grains.cells().cells().empty());
}

}  // namespace
}  // namespace sandflow
