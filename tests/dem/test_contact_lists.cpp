#include "grain_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace sandflow {
namespace {

using namespace cloud;

using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< ids: the grain, its partner

/// Pairs (grain, partner) of all chunks, a pair within a chunk from its lower slot only.
struct Listed {
    std::map<Pair, int> own, foreign;
};

Listed collectListed(const Cloud& cloud)
{
    Listed out;
    const std::array<const std::vector<GrainRecord<float>>*, kPartnerSources> source = {
        &cloud.mobile.record, &cloud.frozen.records(), &cloud.boundary.records()};
    for (std::size_t c = 0; c < cloud.lists.chunkCount(); ++c) {
        const ChunkContacts<float>& chunk = cloud.lists.chunks()[c];
        const GrainRecord<float>* grain = cloud.mobile.record.data() + c * kChunkSize;
        for (const std::uint32_t pair : chunk.own) {
            EXPECT_LT(own_pair::lowerOf(pair), own_pair::higherOf(pair));
            EXPECT_LT(own_pair::higherOf(pair), chunk.grainCount);
            ++out.own[{grain[own_pair::lowerOf(pair)].id, grain[own_pair::higherOf(pair)].id}];
        }
        EXPECT_EQ(chunk.foreign.size(), chunk.foreignSlot.size());
        for (std::size_t q = 0; q < chunk.foreign.size(); ++q) {
            const std::uint32_t packed = chunk.foreign[q];
            const std::uint32_t at = partner::indexOf(packed);
            if (partner::sourceOf(packed) == static_cast<std::uint32_t>(PartnerSource::mobile)) {
                EXPECT_NE(at / kChunkSize, c) << "a pair within the chunk belongs to own";
            }
            ++out.foreign[{grain[slot_offset::slotOf(chunk.foreignSlot[q])].id,
                           (*source[partner::sourceOf(packed)])[at].id}];
        }
    }
    return out;
}

/// The balls of all mobile grains, one each, in their order.
std::vector<std::vector<Ball>> ballsOf(const MobileGrains<float>& mobile)
{
    std::vector<std::vector<Ball>> balls;
    for (const GrainRecord<float>& g : mobile.record) {
        balls.push_back({ballOf(g, false)});
    }
    return balls;
}

/// Compares the lists with every pair there is: two grains make one if any of their balls meet.
/// Returns the number of cells that the farthest listed pair is apart.
int expectListsAreComplete(const Cloud& cloud, const std::vector<std::vector<Ball>>& mobile)
{
    const Listed listed = collectListed(cloud);
    std::vector<std::vector<Ball>> fixed;
    std::map<std::uint32_t, std::size_t> chunkOf;
    for (std::size_t k = 0; k < cloud.mobile.size(); ++k) {
        chunkOf[cloud.mobile.record[k].id] = k / kChunkSize;
    }
    for (const auto* records : {&cloud.frozen.records(), &cloud.boundary.records()}) {
        for (const GrainRecord<float>& g : *records) {
            fixed.push_back({ballOf(g, true)});
        }
    }
    // The kernel's balls are a little tighter than asked for, the search's a little wider: a pair
    // that close to the limit may go either way.
    struct Gap {
        double surely = 1e30, maybe = 1e30;  ///< m, negative if the pair must, may be listed
    };
    const auto gapOf = [](const std::vector<Ball>& as, const std::vector<Ball>& bs) {
        Gap least;
        for (const Ball& a : as) {
            for (const Ball& b : bs) {
                const double gap =
                    (a.centre - b.centre).norm() - a.reach - a.radius - b.reach - b.radius;
                const double slack = 3e-4 * (a.reach + b.reach) + 1e-8;
                least.surely = std::min(least.surely, gap + slack);
                least.maybe = std::min(least.maybe, gap - slack);
            }
        }
        return least;
    };
    std::set<Pair> own, foreign, either;
    int farthest = 0;
    const auto cellsApart = [&](const Ball& a, const Ball& b) {
        const CellIndex at = cloud.lists.cells().cellOf(a.centre);
        const CellIndex to = cloud.lists.cells().cellOf(b.centre);
        return std::max({std::abs(at.i - to.i), std::abs(at.j - to.j), std::abs(at.k - to.k)});
    };
    for (std::size_t a = 0; a < mobile.size(); ++a) {
        for (std::size_t b = a + 1; b < mobile.size(); ++b) {
            const Gap gap = gapOf(mobile[a], mobile[b]);
            if (gap.maybe > 0.0) {
                continue;
            }
            farthest = std::max(farthest, cellsApart(mobile[a][0], mobile[b][0]));
            const Pair pair(mobile[a][0].id, mobile[b][0].id);
            const Pair turned(pair.second, pair.first);
            if (chunkOf[pair.first] == chunkOf[pair.second]) {
                (gap.surely > 0.0 ? either : own).insert(pair);
            } else {
                (gap.surely > 0.0 ? either : foreign).insert(pair);
                (gap.surely > 0.0 ? either : foreign).insert(turned);
            }
        }
        for (const std::vector<Ball>& b : fixed) {
            const Gap gap = gapOf(mobile[a], b);
            if (gap.maybe <= 0.0) {
                (gap.surely > 0.0 ? either : foreign).insert({mobile[a][0].id, b[0].id});
                farthest = std::max(farthest, cellsApart(mobile[a][0], b[0]));
            }
        }
    }
    const auto compare = [&](const std::map<Pair, int>& found, const std::set<Pair>& expected) {
        for (const auto& [pair, count] : found) {
            EXPECT_EQ(count, 1) << "pair " << pair.first << ", " << pair.second;
            EXPECT_TRUE(expected.count(pair) || either.count(pair))
                << "pair " << pair.first << ", " << pair.second << " is too far apart";
        }
        for (const Pair& pair : expected) {
            EXPECT_TRUE(found.count(pair))
                << "pair " << pair.first << ", " << pair.second << " is missing";
        }
    };
    compare(listed.own, own);
    compare(listed.foreign, foreign);
    EXPECT_GT(own.size(), 100u);
    EXPECT_GT(foreign.size(), 100u);
    return farthest;
}

int expectListsAreComplete(const Cloud& cloud)
{
    return expectListsAreComplete(cloud, ballsOf(cloud.mobile));
}

TEST(ContactLists, SlowGrainsInSeveralChunks)
{
    CloudSpec spec;
    spec.fastShare = 0.0;
    Cloud cloud = makeCloud(spec);
    cloud.rebuild();
    ASSERT_GT(cloud.lists.chunkCount(), 2u);
    expectListsAreComplete(cloud);
    for (std::size_t c = 0; c < cloud.lists.cells().cells().size(); ++c) {
        EXPECT_EQ(cloud.lists.searchRadius(c), 1) << "slow sand must not pay for a wide search";
    }
}

TEST(ContactLists, FastGrainsAmongSlowOnes)
{
    for (const unsigned seed : {1u, 2u, 3u}) {
        CloudSpec spec;
        spec.seed = seed;
        Cloud cloud = makeCloud(spec);
        cloud.rebuild();
        EXPECT_GE(expectListsAreComplete(cloud), 2) << "fast grains have partners cells away";
    }
}

TEST(ContactLists, FastGrainsCrossingSparseSand)
{
    // Most cells are empty: a search that goes by neighbouring cells alone would miss the partners.
    for (const unsigned seed : {4u, 5u, 6u, 7u}) {
        CloudSpec spec;
        spec.mobile = 1500;
        spec.frozen = spec.boundary = 800;
        spec.halfWidth = 0.2;
        spec.fastShare = 0.1;
        spec.seed = seed;
        Cloud cloud = makeCloud(spec);
        cloud.rebuild();
        EXPECT_GE(expectListsAreComplete(cloud), 2);
    }
}

TEST(ContactLists, AJetOfFastGrainsOnly)
{
    CloudSpec spec;
    spec.mobile = 1200;
    spec.fastShare = 1.0;
    Cloud cloud = makeCloud(spec);
    cloud.rebuild();
    expectListsAreComplete(cloud);
}

TEST(ContactLists, GrainsOfSizesFiveTimesApart)
{
    CloudSpec spec;
    spec.mobile = 2500;
    spec.smallest = 0.4 * kMeanRadius;
    spec.largest = 2.0 * kMeanRadius;
    spec.fastShare = 0.05;
    Cloud cloud = makeCloud(spec);
    cloud.rebuild();
    expectListsAreComplete(cloud);
}

TEST(ContactLists, FarFromTheOriginAndBelowZero)
{
    CloudSpec spec;
    spec.mobile = 1500;
    spec.halfWidth = 0.08;
    spec.centre = Vec3(-4000.0, 3000.0, -50.0);
    Cloud cloud = makeCloud(spec);
    cloud.rebuild();
    expectListsAreComplete(cloud);
}

TEST(ContactLists, GrainsThatLeaveTheirBallsBringTheirPairsOnceOnly)
{
    // Some leave once, some twice, some at a new speed; their pairs with each other count too.
    for (const unsigned seed : {1u, 2u}) {
        CloudSpec spec;
        spec.seed = seed;
        spec.mobile = 2500;
        Cloud cloud = makeCloud(spec);
        cloud.rebuild();
        std::vector<std::vector<Ball>> balls = ballsOf(cloud.mobile);
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::uniform_int_distribution<std::uint32_t> anyone(
            0, static_cast<std::uint32_t>(cloud.mobile.size() - 1));
        for (int n = 0; n < 120; ++n) {
            // A hundred slots far apart, and some of them again.
            const std::uint32_t slot = n < 100 ? anyone(random) : 25u * (n % 5 + 1u);
            GrainRecord<float>& g = cloud.mobile.record[slot];
            const double dx = normal(random), dy = normal(random), dz = normal(random);
            g.x += 0.004 * dx, g.y += 0.004 * dy, g.z += 0.004 * dz;
            g.vx = static_cast<float>(0.5 * dz), g.vz = static_cast<float>(0.5 * dx);
            cloud.lists.followStray(slot, cloud.mobile, cloud.frozen, cloud.boundary, {}, 0.0);
            balls[slot].push_back(ballOf(g, false));
            EXPECT_TRUE(cloud.lists.isInBall(slot, g));
        }
        EXPECT_EQ(cloud.lists.strayCount(), 120u);
        expectListsAreComplete(cloud, balls);
        cloud.rebuild();
        EXPECT_EQ(cloud.lists.strayCount(), 0u);
        expectListsAreComplete(cloud);
    }
}

TEST(ContactLists, BuildingTwiceGivesTheSameLists)
{
    Cloud cloud = makeCloud({});
    cloud.rebuild();
    const Listed before = collectListed(cloud);
    cloud.rebuild();
    const Listed after = collectListed(cloud);
    EXPECT_EQ(before.own, after.own);
    EXPECT_EQ(before.foreign, after.foreign);
}

TEST(ContactLists, BallsAreNeverLargerThanPromised)
{
    // Lists are searched with balls in double; grains are watched with balls rounded to float.
    CloudSpec spec;
    spec.centre = Vec3(100.0, -200.0, 5.0);
    Cloud cloud = makeCloud(spec);
    cloud.rebuild();
    ASSERT_EQ(cloud.lists.balls().size(), cloud.mobile.size());
    for (std::size_t k = 0; k < cloud.mobile.size(); ++k) {
        const Ball exact = ballOf(cloud.mobile.record[k], false);
        const auto& ball = cloud.lists.balls()[k];
        const Vec3 centre = cloud.lists.origin(k / kChunkSize) + Vec3(ball.x, ball.y, ball.z);
        EXPECT_LE((centre - exact.centre).norm() + static_cast<double>(ball.reach), exact.reach);
        EXPECT_GT(static_cast<double>(ball.reach), 0.999 * exact.reach);
    }
}

TEST(ContactLists, WallsWithinReachAreListedOnce)
{
    std::vector<Primitive> walls(2);
    walls[1].point = Vec3(-0.1, 0.0, 0.0);
    walls[1].axis = Vec3::UnitX();
    walls[1].until = 1.0;
    Cloud cloud = makeCloud({});
    for (const double time : {0.5, 1.5}) {
        cloud.lists.rebuild(kHorizon, cloud.mobile, cloud.frozen, cloud.boundary, walls, time,
                            cloud.book, [](const SortedCells&) {});
        std::map<Pair, int> listed;
        for (std::size_t c = 0; c < cloud.lists.chunkCount(); ++c) {
            for (const auto& wall : cloud.lists.chunks()[c].walls) {
                const std::uint32_t slot = wall.grain;
                ++listed[{cloud.mobile.record[c * kChunkSize + slot].id, wall.primitive}];
            }
        }
        std::size_t expected = 0;
        for (const GrainRecord<float>& g : cloud.mobile.record) {
            const Ball ball = ballOf(g, false);
            for (std::uint32_t w = 0; w < walls.size(); ++w) {
                const bool near =
                    walls[w].existsAt(time) &&
                    nearestSurface(walls[w], ball.centre).distance < ball.reach + ball.radius;
                expected += near;
                EXPECT_EQ(listed.count({g.id, w}), near ? 1u : 0u);
            }
        }
        EXPECT_EQ(listed.size(), expected);
        EXPECT_GT(expected, 100u);
    }
}

TEST(ContactLists, NobodyAndASingleGrain)
{
    Cloud cloud(1.08 * kMeanRadius);
    cloud.rebuild();
    EXPECT_EQ(cloud.lists.chunkCount(), 0u);

    CloudSpec spec;
    spec.mobile = 1;
    spec.frozen = spec.boundary = 0;
    Cloud single = makeCloud(spec);
    single.rebuild();
    ASSERT_EQ(single.lists.chunkCount(), 1u);
    EXPECT_EQ(single.lists.chunks()[0].grainCount, 1u);
    EXPECT_TRUE(single.lists.chunks()[0].own.empty());
    EXPECT_TRUE(single.lists.chunks()[0].foreign.empty());
}

}  // namespace
}  // namespace sandflow
