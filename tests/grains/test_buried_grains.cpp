#include "grains/buried_grains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace sandflow {
namespace {

constexpr double kCellSize = 0.03;
constexpr double kHalfUnit = 0.5 * kCellSize / 65536.0;
/// Rounding of centimetres to kilometres in double, on top of the half unit.
constexpr double kRounding = 1e-12;

struct Stored {
    Vec3 position;
    double radius;
};

std::map<std::uint32_t, Stored> makeRandom(std::size_t count, const Vec3& centre, double halfWidth)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> offset(-halfWidth, halfWidth);
    std::uniform_real_distribution<double> size(0.0046, 0.0054);
    std::map<std::uint32_t, Stored> grains;
    for (std::uint32_t id = 0; id < count; ++id) {
        const double x = offset(random), y = offset(random), z = offset(random);
        grains[id] = {centre + Vec3(x, y, z), size(random)};
    }
    return grains;
}

BuriedGrains bury(const std::map<std::uint32_t, Stored>& grains)
{
    BuriedGrains buried(kCellSize);
    for (const auto& [id, g] : grains) {
        buried.add(g.position, g.radius, id);
    }
    return buried;
}

std::int32_t cellOf(double x)
{
    return static_cast<std::int32_t>(std::floor(x / kCellSize));
}

std::set<std::pair<std::int32_t, std::int32_t>> columnsOf(
    const std::map<std::uint32_t, Stored>& grains)
{
    std::set<std::pair<std::int32_t, std::int32_t>> columns;
    for (const auto& [id, g] : grains) {
        columns.emplace(cellOf(g.position.x()), cellOf(g.position.y()));
    }
    return columns;
}

TEST(BuriedGrains, ComeBackWithinHalfAUnitWithTheirRadius)
{
    for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(1234.5, -2345.6, -345.6)}) {
        const auto grains = makeRandom(3000, centre, 0.2);
        BuriedGrains buried = bury(grains);
        ASSERT_EQ(buried.size(), grains.size());
        std::set<std::uint32_t> back;
        for (const auto& [i, j] : columnsOf(grains)) {
            buried.takeAbove(i, j, -1e30, [&](const Vec3& p, double radius, std::uint32_t id) {
                const Stored& was = grains.at(id);
                EXPECT_LE((p - was.position).cwiseAbs().maxCoeff(), kHalfUnit + kRounding);
                EXPECT_EQ(radius, static_cast<double>(static_cast<float>(was.radius)));
                EXPECT_EQ(cellOf(p.x()), i);
                EXPECT_EQ(cellOf(p.y()), j);
                EXPECT_TRUE(back.insert(id).second) << "grain " << id << " came twice";
                return true;
            });
        }
        EXPECT_EQ(back.size(), grains.size());
        EXPECT_EQ(buried.size(), 0u);
    }
}

TEST(BuriedGrains, BuryingAgainAndAgainDoesNotLetAGrainDrift)
{
    const Vec3 start(0.0123456789, -0.0456789, 0.0789123);
    Vec3 p = start;
    for (int n = 0; n < 100; ++n) {
        BuriedGrains buried(kCellSize);
        buried.add(p, 0.005, 7);
        buried.forEach([&](const Vec3& q, double, std::uint32_t) { p = q; });
    }
    EXPECT_LE((p - start).cwiseAbs().maxCoeff(), kHalfUnit + kRounding);
}

TEST(BuriedGrains, TakesOnlyWhatIsWantedAndOffersTheRestAgain)
{
    const auto grains = makeRandom(2000, Vec3::Zero(), 0.1);
    BuriedGrains buried = bury(grains);
    std::size_t taken = 0;
    for (const auto& [i, j] : columnsOf(grains)) {
        buried.takeAbove(i, j, -1e30, [&](const Vec3&, double, std::uint32_t id) {
            taken += id % 3 == 0;
            return id % 3 == 0;
        });
    }
    EXPECT_EQ(taken, 667u);
    EXPECT_EQ(buried.size(), grains.size() - taken);
    std::size_t left = 0;
    buried.forEach([&](const Vec3& p, double, std::uint32_t id) {
        EXPECT_NE(id % 3, 0u);
        EXPECT_LE((p - grains.at(id).position).cwiseAbs().maxCoeff(), kHalfUnit + kRounding);
        ++left;
    });
    EXPECT_EQ(left, buried.size());
}

