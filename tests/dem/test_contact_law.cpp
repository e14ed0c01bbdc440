#include "contact_rig.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace sandflow {
namespace {

constexpr NormalLaw kLaws[] = {NormalLaw::linear, NormalLaw::hertz, NormalLaw::bellYuMucha};

ContactCoefficients exampleLaw(NormalLaw law)
{
    ContactCoefficients numbers;
    numbers.law = law;
    numbers.stiffness = law == NormalLaw::linear ? 3e3 : 2e6;
    numbers.damping = law == NormalLaw::bellYuMucha ? 1e-4 : 0.4;
    numbers.friction = 0.5;
    numbers.tangentialRatio = 2.0 / 7.0;
    numbers.tangentialDamping = 0.3;
    numbers.rollingFriction = 0.1;
    numbers.rollingStiffness = 2.25 * 0.01;
    numbers.rollingDamping = 0.3;
    return numbers;
}

TEST(NormalForce, FollowsTheThreeLaws)
{
    const double overlap = 2e-4;
    const double speed = 0.3;
    const double mass = 7e-4;
    const double radius = 2.5e-3;
    {
        const auto law = exampleLaw(NormalLaw::linear);
        const auto normal = evaluateNormal<NormalLaw::linear>(LawNumbers<double>(law), overlap,
                                                              speed, mass, radius);
        const double c = 2.0 * 0.4 * std::sqrt(mass * 3e3);
        EXPECT_NEAR(normal.dashpot, c, 1e-12 * c);
        EXPECT_NEAR(normal.force, 3e3 * overlap + c * speed, 1e-12);
        EXPECT_DOUBLE_EQ(normal.tangentStiffness, 3e3);
    }
    {
        const auto law = exampleLaw(NormalLaw::hertz);
        const auto normal = evaluateNormal<NormalLaw::hertz>(LawNumbers<double>(law), overlap,
                                                             speed, mass, radius);
        const double stiffness = 1.5 * 2e6 * std::sqrt(radius * overlap);
        const double c = 0.4 * std::sqrt(stiffness * mass);
        EXPECT_NEAR(normal.tangentStiffness, stiffness, 1e-12 * stiffness);
        EXPECT_NEAR(normal.dashpot, c, 1e-12 * c);
        EXPECT_NEAR(normal.force, 2e6 * std::sqrt(radius) * std::pow(overlap, 1.5) + c * speed,
                    1e-12);
    }
    {
        const auto law = exampleLaw(NormalLaw::bellYuMucha);
        const auto normal = evaluateNormal<NormalLaw::bellYuMucha>(
            LawNumbers<double>(law), overlap, speed, mass, radius);
        const double c = 1e-4 * 2e6 * std::sqrt(radius * overlap);
        EXPECT_NEAR(normal.dashpot, c, 1e-12 * c);
        EXPECT_NEAR(normal.force, 2e6 * std::sqrt(radius) * std::pow(overlap, 1.5) + c * speed,
                    1e-12);
    }
}

TEST(NormalForce, TangentStiffnessIsTheSlopeOfTheForce)
{
    for (const NormalLaw kind : kLaws) {
        const LawNumbers<double> numbers(exampleLaw(kind));
        for (const double overlap : {1e-6, 1e-5, 1e-4, 1e-3}) {
            const double h = 1e-4 * overlap;
            const auto force = [&](double at) {
                return rig::evaluateNormalOf(kind, numbers, at, 0.0, 1e-3, 2e-3).force;
            };
            const double slope = (force(overlap + h) - force(overlap - h)) / (2.0 * h);
            const double stiffness =
                rig::evaluateNormalOf(kind, numbers, overlap, 0.0, 1e-3, 2e-3).tangentStiffness;
            EXPECT_NEAR(stiffness, slope, 1e-7 * slope);
        }
    }
}

TEST(NormalForce, NeverPullsWhenClippedAndPullsOtherwise)
{
    for (const NormalLaw kind : kLaws) {
        ContactCoefficients law = exampleLaw(kind);
        const auto forceAt = [&](double speed) {
            return rig::evaluateNormalOf(kind, LawNumbers<double>(law), 1e-5, speed, 1e-3, 2e-3)
                .force;
        };
        EXPECT_EQ(forceAt(-5.0), 0.0);
        EXPECT_GT(forceAt(0.0), 0.0);
        law.clipAttraction = false;
        EXPECT_LT(forceAt(-5.0), 0.0);
    }
}

TEST(TangentialForce, SpringAndDashpotBelowTheCap)
{
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    const Vec<double> spring{1e-6, -2e-6, 0.0};
    const Vec<double> slip{1e-3, 2e-3, 0.0};
    const double dt = 1e-5;
    const auto result = evaluateTangential(numbers, spring, slip, 1.0, 3e3, 2.0, dt);
    const double kt = 3e3 * 2.0 / 7.0;
    const double ct = 0.6;
    EXPECT_NEAR(result.spring.x, 1e-6 + 1e-8, 1e-20);
    EXPECT_NEAR(result.spring.y, -2e-6 + 2e-8, 1e-20);
    EXPECT_NEAR(result.force.x, -(kt * 1.01e-6 + ct * 1e-3), 1e-15);
    EXPECT_NEAR(result.force.y, -(kt * -1.98e-6 + ct * 2e-3), 1e-15);
    EXPECT_EQ(result.force.z, 0.0);
}

TEST(TangentialForce, CapsAtCoulombAndShortensTheSpring)
{
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    const Vec<double> slip{0.3, -0.4, 0.0};
    const double normalForce = 0.8;
    const Vec<double> spring{1e-3, -2e-3, 0.0};
    const auto result =
        evaluateTangential(numbers, spring, slip, normalForce, 3e3, 0.7, 1e-5);
    EXPECT_NEAR(length(result.force), 0.5 * normalForce, 1e-14);
    EXPECT_LT(dot(result.force, slip), 0.0);
    EXPECT_LT(length(result.spring), length(spring));
    EXPECT_GT(dot(result.spring, spring), 0.0);
}

TEST(TangentialForce, SteadySlidingSettlesAtTheSpringThatGivesTheCap)
{
    // s = (mu Fn - ct v) / kt along the slip, whatever the spring was before.
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    const Vec<double> slip{0.5, 0.0, 0.0};
    const double kt = 3e3 * 2.0 / 7.0;
    const double ct = 0.3 * 0.7;
    for (const Vec<double>& start : {Vec<double>{}, Vec<double>{0.0, 1e-2, 0.0},
                                     Vec<double>{-1e-3, 0.0, 0.0}}) {
        Tangential<double> result{{}, start};
        for (int i = 0; i < 100000; ++i) {
            result = evaluateTangential(numbers, result.spring, slip, 0.8, 3e3, 0.7, 1e-7);
        }
        EXPECT_NEAR(result.spring.x, (0.5 * 0.8 - ct * 0.5) / kt, 2e-3 * result.spring.x);
        EXPECT_NEAR(result.spring.y, 0.0, 1e-9);
        EXPECT_NEAR(result.force.x, -0.5 * 0.8, 1e-9);
    }
}

TEST(TangentialForce, FastSlidingNeverTurnsTheSpringAgainstTheSlip)
{
    // The dashpot alone exceeds the cap; a spring pointing backwards would push later.
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    Tangential<double> result{};
    for (int i = 0; i < 1000; ++i) {
        result = evaluateTangential(numbers, result.spring, Vec<double>{20.0, 0.0, 0.0}, 0.8, 3e3,
                                    0.7, 1e-6);
        EXPECT_GE(result.spring.x, 0.0);
        EXPECT_NEAR(result.force.x, -0.4, 1e-12);
    }
}

TEST(TangentialForce, VanishesFinitelyWithoutFrictionLoadOrStiffness)
{
    const Vec<double> slip{0.3, 0.0, 0.0};
    const auto expectNone = [&](const ContactCoefficients& law, double force, double stiffness) {
        const auto result = evaluateTangential(LawNumbers<double>(law), Vec<double>{}, slip, force,
                                               stiffness, 0.5, 1e-5);
        EXPECT_EQ(length(result.force), 0.0);
        EXPECT_TRUE(std::isfinite(length(result.spring)));
    };
    ContactCoefficients law = exampleLaw(NormalLaw::linear);
    expectNone(law, 0.0, 3e3);
    expectNone(law, -1.0, 3e3);
    law.friction = 0.0;
    expectNone(law, 1.0, 3e3);
    law.friction = 0.5;
    law.tangentialRatio = 0.0;
    law.tangentialDamping = 0.0;
    expectNone(law, 1.0, 3e3);
    law.tangentialRatio = 0.3;
    expectNone(law, 1.0, 0.0);
}

TEST(RollingTorque, SpringAndDashpotBelowTheCap)
{
    const ContactCoefficients law = exampleLaw(NormalLaw::linear);
    const LawNumbers<double> numbers(law);
    const double radius = 2.5e-3;
    const double inertia = 1.2e-8;
    const double angle = 1e-3;
    const double rate = 0.2;
    const auto result = evaluateRolling(numbers, {0.0, radius * angle, 0.0},
                                        {0.0, radius * rate, 0.0}, 1.0, 3e3, radius,
                                        inertia / (radius * radius), 0.0);
    // M = -kr theta - Cr omega with kr = 2.25 mu_r^2 S R*^2 and Cr = 2 eta_r sqrt(Ir kr)
    const double kr = 2.25 * 0.01 * 3e3 * radius * radius;
    const double cr = 2.0 * 0.3 * std::sqrt(inertia * kr);
    EXPECT_NEAR(result.torque.y, -(kr * angle + cr * rate), 1e-18);
    EXPECT_EQ(result.torque.x, 0.0);
    EXPECT_DOUBLE_EQ(result.spring.y, radius * angle);
}

TEST(RollingTorque, IsPlasticAtFullMobilisationWithTheDashpotOff)
{
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    const double radius = 2.5e-3;
    const double force = 0.02;
    for (const double rate : {0.1, 10.0, 1000.0}) {
        const auto result = evaluateRolling(numbers, {radius * 0.5, 0.0, 0.0},
                                            {radius * rate, 0.0, 0.0}, force, 3e3, radius,
                                            1.2e-8 / (radius * radius), 1e-5);
        EXPECT_NEAR(result.torque.x, -0.1 * radius * force, 1e-18);
        // The kept spring carries just the cap: s = mu_r Fn / (kr / R*^2).
        EXPECT_NEAR(result.spring.x, 0.1 * force / (2.25 * 0.01 * 3e3), 1e-18);
    }
}

TEST(RollingTorque, NeverExceedsTheCapWhileTheSpringIsShort)
{
    const LawNumbers<double> numbers(exampleLaw(NormalLaw::linear));
    const double radius = 2.5e-3;
    const auto result = evaluateRolling(numbers, Vec<double>{}, {radius * 300.0, 0.0, 0.0}, 0.02,
                                        3e3, radius, 1.2e-8 / (radius * radius), 1e-9);
    EXPECT_NEAR(result.torque.x, -0.1 * radius * 0.02, 1e-18);
    EXPECT_NEAR(result.spring.x, radius * 300.0 * 1e-9, 1e-18);
}

TEST(RollingTorque, IsZeroWithoutRollingFriction)
{
    ContactCoefficients law = exampleLaw(NormalLaw::linear);
    law.rollingFriction = law.rollingStiffness = law.rollingDamping = 0.0;
    const auto result = evaluateRolling(LawNumbers<double>(law), Vec<double>{}, {1.0, 2.0, 3.0},
                                        1.0, 3e3, 2.5e-3, 1.9e-3, 1e-5);
    EXPECT_EQ(length(result.torque), 0.0);
    EXPECT_EQ(law.rollingLaw(), RollingLaw::none) << "and no kernel has it";
    law.rollingFriction = 0.1;
    EXPECT_EQ(law.rollingLaw(), RollingLaw::spring);
    law.rollingDamping = 0.3;
    EXPECT_EQ(law.rollingLaw(), RollingLaw::springAndDashpot);
}

TEST(InverseRoot, IsAccurateToAFewUnitsOverAllMagnitudes)
{
    double worst = 0.0;
    for (float x = 1e-30f; x < 1e30f; x *= 1.0371f) {
        const double exact = 1.0 / std::sqrt(static_cast<double>(x));
        worst = std::max(worst, std::abs(static_cast<double>(inverseRoot(x)) / exact - 1.0));
        EXPECT_NEAR(static_cast<double>(root(x)) * exact, 1.0, 4e-7);
    }
    EXPECT_LT(worst, 4e-7);
    EXPECT_GT(worst, 0.0) << "floats cannot be exact throughout";
    EXPECT_EQ(root(0.0f), 0.0f);
    EXPECT_TRUE(std::isfinite(inverseRoot(0.0f)));
    EXPECT_TRUE(std::isnan(root(std::numeric_limits<float>::quiet_NaN())));
}

TEST(ContactLaw, SinglePrecisionAgreesWithDouble)
{
    for (const NormalLaw kind : kLaws) {
        const ContactCoefficients law = exampleLaw(kind);
        const LawNumbers<float> low(law);
        const LawNumbers<double> high(law);
        const auto compare = [&](auto kindTag) {
            constexpr NormalLaw kLaw = decltype(kindTag)::value;
            const auto a = evaluateNormal<kLaw>(low, 1e-4f, 0.1f, 7e-4f, 2.5e-3f);
            const auto b = evaluateNormal<kLaw>(high, 1e-4, 0.1, 7e-4, 2.5e-3);
            EXPECT_NEAR(a.force, b.force, 1e-6 * b.force);
            const auto ta = evaluateTangential(low, Vec<float>{1e-5f, 0.0f, 0.0f},
                                               Vec<float>{0.1f, 0.2f, 0.0f}, a.force,
                                               a.tangentStiffness, a.dashpot, 1e-5f);
            const auto tb = evaluateTangential(high, Vec<double>{1e-5, 0.0, 0.0},
                                               Vec<double>{0.1, 0.2, 0.0}, b.force,
                                               b.tangentStiffness, b.dashpot, 1e-5);
            EXPECT_NEAR(ta.force.x, tb.force.x, 2e-6 * b.force);
            EXPECT_NEAR(ta.force.y, tb.force.y, 2e-6 * b.force);
        };
        switch (kind) {
        case NormalLaw::linear:
            compare(std::integral_constant<NormalLaw, NormalLaw::linear>{});
            break;
        case NormalLaw::hertz:
            compare(std::integral_constant<NormalLaw, NormalLaw::hertz>{});
            break;
        case NormalLaw::bellYuMucha:
            compare(std::integral_constant<NormalLaw, NormalLaw::bellYuMucha>{});
            break;
        }
    }
}

}  // namespace
}  // namespace sandflow
