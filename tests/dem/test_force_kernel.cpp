#include "dem/contact_pair.h"
#include "dem/kernel_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sandflow {
namespace {

using rig::KernelRig;
using rig::makeLaw;
using rig::positionOf;
using rig::spinOf;
using rig::velocityOf;

Vec<double> plain(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}
Vec3 eigen(const Vec<double>& v)
{
    return Vec3(v.x, v.y, v.z);
}

/// Two balls by the formulas of contact_law.h, in double, with geometry written out here.
template <NormalLaw law>
struct TwoBalls {
    LawNumbers<double> numbers;
    double radius[2], mass[2];
    Vec3 position[2], velocity[2], spin[2];
    Vec3 slide = Vec3::Zero(), roll = Vec3::Zero();  ///< springs, m

    void step(double dt)
    {
        const Vec3 apart = position[0] - position[1];
        const double overlap = radius[0] + radius[1] - apart.norm();
        Vec3 force = Vec3::Zero(), torque[2] = {Vec3::Zero(), Vec3::Zero()};
        if (overlap > 0.0) {
            const Vec3 n = apart.normalized();
            const double arm[2] = {radius[0] - overlap / 2, radius[1] - overlap / 2};
            const double reducedMass = mass[0] * mass[1] / (mass[0] + mass[1]);
            const double reducedRadius = radius[0] * radius[1] / (radius[0] + radius[1]);
            const Vec3 relative = velocity[0] - velocity[1];
            // The contact point lies at -arm n from the first ball, +arm n from the second.
            const Vec3 atPoint = relative + spin[0].cross(-arm[0] * n) - spin[1].cross(arm[1] * n);
            const Vec3 slip = atPoint - n * n.dot(atPoint);
            const auto normal = evaluateNormal<law>(numbers, overlap, -relative.dot(n),
                                                    reducedMass, reducedRadius);
            slide -= n * n.dot(slide);
            const auto tangential =
                evaluateTangential(numbers, plain(slide), plain(slip), normal.force,
                                   normal.tangentStiffness, normal.dashpot, dt);
            slide = eigen(tangential.spring);
            roll -= n * n.dot(roll);
            Vec3 turning = spin[0] - spin[1];
            turning -= n * n.dot(turning);
            const auto rolling = evaluateRolling(
                numbers, plain(roll), plain(reducedRadius * turning), normal.force,
                normal.tangentStiffness, reducedRadius,
                1.4 * reducedMass * radius[0] * radius[1] / (reducedRadius * reducedRadius), dt);
            roll = eigen(rolling.spring);
            force = normal.force * n + eigen(tangential.force);
            torque[0] = (-arm[0] * n).cross(force) + eigen(rolling.torque);
            torque[1] = (arm[1] * n).cross(-force) - eigen(rolling.torque);
        }
        for (int b = 0; b < 2; ++b) {
            velocity[b] += (b == 0 ? dt : -dt) / mass[b] * force;
            spin[b] += dt / (0.4 * mass[b] * radius[b] * radius[b]) * torque[b];
            position[b] += dt * velocity[b];
        }
    }
};

template <class Real, NormalLaw law>
void compareWithTwoBalls(double tolerance)
{
    const ContactCoefficients coefficients = makeLaw(law, true);
    KernelRig<Real> rig(coefficients);
    TwoBalls<law> balls{LawNumbers<double>(coefficients),
                        {0.005, 0.0045},
                        {},
                        {Vec3(0.011, 0.02, 0.03), Vec3(0.0165, 0.0231, 0.0372)},
                        {Vec3(0.4, 0.1, 0.5), Vec3(-0.3, 0.2, -0.6)},
                        {Vec3(20, -35, 8), Vec3(-12, 50, -31)}};
    for (int b = 0; b < 2; ++b) {
        GrainRecord<Real>& g = rig.add(balls.position[b], balls.radius[b]);
        g.vx = Real(balls.velocity[b].x()), g.vy = Real(balls.velocity[b].y()),
        g.vz = Real(balls.velocity[b].z());
        g.wx = Real(balls.spin[b].x()), g.wy = Real(balls.spin[b].y()),
        g.wz = Real(balls.spin[b].z());
        balls.radius[b] = static_cast<double>(g.radius);
        balls.mass[b] = 1.0 / static_cast<double>(g.inverseMass);
    }
    bool touched = false;
    const Vec3 before = balls.velocity[0];
    for (int k = 0; k < 400; ++k) {
        rig.step();
        balls.step(rig.dt);
        touched = touched || rig.reports[0].deepestOverlap > 0;
    }
    EXPECT_TRUE(touched);
    EXPECT_GT((balls.velocity[0] - before).norm(), 0.5);
    for (std::uint32_t b = 0; b < 2; ++b) {
        EXPECT_LT((positionOf(rig.grain(b)) - balls.position[b]).norm(), tolerance * 0.005);
        EXPECT_LT((velocityOf(rig.grain(b)) - balls.velocity[b]).norm(), tolerance);
        EXPECT_LT((spinOf(rig.grain(b)) - balls.spin[b]).norm(), tolerance * 100.0);
    }
}

TEST(ForceKernel, TwoGrainsFollowTheLaw)
{
    compareWithTwoBalls<double, NormalLaw::linear>(1e-11);
    compareWithTwoBalls<double, NormalLaw::hertz>(1e-11);
    compareWithTwoBalls<double, NormalLaw::bellYuMucha>(1e-11);
    compareWithTwoBalls<float, NormalLaw::linear>(2e-4);
    compareWithTwoBalls<float, NormalLaw::hertz>(2e-4);
    compareWithTwoBalls<float, NormalLaw::bellYuMucha>(2e-4);
}

/// 1500 copies of one touching pair, at places that binary numbers hold exactly, and a single grain
/// so that pairs straddle the borders of chunks.
KernelRig<float> makePairs()
{
    KernelRig<float> rig(makeLaw(NormalLaw::hertz, true));
    rig.add(Vec3(-1.0, -1.0, -1.0), 0.005);
    for (int k = 0; k < 1500; ++k) {
        const Vec3 at = 0.0625 * Vec3(k % 16, k / 16 % 16, k / 256);
        for (int b = 0; b < 2; ++b) {
            GrainRecord<float>& g = rig.add(
                at + b * Vec3(0.00390625, 0.0048828125, 0.00634765625), 0.005);
            g.wx = b == 0 ? 11.0f : -3.0f, g.wy = b == 0 ? -24.0f : 31.0f, g.wz = 7.0f;
        }
    }
    return rig;
}

TEST(ForceKernel, ActionIsReactionToTheLastBitAlsoAcrossChunks)
{
    KernelRig<float> rig = makePairs();
    rig.step();
    std::size_t across = 0;
    for (const ChunkContacts<float>& chunk : rig.lists.chunks()) {
        across += chunk.foreign.size();
    }
    EXPECT_GT(across, 0u);
    const GrainRecord<float>& first = rig.grain(1);
    const GrainRecord<float>& second = rig.grain(2);
    EXPECT_GT(velocityOf(first).norm(), 1e-4);
    EXPECT_NE(first.wx, 11.0f);
    for (const GrainRecord<float>& g : rig.mobile.record) {
        if (g.id == 0) {
            EXPECT_EQ(velocityOf(g), Vec3(0, 0, 0));
            continue;
        }
        const GrainRecord<float>& same = g.id % 2 == 1 ? first : second;
        EXPECT_EQ(velocityOf(g), velocityOf(same)) << g.id;
        EXPECT_EQ(spinOf(g), spinOf(same)) << g.id;
        EXPECT_EQ(velocityOf(g), (g.id % 2 == 1 ? 1.0 : -1.0) * velocityOf(first)) << g.id;
    }
}

TEST(ForceKernel, SpringsAcrossChunksStayTheSameSeenFromBothSides)
{
    KernelRig<float> rig = makePairs();
    for (int k = 0; k < 40; ++k) {
        rig.step();
    }
    const Vec3 velocity = velocityOf(rig.grain(1)), spin = spinOf(rig.grain(1));
    for (const GrainRecord<float>& g : rig.mobile.record) {
        if (g.id % 2 == 1) {
            EXPECT_LT((velocityOf(g) - velocity).norm(), 1e-5 * velocity.norm()) << g.id;
            EXPECT_LT((spinOf(g) - spin).norm(), 1e-5 * spin.norm()) << g.id;
        }
    }
}

TEST(ForceKernel, AnIsolatedPairKeepsMomentumAndAngularMomentum)
{
    for (const NormalLaw law : {NormalLaw::linear, NormalLaw::hertz, NormalLaw::bellYuMucha}) {
        KernelRig<double> rig(makeLaw(law, true));
        rig.add(Vec3(0.0, 0.0, 0.0), 0.005).vx = 1.0;
        GrainRecord<double>& heavy = rig.add(Vec3(0.0102, 0.003, -0.001), 0.0058, 5000.0);
        heavy.wz = 40.0, heavy.wy = -25.0;
        const auto total = [&] {
            Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
            for (const GrainRecord<double>& g : rig.mobile.record) {
                momentum += velocityOf(g) / g.inverseMass;
                angular += positionOf(g).cross(velocityOf(g)) / g.inverseMass
                           + 0.4 / g.inverseMass * g.radius * g.radius * spinOf(g);
            }
            return std::pair(momentum, angular);
        };
        const auto before = total();
        const double spinBefore = rig.mobile.record[0].wz;
        for (int k = 0; k < 500; ++k) {
            rig.step();
        }
        const auto after = total();
        EXPECT_GT(std::abs(rig.grain(0).wz - spinBefore), 1.0);
        EXPECT_LT((after.first - before.first).norm(), 1e-12 * before.first.norm());
        EXPECT_LT((after.second - before.second).norm(), 1e-11 * before.second.norm());
    }
}

TEST(ForceKernel, AWallReturnsTheGrainAsTheClosedFormSays)
{
    // Linear, unclipped, frictionless, no gravity: contact lasts pi / wd, and the speed comes back
    // times exp(-beta w pi / wd), with w = sqrt(k / m), wd = w sqrt(1 - beta^2).
    ContactCoefficients law = makeLaw(NormalLaw::linear, false);
    law.clipAttraction = false;
    law.friction = 0.0;
    KernelRig<double> rig(law);
    rig.walls.push_back({});
    rig.dt = 1e-7;
    GrainRecord<double>& g = rig.add(Vec3(0.0, 0.0, 0.005), 0.005);
    g.vz = -0.5;
    const double w = std::sqrt(law.stiffness * g.inverseMass);
    const double wd = w * std::sqrt(1.0 - law.damping * law.damping);
    double time = 0.0;
    do {
        rig.step();
        time += rig.dt;
    } while (rig.mobile.record[0].z < 0.005);
    EXPECT_NEAR(time, kPi / wd, 1e-3 * time);
    EXPECT_NEAR(rig.mobile.record[0].vz, 0.5 * std::exp(-law.damping * w * kPi / wd), 5e-4);
}

TEST(ForceKernel, AGrainSlidingOnAWallEndsRollingAtFiveSevenths)
{
    // u = u0 - mu g t until ts = 2 u0 / (7 mu g), then u = (5/7) u0 = w R.
    KernelRig<double> rig(makeLaw(NormalLaw::linear, false));
    rig.walls.push_back({});
    rig.gravity = Vec3(0.0, 0.0, -9.81);
    rig.dt = 1e-5;
    const double mass = 1.0 / rig.makeRecord(Vec3::Zero(), 0.005, 2600.0, 0).inverseMass;
    const double rest = 0.005 - mass * 9.81 / 2000.0;
    rig.add(Vec3(0.0, 0.0, rest), 0.005).vx = 0.1;
    const double stop = 2.0 * 0.1 / (7.0 * 0.5 * 9.81);
    const int half = static_cast<int>(0.5 * stop / rig.dt);
    for (int k = 0; k < half; ++k) {
        rig.step();
    }
    EXPECT_NEAR(rig.mobile.record[0].vx, 0.1 - 0.5 * 9.81 * half * rig.dt, 2e-4);
    for (int k = 0; k < 3 * half; ++k) {
        rig.step();
    }
    const GrainRecord<double>& g = rig.mobile.record[0];
    EXPECT_NEAR(g.vx, 5.0 / 7.0 * 0.1, 2e-4);
    EXPECT_NEAR(g.wy * 0.005, g.vx, 2e-4);
    EXPECT_NEAR(g.z, rest, 1e-8);
}

TEST(ForceKernel, OnlyTouchingPairsHaveSpringsAndNewOnesStartFromZero)
{
    KernelRig<float> rig(makeLaw(NormalLaw::linear, true));
    rig.add(Vec3(0.0, 0.0, 0.0), 0.005).vx = 0.2f;
    rig.add(Vec3(0.0101, 0.0, 0.0), 0.005);
    rig.rebuild();
    ChunkContacts<float>& contacts = rig.lists.chunks()[0];
    ASSERT_EQ(contacts.own.size(), 1u);
    contacts.ownHistory[0].sy = 123.0f;  // what a pair that does not touch holds means nothing
    rig.step();
    EXPECT_FALSE(contacts.ownLive[0]);
    EXPECT_EQ(contacts.ownHistory[0].sy, 123.0f);
    while (rig.reports[0].deepestOverlap == 0.0f) {
        rig.step();
    }
    EXPECT_TRUE(rig.hold);
    EXPECT_TRUE(contacts.ownLive[0]);
    EXPECT_EQ(contacts.ownHistory[0].sy, 0.0f);
    while (rig.reports[0].deepestOverlap > 0.0f) {
        rig.step();
    }
    EXPECT_FALSE(contacts.ownLive[0]);
}

TEST(ForceKernel, FrozenGrainsPushedBeyondTheirLimitAreReported)
{
    // Both are pressed by k delta = 2000 N/m * 1e-4 m = 0.2 N.
    KernelRig<float> rig(makeLaw(NormalLaw::linear, false));
    rig.add(Vec3(0.0, 0.0, 0.0), 0.005);
    rig.addFrozen(Vec3(0.0099, 0.0, 0.0), 0.005, 1000000, 0.19f);
    rig.addFrozen(Vec3(-0.0099, 0.0, 0.0), 0.005, 1000001, 0.21f);
    rig.step(true);
    ASSERT_EQ(rig.reports[0].wake.size(), 1u);
    EXPECT_EQ(rig.frozen.record(rig.reports[0].wake[0]).id, 1000000u);
    EXPECT_EQ(rig.mobile.load[0].contacts, 2.0f);
    EXPECT_NEAR(rig.mobile.load[0].load, 0.4, 1e-4);
    EXPECT_NEAR(rig.mobile.load[0].netForce, 0.0, 1e-6);
}

TEST(ForceKernel, GrainsOutsideTheirBallEndTheListsAndLostOnesAreReported)
{
    for (const KernelTarget target : availableKernelTargets()) {
        KernelRig<float> rig(makeLaw(NormalLaw::linear, true), target);
        for (int k = 0; k < 40; ++k) {
            rig.add(Vec3(0.03 * k, 0.0, 0.0), 0.005);
        }
        rig.step();
        EXPECT_FALSE(!rig.reports[0].left.empty() || rig.reports[0].broke) << nameOf(target);
        GrainRecord<float>& g = rig.mobile.record[37];
        g.x += 0.001;
        rig.step();
        EXPECT_FALSE(rig.reports[0].left.empty()) << nameOf(target);
        EXPECT_FALSE(rig.reports[0].broke) << nameOf(target);
        rig.rebuild();
        rig.mobile.record[37].y = std::numeric_limits<double>::quiet_NaN();
        rig.step();
        EXPECT_TRUE(rig.reports[0].broke) << nameOf(target);
        EXPECT_EQ(rig.reports[0].brokenGrain, 37u) << nameOf(target);
    }
}

}  // namespace
}  // namespace sandflow