TEST(BuriedGrains, OffersEveryGrainAboveTheLineOfItsColumnOnly)
{
    const auto grains = makeRandom(4000, Vec3::Zero(), 0.12);
    BuriedGrains buried = bury(grains);
    for (const double line : {-1e30, -0.2, -0.09, -0.01, 0.0, 0.0301, 0.07, 0.2, 1e30}) {
        const std::int32_t i = -2, j = 1;
        std::set<std::uint32_t> above, offered;
        for (const auto& [id, g] : grains) {
            if (cellOf(g.position.x()) == i && cellOf(g.position.y()) == j &&
                g.position.z() > line) {
                above.insert(id);
            }
        }
        double lastBottom = -1e30;
        buried.takeAbove(i, j, line, [&](const Vec3& p, double, std::uint32_t id) {
            EXPECT_EQ(cellOf(p.x()), i);
            EXPECT_EQ(cellOf(p.y()), j);
            EXPECT_GE(p.z(), line - kCellSize) << "only cells that reach above the line";
            const double bottom = kCellSize * cellOf(p.z());
            EXPECT_GE(bottom, lastBottom) << "from below";
            lastBottom = bottom;
            offered.insert(id);
            return false;
        });
        EXPECT_TRUE(std::includes(offered.begin(), offered.end(), above.begin(), above.end()))
            << "line " << line;
    }
    EXPECT_EQ(buried.size(), grains.size()) << "nothing was wanted";
}

TEST(BuriedGrains, ColumnsNeverUsedOfferNothing)
{
    BuriedGrains buried = bury(makeRandom(100, Vec3::Zero(), 0.05));
    buried.takeAbove(100, 100, -1e30, [](const Vec3&, double, std::uint32_t) {
        ADD_FAILURE();
        return true;
    });
    EXPECT_EQ(buried.size(), 100u);
}

TEST(BuriedGrains, AddingAfterTakingAndClearing)
{
    BuriedGrains buried(kCellSize);
    const Vec3 low(0.001, 0.001, 0.001), high(0.001, 0.001, 0.2);
    buried.add(low, 0.005, 1);
    buried.takeAbove(0, 0, -1.0, [](const Vec3&, double, std::uint32_t) { return true; });
    buried.add(high, 0.005, 2);
    buried.add(low, 0.005, 3);
    EXPECT_EQ(buried.size(), 2u);
    std::vector<std::uint32_t> ids;
    buried.takeAbove(0, 0, 0.19, [&](const Vec3&, double, std::uint32_t id) {
        ids.push_back(id);
        return true;
    });
    EXPECT_EQ(ids, std::vector<std::uint32_t>{2});

    buried.clear();
    EXPECT_EQ(buried.size(), 0u);
    buried.forEach([](const Vec3&, double, std::uint32_t) { ADD_FAILURE(); });
    buried.add(low, 0.005, 4);
    ids.clear();
    buried.forEach([&](const Vec3&, double, std::uint32_t id) { ids.push_back(id); });
    EXPECT_EQ(ids, std::vector<std::uint32_t>{4});
}

TEST(BuriedGrains, EveryCornerOfACellIsKept)
{
    // The last unit of a cell must not wrap round to its first, nor to the neighbour's.
    BuriedGrains buried(kCellSize);
    std::map<std::uint32_t, Vec3> put;
    std::uint32_t id = 0;
    for (const double x :
         {0.0, std::nextafter(kCellSize, 0.0), -std::nextafter(0.0, 1.0), -kCellSize, kCellSize}) {
        for (const double z : {0.0, std::nextafter(kCellSize, 0.0), -1e-9}) {
            put[id] = Vec3(x, -x, z);
            buried.add(put[id], 0.005, id);
            ++id;
        }
    }
    buried.forEach([&](const Vec3& p, double, std::uint32_t which) {
        EXPECT_LE((p - put.at(which)).cwiseAbs().maxCoeff(), kHalfUnit + kRounding);
    });
    EXPECT_EQ(buried.size(), put.size());
}

TEST(BuriedGrains, TakesFewBytesAGrain)
{
    const auto grains = makeRandom(60000, Vec3::Zero(), 0.3);  // 27 to 30 a cell, as in sand
    BuriedGrains buried = bury(grains);
    EXPECT_LT(static_cast<double>(buried.bytes()), 48.0 * static_cast<double>(grains.size()));
}

}  // namespace
}  // namespace sandflow
