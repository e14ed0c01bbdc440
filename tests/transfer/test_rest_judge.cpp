#include "grain_states.h"
#include "transfer/rest_judge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sandflow {
namespace {

using namespace testing;

constexpr double kInterval = 0.02;  // s

/// A mobile grain that the observation calls well supported; tests move it by hand.
Dem<float> makeSupported()
{
    Dem<float> dem(makeSetup());
    dem.recordContacts();
    addMobile(dem, Vec3(1.0, 2.0, 3.0), 0);
    dem.rebuild(0.0, kStep);
    dem.mobile().load[0].contacts = 6.0f;
    dem.mobile().load[0].netForce = 0.0f;
    dem.mobile().load[0].load = 0.1f;
    return dem;
}

TEST(RestRules, ComeFromTheScene)
{
    SurfaceFlowSpec spec;
    spec.freezeSpeed = 0.003;
    spec.freezeTime = 0.1;
    spec.cagedTime = 0.5;
    const RestRules rules = makeRestRules(spec);
    EXPECT_DOUBLE_EQ(rules.freezeDistance, 3e-4);
    EXPECT_DOUBLE_EQ(rules.freezeTime, 0.1);
    EXPECT_DOUBLE_EQ(rules.cagedTime, 0.5);
    EXPECT_DOUBLE_EQ(rules.slowSpeed, 0.003);
    EXPECT_LT(rules.sleepSpeed, 0.1 * rules.slowSpeed);
}

TEST(IsAtRest, ASupportedStillGrainAfterFreezeTime)
{
    Dem<float> dem = makeSupported();
    const RestRules rules;
    for (int window = 1; window <= 6; ++window) {
        updateRestClocks(rules, kInterval, dem);
        EXPECT_EQ(isAtRest(rules, dem, 0), window * kInterval >= rules.freezeTime - 1e-9)
            << "after " << window << " x 20 ms";
    }
}

TEST(IsAtRest, TooFewContactsOrTooMuchForceMustWaitUntilCaged)
{
    const RestRules rules;
    Dem<float> loose = makeSupported(), pushed = makeSupported();
    loose.mobile().load[0].contacts = 2.0f;
    const double weight = kGravity * loose.massOf(kRadius);
    pushed.mobile().load[0].load = static_cast<float>(2.0 * weight);
    pushed.mobile().load[0].netForce = static_cast<float>(1.6 * weight);  // > 0.5 of 3 weights
    for (int window = 1; window <= 20; ++window) {
        for (Dem<float>* dem : {&loose, &pushed}) {
            updateRestClocks(rules, kInterval, *dem);
            EXPECT_EQ(isAtRest(rules, *dem, 0), window >= 16) << "after " << window << " x 20 ms";
        }
    }
    pushed.mobile().memory[0].stillTime = 0.1f;
    pushed.mobile().load[0].netForce = static_cast<float>(1.4 * weight);
    EXPECT_TRUE(isAtRest(rules, pushed, 0)) << "1.4 < 0.5 x 3 weights";
}

TEST(IsAtRest, ACreepingGrainNever)
{
    const RestRules rules;
    const double limit = rules.freezeDistance / rules.freezeTime;
    for (const double speed : {1.25 * limit, 2.5 * limit, 25.0 * limit}) {
        Dem<float> dem = makeSupported();
        for (int window = 0; window < 100; ++window) {
            dem.mobile().record[0].x += speed * kInterval;
            updateRestClocks(rules, kInterval, dem);
            ASSERT_FALSE(isAtRest(rules, dem, 0)) << speed << " m/s";
        }
    }
    Dem<float> slow = makeSupported();
    for (int window = 0; window < 5; ++window) {
        slow.mobile().record[0].x += 0.5 * limit * kInterval;
        updateRestClocks(rules, kInterval, slow);
    }
    EXPECT_TRUE(isAtRest(rules, slow, 0)) << "half the limit";
}

TEST(IsAtRest, AGrainThatRattlesInItsCage)
{
    const RestRules rules;
    Dem<float> dem = makeSupported();
    dem.mobile().record[0].vx = 0.05f;  // fast, but to and fro by 0.05 mm
    for (int window = 1; window <= 5; ++window) {
        dem.mobile().record[0].x += (window % 2 ? 1.0 : -1.0) * 5e-5;
        updateRestClocks(rules, kInterval, dem);
    }
    EXPECT_FALSE(isAtRest(rules, dem, 0)) << "its momentum would be lost";
    dem.mobile().record[0].vx = 0.0f;  // where it turns
    EXPECT_TRUE(isAtRest(rules, dem, 0));
}

TEST(IsAtRest, WhoIsToSettleCountsAsMovingUntilThen)
{
    Dem<float> dem = makeSupported();
    const RestRules rules;
    dem.mobile().memory[0].stillTime = -0.1f;
    for (int window = 1; window <= 12; ++window) {
        if (window == 2) {  // that it moves meanwhile costs it no more time
            dem.mobile().record[0].x += 2.0 * rules.freezeDistance;
        }
        updateRestClocks(rules, kInterval, dem);
        EXPECT_EQ(isAtRest(rules, dem, 0), window * kInterval >= 0.1 + rules.freezeTime - 1e-6)
            << window;
    }
}

TEST(IsAtRest, AGrainThatSettlesInAHollowButNotWhileItBounces)
{
    Dem<float> dem(makeSetup());
    const RestRules rules;
    dem.recordContacts();
    addHollow(dem);
    addMobile(dem, Vec3(0.0, 0.0, hollowHeight() + 0.02), 0);  // falls 2 cm
    dem.rebuild(0.0, kStep);
    judgeNewlyFrozen(rules, dem);
    double lastMoved = 0.0, firstRest = 0.0;
    Vec3 before = positionOf(dem.mobile().record[0]);
    for (int window = 1; window <= 60 && firstRest == 0.0; ++window) {
        advance(dem, kInterval);
        updateRestClocks(rules, kInterval, dem);
        const Vec3 now = positionOf(dem.mobile().record[0]);
        if ((now - before).norm() > rules.freezeDistance) {
            lastMoved = window * kInterval;
        }
        before = now;
        if (isAtRest(rules, dem, 0)) {
            firstRest = window * kInterval;
        }
    }
    ASSERT_GT(firstRest, 0.0) << "it never came to rest";
    EXPECT_GT(lastMoved, 0.05) << "20 mm take 64 ms";
    EXPECT_GE(firstRest, lastMoved + rules.freezeTime - 1e-9);
    EXPECT_LE(firstRest, lastMoved + rules.freezeTime + 2.0 * kInterval + 1e-9);
    EXPECT_EQ(dem.mobile().load[0].contacts, 4.0f);
    EXPECT_NEAR(dem.mobile().record[0].z, hollowHeight(), 1e-4);
}

TEST(IsAtRest, NotAGrainThatRollsDownASlope)
{
    // 30 degrees and no rolling friction: it rolls for ever.
    DemSetup setup = makeSetup();
    Primitive slope;
    slope.axis = Vec3(std::sin(kPi / 6), 0.0, std::cos(kPi / 6));
    setup.primitives.push_back(slope);
    Dem<float> dem(setup);
    const RestRules rules;
    dem.recordContacts();
    addMobile(dem, 0.999 * kRadius * slope.axis, 0);
    dem.rebuild(0.0, kStep);
    for (int window = 0; window < 25; ++window) {
        advance(dem, kInterval);
        updateRestClocks(rules, kInterval, dem);
        EXPECT_FALSE(isAtRest(rules, dem, 0)) << window;
    }
}

/// A sleeper in a hollow, settled, then pressed down to `depth` times as far, judged.
Dem<float> makeSleeper(NormalLaw law, double depth = 1.0)
{
    Dem<float> dem(makeSetup(law));
    const RestRules rules;
    dem.recordContacts();
    addHollow(dem);
    addMobile(dem, Vec3(0.0, 0.0, hollowHeight()), 0);
    dem.rebuild(0.0, kStep);
    advance(dem, 0.3);
    Vec3 where = positionOf(dem.mobile().record[0]);
    where.z() = hollowHeight() + depth * (where.z() - hollowHeight());
    dem.recordContacts();
    dem.mobile().removeUnless([](std::size_t) { return false; });
    addFrozen(dem, where, 0, GrainState::asleep);
    dem.rebuild(0.0, kStep);
    judgeNewlyFrozen(rules, dem);
    return dem;
}

bool wakes(const Dem<float>& dem)
{
    const std::ptrdiff_t k = frozenIndex(dem, 0);
    EXPECT_GE(k, 0);
    return k >= 0 && dem.frozen().info(static_cast<std::size_t>(k)).wakes;
}

class Sleepers : public ::testing::TestWithParam<NormalLaw> {};

TEST_P(Sleepers, CarryTheirWeightWhenTheyFallAsleep)
{
    Dem<float> dem = makeSleeper(GetParam());
    const FrozenInfo& info = dem.frozen().info(static_cast<std::size_t>(frozenIndex(dem, 0)));
    const double weight = kGravity * dem.massOf(kRadius);
    EXPECT_TRUE(info.judged);
    // Friction may carry some of it.
    EXPECT_GT(static_cast<double>(info.restForce.z()), 0.5 * weight);
    EXPECT_LT(static_cast<double>(info.restForce.z()), 1.05 * weight);
    EXPECT_NEAR(static_cast<double>(info.restForce.x()), 0.0, 0.02 * weight);
}

TEST_P(Sleepers, SleepOnWhileNothingChanges)
{
    Dem<float> dem = makeSleeper(GetParam());
    for (int n = 0; n < 3; ++n) {
        dem.recordContacts();
        dem.rebuild(0.0, kStep);
        judgeNewlyFrozen(RestRules(), dem);
        markWoken(RestRules(), dem);
        EXPECT_FALSE(wakes(dem));
    }
}

TEST_P(Sleepers, WakeWhenHit)
{
    Dem<float> dem = makeSleeper(GetParam());
    dem.recordContacts();
    addMobile(dem, Vec3(0.0, 0.0, hollowHeight() + 0.011), 1, Vec3(0.0, 0.0, -1.0));
    dem.rebuild(0.0, kStep);
    advance(dem, 0.002);
    markWoken(RestRules(), dem);
    EXPECT_TRUE(wakes(dem));
}

TEST_P(Sleepers, WakeWhenHitThoughTheListsWereMadeAnewSince)
{
    // The hitter has flown away and its contact is over when sleepers are asked.
    Dem<float> dem = makeSleeper(GetParam());
    dem.recordContacts();
    addMobile(dem, Vec3(0.0, 0.0, hollowHeight() + 0.011), 1, Vec3(0.3, 0.0, -2.0));
    dem.rebuild(0.0, kStep);
    advance(dem, 0.002);
    dem.recordContacts();
    dem.mobile().removeUnless([](std::size_t) { return false; });
    dem.rebuild(0.0, kStep);
    markWoken(RestRules(), dem);
    EXPECT_TRUE(wakes(dem));
}

TEST_P(Sleepers, WakeWhenTheirSupportGoes)
{
    // One of four under a load of several weights; all of them under none.
    for (const std::uint32_t gone : {1u, 4u}) {
        Dem<float> dem = makeSleeper(GetParam(), gone == 1 ? 4.0 : 1.0);
        dem.recordContacts();
        dem.frozen().removeUnless([&](std::size_t k) {
            return dem.frozen().record(k).id < 100 || dem.frozen().record(k).id >= 100 + gone;
        });
        dem.rebuild(0.0, kStep);
        judgeNewlyFrozen(RestRules(), dem);
        markWoken(RestRules(), dem);
        EXPECT_TRUE(wakes(dem)) << gone << " supports gone";
    }
}

TEST_P(Sleepers, WakeUnderANewLoad)
{
    Dem<float> dem = makeSleeper(GetParam());
    const GrainRecord<float> sleeper =
        dem.frozen().record(static_cast<std::size_t>(frozenIndex(dem, 0)));
    // A grain pressed on it from above, as deep as the sleeper is into its own supports at rest.
    dem.recordContacts();
    const double sink = 3.0 * (hollowHeight() - sleeper.z);
    ASSERT_GT(sink, 0.0);
    addMobile(dem, positionOf(sleeper) + Vec3(0.0, 0.0, 2.0 * kRadius - sink), 1);
    dem.rebuild(0.0, kStep);
    markWoken(RestRules(), dem);
    EXPECT_TRUE(wakes(dem));
}

INSTANTIATE_TEST_SUITE_P(AllLaws, Sleepers,
                         ::testing::Values(NormalLaw::linear, NormalLaw::hertz,
                                           NormalLaw::bellYuMucha));

TEST(InterfaceGrains, AreStruckLooseByAnImpactOnly)
{
    // A grain at v strikes with about v sqrt(k m): 0.2 N at 0.1 m/s, 6 N at 3 m/s. Loose from 50
    // weights: 0.67 N.
    for (const double speed : {0.1, 3.0}) {
        Dem<float> dem(makeSetup());
        const RestRules rules;
        dem.recordContacts();
        addFrozen(dem, Vec3::Zero(), 0);
        addMobile(dem, Vec3(0.0, 0.0, 2.0 * kRadius + 1e-5), 1, Vec3(0.0, 0.0, -speed));
        dem.rebuild(0.0, kStep);
        judgeNewlyFrozen(rules, dem);
        advance(dem, 0.002);
        EXPECT_GT(dem.deepestOverlap(), 1e-5) << "it must have hit";
        markWoken(rules, dem);
        EXPECT_EQ(dem.frozen().info(0).wakes, speed > 1.0) << speed << " m/s";
    }
}

TEST(InterfaceGrains, AddedBetweenTransfersAreNotWokenByATouch)
{
    // Settled sand enters at any time and may be touched before it is judged.
    Dem<float> dem(makeSetup());
    dem.recordContacts();
    addFrozen(dem, Vec3::Zero(), 0);
    addMobile(dem, Vec3(0.0, 0.0, 2.0 * kRadius - 1e-5), 1);
    dem.rebuild(0.0, kStep);
    advance(dem, 0.002);
    markWoken(RestRules(), dem);
    EXPECT_FALSE(dem.frozen().info(0).wakes);
}

}  // namespace
}  // namespace sandflow
