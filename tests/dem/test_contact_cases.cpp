#include "contact_rig.h"
#include "dem/restitution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

/// Normal contact against published cases: Chung & Ooi 2011 (tests 1-3) and Garg et al. 2012
/// (cases 1 and 3).
namespace sandflow {
namespace {

using rig::Ball;
using rig::Real3;
using rig::Touch;

/// K = (4/3) E* of two grains of one material; against a rigid plane twice that.
double pairStiffness(double young, double poisson)
{
    return 4.0 / 3.0 * young / (2.0 * (1.0 - poisson * poisson));
}

ContactCoefficients elasticHertz(double stiffness)
{
    ContactCoefficients law;
    law.law = NormalLaw::hertz;
    law.stiffness = stiffness;
    return law;
}

ContactCoefficients linearLaw(double stiffness, double e, bool clip)
{
    ContactCoefficients law;
    law.clipAttraction = clip;
    law.stiffness = stiffness;
    law.damping = solveDamping(NormalLaw::linear, clip, e);
    return law;
}

TEST(ContactCases, TwoElasticSpheresOfGlassAndLimestone)
{
    struct Case {
        double young, poisson, density, overlap, force, duration;
    };
    for (const Case& c : {Case{48e9, 0.20, 2800.0, 274.1e-6, 10.697e3, 40.34e-6},
                          Case{20e9, 0.25, 2500.0, 368.3e-6, 7.108e3, 54.20e-6}}) {
        const ContactCoefficients law = elasticHertz(pairStiffness(c.young, c.poisson));
        Ball a = rig::makeBall(0.01, c.density);
        Ball b = a;
        b.position.z = 0.02;
        a.velocity.z = 10.0;
        b.velocity.z = -10.0;
        Touch contact;
        const double dt = c.duration / 1e4;
        double duration = 0.0;
        do {
            rig::stepPair(law, a, b, contact, dt);
            duration += dt;
        } while (b.position.z - a.position.z < 0.02);
        EXPECT_NEAR(contact.peakOverlap, c.overlap, 0.005 * c.overlap);
        EXPECT_NEAR(contact.peakForce, c.force, 0.005 * c.force);
        EXPECT_NEAR(duration, c.duration, 0.005 * c.duration);
        EXPECT_NEAR(b.velocity.z, 10.0, 1e-3);
        EXPECT_NEAR(a.velocity.z + b.velocity.z, 0.0, 1e-12);
        EXPECT_NEAR(integratePeakOverlap(law, 0.5 * a.mass, 0.005, 20.0), c.overlap,
                    0.001 * c.overlap);
    }
}

TEST(ContactCases, ElasticSphereOnARigidPlane)
{
    struct Case {
        double young, poisson, density, overlap, force, duration;
    };
    for (const Case& c : {Case{70e9, 0.30, 2699.0, 49.72e-6, 11.370e3, 731.7e-6},
                          Case{40e9, 0.35, 1800.0, 52.12e-6, 7.233e3, 767.1e-6}}) {
        const ContactCoefficients law = elasticHertz(2.0 * pairStiffness(c.young, c.poisson));
        Ball ball = rig::makeBall(0.1, c.density);
        ball.position.z = ball.radius;
        ball.velocity.z = -0.2;
        Touch contact;
        const double duration = rig::hitPlane(law, ball, contact, c.duration / 1e4);
        EXPECT_NEAR(contact.peakOverlap, c.overlap, 0.005 * c.overlap);
        EXPECT_NEAR(contact.peakForce, c.force, 0.005 * c.force);
        EXPECT_NEAR(duration, c.duration, 0.005 * c.duration);
    }
}

TEST(ContactCases, ReboundFromAPlaneAtTheGivenRestitution)
{
    // Aluminium oxide and cast iron at 3.9 m/s.
    for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        for (const bool clip : {true, false}) {
            struct Material {
                double young, poisson, density;
            };
            for (const Material& m :
                 {Material{380e9, 0.23, 4000.0}, Material{100e9, 0.25, 7000.0}}) {
                ContactCoefficients law = elasticHertz(2.0 * pairStiffness(m.young, m.poisson));
                law.clipAttraction = clip;
                law.damping = solveDamping(NormalLaw::hertz, clip, e);
                Ball ball = rig::makeBall(0.0025, m.density);
                ball.position.z = ball.radius;
                ball.velocity.z = -3.9;
                Touch contact;
                rig::hitPlane(law, ball, contact, 8.1e-9);
                EXPECT_NEAR(ball.velocity.z / 3.9, e, 0.005) << e << " clip " << clip;
            }
        }
    }
}

TEST(ContactCases, DropOnAFloorWithWeight)
{
    struct Case {
        double stiffness, e, lowest, duration, rebound;
    };
    for (const Case& c : {Case{1e4, 0.9, 0.00161, 0.1118, 2.476},
                          Case{1e4, 0.6, 0.01803, 0.1157, 1.492},
                          Case{5e4, 0.9, 0.05868, 0.0480, 2.502},
                          Case{1e5, 1.0, 0.06968, 0.03355, 2.8014}}) {
        const ContactCoefficients law = linearLaw(c.stiffness, c.e, false);
        Ball ball = rig::makeBall(0.1, 2600.0);
        ball.position.z = 0.5;
        const double dt = 2e-6;
        const Real3 up{0.0, 0.0, 1.0};
        const Real3 weight{0.0, 0.0, -9.81};
        Touch contact;
        double lowest = 1.0;
        double duration = 0.0;
        double fall = 0.0;
        while (ball.position.z >= ball.radius) {
            rig::stepOnPlane(law, ball, contact, up, weight, dt);
            fall += dt;
        }
        EXPECT_NEAR(fall, 0.28557, 2e-5);
        EXPECT_NEAR(ball.velocity.z, -2.8014, 2e-4);
        while (ball.position.z < ball.radius) {
            rig::stepOnPlane(law, ball, contact, up, weight, dt);
            duration += dt;
            lowest = std::min(lowest, ball.position.z);
        }
        EXPECT_NEAR(lowest, c.lowest, 2e-5);
        EXPECT_NEAR(duration, c.duration, 1e-4);
        EXPECT_NEAR(ball.velocity.z, c.rebound, 1e-3);
    }
}

TEST(ContactCases, TwoStackedSpheresBetweenFloorAndCeiling)
{
    // R = 0.5 mm, box 1.8 mm high, densities 20000 (lower) and 10000; both pressed. Heights in mm.
    const ContactCoefficients law = linearLaw(1000.0, 1.0, false);
    const double dt = 1e-8;
    Ball lower = rig::makeBall(0.5e-3, 20000.0);
    Ball upper = rig::makeBall(0.5e-3, 10000.0);
    lower.position.z = 0.45e-3;
    upper.position.z = 1.35e-3;
    const double box = 1.8e-3;
    const auto energy = [&]() {
        const auto spring = [](double overlap) {
            return overlap > 0.0 ? 500.0 * overlap * overlap : 0.0;
        };
        return lower.kineticEnergy() + upper.kineticEnergy()
               + 9.81 * (lower.mass * lower.position.z + upper.mass * upper.position.z)
               + spring(0.5e-3 - lower.position.z) + spring(upper.position.z + 0.5e-3 - box)
               + spring(1e-3 - (upper.position.z - lower.position.z));
    };
    const double before = energy();
    Touch floor;
    Touch ceiling;
    Touch between;
    struct Mark {
        int step;
        double lower, upper;
    };
    const Mark marks[] = {{10000, 0.43267, 1.38139}, {50000, 0.43624, 1.37914},
                          {100000, 0.42713, 1.38355}};
    std::size_t next = 0;
    for (int step = 1; step <= 100000; ++step) {
        rig::Push onLower;
        rig::Push onUpper;
        rig::touch(law, dt, {0.0, 0.0, -1.0}, lower.radius - lower.position.z, lower, nullptr,
                   floor, onLower, nullptr);
        rig::touch(law, dt, {0.0, 0.0, 1.0}, upper.position.z + upper.radius - box, upper, nullptr,
                   ceiling, onUpper, nullptr);
        rig::touch(law, dt, {0.0, 0.0, 1.0},
                   lower.radius + upper.radius - (upper.position.z - lower.position.z), lower,
                   &upper, between, onLower, &onUpper);
        rig::move(lower, onLower, {0.0, 0.0, -9.81}, dt);
        rig::move(upper, onUpper, {0.0, 0.0, -9.81}, dt);
        if (step == 17000) {
            EXPECT_NEAR(1e3 * lower.position.z, 0.42334, 1e-4);
        }
        if (next < 3 && step == marks[next].step) {
            EXPECT_NEAR(1e3 * lower.position.z, marks[next].lower, 5e-5) << step;
            EXPECT_NEAR(1e3 * upper.position.z, marks[next].upper, 1.4e-4) << step;
            ++next;
        }
    }
    EXPECT_NEAR(energy(), before, 2e-4 * before);
}

}  // namespace
}  // namespace sandflow
