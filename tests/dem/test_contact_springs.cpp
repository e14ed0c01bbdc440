#include "dem/dem.h"
#include "dem/restitution.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <vector>

/// What outlives a rebuild of the contact lists, and how long lists hold.
namespace sandflow {
namespace {

constexpr double kRadius = 0.005;
constexpr double kStep = 1e-4;

DemSetup makeSetup()
{
    DemSetup setup;
    setup.law.stiffness = 3000.0;
    setup.law.damping = solveDamping(NormalLaw::linear, true, 0.3);
    setup.law.friction = 0.5;
    setup.law.tangentialRatio = 2.0 / 7.0;
    setup.law.tangentialDamping = 0.2;
    setup.law.rollingFriction = 0.1;
    setup.law.rollingStiffness = 2.25 * 0.01;
    setup.law.rollingDamping = 0.3;
    return setup;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Springs = std::array<float, 6>;

Springs toArray(const PairHistory<float>& h)
{
    return {h.sx, h.sy, h.sz, h.qx, h.qy, h.qz};
}

/// 0 - x, so that nothing turns into -0.
Springs turned(const Springs& s)
{
    Springs out;
    for (std::size_t k = 0; k < s.size(); ++k) {
        out[k] = 0.0f - s[k];
    }
    return out;
}

/// Springs of all live contacts as each grain sees them, by the ids of grain and partner.
std::map<Pair, Springs> collectSprings(const Dem<float>& dem)
{
    std::map<Pair, Springs> out;
    const std::array<const std::vector<GrainRecord<float>>*, kPartnerSources> source = {
        &dem.mobile().record, &dem.frozen().records(), &dem.boundary().records()};
    for (std::size_t c = 0; c < dem.lists().chunkCount(); ++c) {
        const ChunkContacts<float>& chunk = dem.lists().chunks()[c];
        const GrainRecord<float>* grain = dem.mobile().record.data() + c * kChunkSize;
        for (std::size_t p = 0; p < chunk.own.size(); ++p) {
            if (chunk.ownLive[p]) {
                const std::uint32_t a = grain[own_pair::lowerOf(chunk.own[p])].id;
                const std::uint32_t b = grain[own_pair::higherOf(chunk.own[p])].id;
                const Springs springs = toArray(chunk.ownHistory[p]);
                EXPECT_TRUE(out.emplace(Pair(a, b), springs).second);
                EXPECT_TRUE(out.emplace(Pair(b, a), turned(springs)).second);
            }
        }
        for (std::size_t q = 0; q < chunk.foreign.size(); ++q) {
            const std::uint32_t packed = chunk.foreign[q];
            if (chunk.foreignLive[q]) {
                const std::uint32_t b =
                    (*source[partner::sourceOf(packed)])[partner::indexOf(packed)].id;
                EXPECT_TRUE(out.emplace(Pair(grain[slot_offset::slotOf(chunk.foreignSlot[q])].id, b),
                                        toArray(chunk.foreignHistory[q]))
                                .second);
            }
        }
        for (std::size_t w = 0; w < chunk.walls.size(); ++w) {
            if (chunk.walls[w].live) {
                const std::uint32_t slot = chunk.walls[w].grain;
                EXPECT_TRUE(
                    out.emplace(Pair(grain[slot].id, kFirstWallId + chunk.walls[w].primitive),
                                toArray(chunk.wallHistory[w]))
                        .second);
            }
        }
    }
    return out;
}

/// Grains pressed lightly into each other on a jittered lattice over a plane, shoved at random so
/// that every contact slips; every seventh frozen.
Dem<float> makeShovedBed(int edge, const DemSetup& setup)
{
    Dem<float> dem(setup);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> jitter(-2e-4, 2e-4), shove(-0.1, 0.1), spin(-10.0, 10.0);
    dem.recordContacts();
    std::uint32_t id = 0;
    for (int k = 0; k < edge; ++k) {
        for (int j = 0; j < edge; ++j) {
            for (int i = 0; i < edge; ++i) {
                const double a = jitter(random), b = jitter(random), c = jitter(random);
                const Vec3 p = 1.98 * kRadius * Vec3(i, j, k) + Vec3(a, b, c + 0.99 * kRadius);
                const double u = shove(random), v = shove(random), w = shove(random);
                const double s = spin(random), t = spin(random), r = spin(random);
                if (id % 7 == 3) {
                    FrozenInfo info;
                    GrainRecord<float> g = dem.makeRecord(p, kRadius, id);
                    g.wakeForce = 1e30f;
                    dem.frozen().add(g, info);
                } else {
                    dem.addMobile(p, Vec3(u, v, w), Vec3(s, t, r), kRadius, id);
                }
                ++id;
            }
        }
    }
    dem.rebuild(0.0, kStep);
    return dem;
}

void expectMirrored(const std::map<Pair, Springs>& springs)
{
    std::size_t mirrored = 0;
    for (const auto& [pair, s] : springs) {
        const auto other = springs.find({pair.second, pair.first});
        if (other != springs.end()) {
            ++mirrored;
            EXPECT_EQ(other->second, turned(s)) << pair.first << ", " << pair.second;
        }
    }
    EXPECT_GT(mirrored, 100u);
}

TEST(ContactSprings, OutliveARebuildWithTheirSign)
{
    DemSetup setup = makeSetup();
    setup.primitives.push_back({});  // smooth plane z = 0
    Dem<float> dem = makeShovedBed(14, setup);
    ASSERT_GT(dem.lists().chunkCount(), 2u);
    for (int n = 0; n < 5; ++n) {
        dem.step(kStep, false);
    }
    const std::map<Pair, Springs> before = collectSprings(dem);
    expectMirrored(before);
    std::size_t stretched = 0, walls = 0;
    for (const auto& [pair, s] : before) {
        stretched += s[0] != 0.0f || s[1] != 0.0f || s[2] != 0.0f;
        walls += pair.second >= kFirstWallId;
    }
    EXPECT_GT(stretched, before.size() * 9 / 10);
    EXPECT_GT(walls, 50u);

    dem.recordContacts();
    dem.rebuild(0.0, kStep);
    EXPECT_EQ(collectSprings(dem), before);
}

TEST(ContactSprings, OutliveAnOrderOfGrainsThatChanged)
{
    // Grains move through cells and chunks; half-way each pair may be owned by the other side.
    const DemSetup setup = makeSetup();
    Dem<float> dem = makeShovedBed(13, setup);
    for (int round = 0; round < 6; ++round) {
        for (int n = 0; n < 10 && dem.listsHold(); ++n) {
            dem.step(kStep, false);
        }
        const std::map<Pair, Springs> before = collectSprings(dem);
        dem.recordContacts();
        for (GrainRecord<float>& g : dem.mobile().record) {
            g.x += 0.004 * (round + 1);  // all alike: contacts stay, cells do not
        }
        FixedGrains<float, FrozenInfo>& frozen = dem.frozen();
        std::vector<GrainRecord<float>> moved = frozen.records();
        frozen.removeUnless([](std::size_t) { return false; });
        for (GrainRecord<float>& g : moved) {
            g.x += 0.004 * (round + 1);
            frozen.add(g, {});
        }
        dem.rebuild(0.0, kStep);
        EXPECT_EQ(collectSprings(dem), before) << "round " << round;
    }
}

TEST(ContactSprings, OutliveFreezingAndRelease)
{
    Dem<float> dem = makeShovedBed(12, makeSetup());
    for (int n = 0; n < 5; ++n) {
        dem.step(kStep, false);
    }
    const std::map<Pair, Springs> before = collectSprings(dem);
    // Every eleventh mobile grain freezes.
    dem.recordContacts();
    MobileGrains<float>& mobile = dem.mobile();
    mobile.removeUnless([&](std::size_t k) {
        const GrainRecord<float>& g = mobile.record[k];
        if (g.id % 11 != 0) {
            return true;
        }
        FrozenInfo info;
        info.row = mobile.row[k];
        dem.frozen().add(dem.makeRecord(Vec3(g.x, g.y, g.z), static_cast<double>(g.radius), g.id),
                         info);
        return false;
    });
    dem.rebuild(0.0, kStep);
    const auto isFrozen = [](std::uint32_t id) { return id % 11 == 0 || id % 7 == 3; };
    std::map<Pair, Springs> expected;
    for (const auto& [pair, s] : before) {
        if (!isFrozen(pair.first)) {
            expected.emplace(pair, s);
        }
    }
    EXPECT_EQ(collectSprings(dem), expected);

    // And all are freed: contacts with mobile partners stand in those partners' rows.
    dem.recordContacts();
    std::vector<GrainRecord<float>> freed = dem.frozen().records();
    dem.frozen().removeUnless([](std::size_t) { return false; });
    for (const GrainRecord<float>& g : freed) {
        dem.addMobile(Vec3(g.x, g.y, g.z), Vec3::Zero(), Vec3::Zero(),
                      static_cast<double>(g.radius), g.id);
    }
    dem.rebuild(0.0, kStep);
    for (const auto& [pair, s] : std::map<Pair, Springs>(expected)) {
        expected[{pair.second, pair.first}] = turned(s);
    }
    EXPECT_EQ(collectSprings(dem), expected);
}

TEST(ContactSprings, AreForgottenWhenTheContactEnds)
{
    DemSetup setup = makeSetup();
    setup.gravity = Vec3::Zero();
    Dem<float> dem(setup);
    dem.recordContacts();
    dem.addMobile(Vec3(0, 0, 0), Vec3(0, 0.1, 0), Vec3::Zero(), kRadius, 0);
    dem.addMobile(Vec3(1.99 * kRadius, 0, 0), Vec3(0, -0.1, 0), Vec3::Zero(), kRadius, 1);
    dem.rebuild(0.0, kStep);
    dem.step(kStep, false);
    EXPECT_EQ(collectSprings(dem).size(), 2u);
    for (int n = 0; n < 200; ++n) {
        if (!dem.listsHold()) {
            dem.recordContacts();
            dem.rebuild(0.0, kStep);
        }
        dem.step(kStep, false);
    }
    EXPECT_TRUE(collectSprings(dem).empty()) << "they flew apart long ago";
}

TEST(ContactListsHold, WhileAFastGrainFliesFreely)
{
    for (const double speed : {0.5, 1.0, 2.0, 4.0}) {
        Dem<float> dem(makeSetup());
        dem.recordContacts();
        const Vec3 direction = Vec3(1.0, -2.0, -0.5).normalized();
        dem.addMobile(Vec3(0, 0, 1), speed * direction, Vec3::Zero(), kRadius, 0);
        dem.rebuild(0.0, kStep);
        const auto& ball = dem.lists().balls()[0];
        // reach = skin / 2 + |v| T / 2
        const double horizon =
            2.0 * (static_cast<double>(ball.reach) - 0.5 * dem.lists().skin()) / speed;
        const int steps = static_cast<int>(horizon / kStep);
        EXPECT_GE(steps, 15) << speed;
        for (int n = 0; n < steps; ++n) {
            dem.step(kStep, false);
            ASSERT_TRUE(dem.listsHold());
            ASSERT_EQ(dem.lists().strayCount(), 0u)
                << "step " << n << " of " << steps << " at " << speed;
        }
        // Afterwards it has another ball, or the lists are done for.
        for (int n = 0; n < 5 * steps; ++n) {
            dem.step(kStep, false);
            ASSERT_TRUE(!dem.listsHold() || dem.lists().isInBall(0, dem.mobile().record[0]));
            if (!dem.listsHold()) {
                dem.recordContacts();
                dem.rebuild(0.0, kStep);
            }
        }
    }
}

TEST(ContactListsHold, WhenAFastGrainStops)
{
    // It hits the sand and stays: still inside its ball, which begins where it was.
    DemSetup setup = makeSetup();
    setup.gravity = Vec3::Zero();
    Dem<float> dem(setup);
    dem.recordContacts();
    dem.addMobile(Vec3::Zero(), Vec3(3.0, 0.0, 0.0), Vec3::Zero(), kRadius, 0);
    dem.rebuild(0.0, kStep);
    dem.step(kStep, false);
    dem.mobile().record[0].vx = 0.0f;
    for (int n = 0; n < 100; ++n) {
        dem.step(kStep, false);
    }
    EXPECT_TRUE(dem.listsHold());
    EXPECT_EQ(dem.lists().strayCount(), 0u);
}

TEST(ContactListsHold, ForGrainsAtRestWhateverFliesBy)
{
    DemSetup setup = makeSetup();
    setup.gravity = Vec3::Zero();
    Dem<float> dem(setup);
    dem.recordContacts();
    for (std::uint32_t id = 0; id < 100; ++id) {
        dem.addMobile(Vec3(0.011 * id, 0, 0), Vec3::Zero(), Vec3::Zero(), kRadius, id);
    }
    dem.addMobile(Vec3(0, 0.1, 0), Vec3(4.0, 0.0, 0.0), Vec3::Zero(), kRadius, 100);
    dem.rebuild(0.0, kStep);
    for (std::size_t k = 0; k < dem.mobile().size(); ++k) {
        if (dem.mobile().record[k].id < 100) {
            EXPECT_NEAR(static_cast<double>(dem.lists().balls()[k].reach), dem.lists().skin() / 2,
                        1e-6);
        }
    }
}

}  // namespace
}  // namespace sandflow
