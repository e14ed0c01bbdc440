#include "dem/restitution.h"

#include "contact_rig.h"
#include "core/errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sandflow {
namespace {

constexpr NormalLaw kLaws[] = {NormalLaw::linear, NormalLaw::hertz, NormalLaw::bellYuMucha};

double normalDamping(double restitution)
{
    const double decay = std::log(restitution);
    return -decay / std::sqrt(kPi * kPi + decay * decay);
}

/// Thornton et al. 2013: gamma_T of the clipped Hertz law, fitted as a polynomial of e.
double thorntonDamping(double e)
{
    constexpr double h[] = {-6.918798, -16.41105, 146.8049,  -796.4559, 2928.711,
                            -7206.864, 11494.29,  -11342.18, 6276.757,  -1489.915};
    double alpha = 0.0;
    for (int i = 9; i >= 0; --i) {
        alpha = e * (h[i] + alpha);
    }
    return std::sqrt(1.0 / (1.0 - (1.0 + e) * (1.0 + e) * std::exp(alpha)) - 1.0);
}

/// A law with damping for restitution e of a pair of 1 g, R* = 2.5 mm at 1 m/s.
ContactCoefficients lawFor(NormalLaw kind, bool clip, double e)
{
    ContactCoefficients law;
    law.law = kind;
    law.clipAttraction = clip;
    law.stiffness = kind == NormalLaw::linear ? 1e4 : 1e7;
    law.damping = solveDamping(kind, clip, e);
    if (kind == NormalLaw::bellYuMucha) {
        law.damping *= collisionLength(kind, law.stiffness, 1e-3, 2.5e-3, 1.0);
    }
    return law;
}

TEST(Restitution, IntegratedCollisionGivesBackWhatTheDampingWasSolvedFor)
{
    for (const NormalLaw kind : kLaws) {
        for (const bool clip : {true, false}) {
            for (const double e : {0.01, 0.1, 0.3, 0.5, 0.8, 0.95, 1.0}) {
                const ContactCoefficients law = lawFor(kind, clip, e);
                EXPECT_NEAR(integrateRestitution(law, 1e-3, 2.5e-3, 1.0), e, 1e-9)
                    << static_cast<int>(kind) << " clip " << clip;
            }
        }
    }
}

TEST(Restitution, SteppedCollisionOfTheKernelsLawAgrees)
{
    for (const NormalLaw kind : kLaws) {
        for (const bool clip : {true, false}) {
            for (const double e : {0.1, 0.3, 0.6, 0.9, 1.0}) {
                ContactCoefficients law = lawFor(kind, clip, e);
                rig::Ball ball;
                ball.radius = 2.5e-3;
                ball.mass = 1e-3;
                ball.position.z = ball.radius;
                ball.velocity.z = -1.0;
                rig::Touch contact;
                const double length = collisionLength(kind, law.stiffness, 1e-3, 2.5e-3, 1.0);
                rig::hitPlane(law, ball, contact, length / 2000.0);
                EXPECT_NEAR(ball.velocity.z, e, 0.002)
                    << static_cast<int>(kind) << " clip " << clip;
                EXPECT_NEAR(contact.peakOverlap,
                            integratePeakOverlap(law, 1e-3, 2.5e-3, 1.0),
                            2e-3 * contact.peakOverlap);
            }
        }
    }
}

TEST(Restitution, LinearUnclippedMatchesTheDampedOscillator)
{
    for (const double e : {0.1, 0.3, 0.6, 0.9}) {
        const double beta = normalDamping(e);
        EXPECT_DOUBLE_EQ(solveDamping(NormalLaw::linear, false, e), beta);
        const Collision collision = integrateCollision(NormalLaw::linear, false, beta);
        EXPECT_NEAR(collision.duration, kPi / std::sqrt(1.0 - beta * beta), 1e-9);
        EXPECT_NEAR(collision.restitution, e, 1e-10);
    }
}

TEST(Restitution, LinearClippedMatchesSchwagerAndPoeschel)
{
    for (const double beta : {0.05, 0.3, 0.7, 0.9999999, 1.0, 1.0000001, 1.5, 4.0}) {
        const Collision collision = integrateCollision(NormalLaw::linear, true, beta);
        EXPECT_NEAR(collision.restitution, clippedLinearRestitution(beta), 1e-9) << beta;
        // The turn comes half way in the exponent, so the peak overlap is the root of e.
        EXPECT_NEAR(collision.peakOverlap, std::sqrt(collision.restitution), 1e-9) << beta;
        if (beta < 0.999) {
            EXPECT_NEAR(collision.duration,
                        2.0 * std::acos(beta) / std::sqrt(1.0 - beta * beta), 1e-9);
        }
    }
    // Clipping the attraction of a dashpot made for e = 0.3 without it gives 0.39.
    EXPECT_NEAR(clippedLinearRestitution(normalDamping(0.3)), 0.39, 0.01);
}

TEST(Restitution, HertzClippedMatchesThorntonsPolynomial)
{
    // c = 2 gamma_T sqrt(S m*), hence beta = 2 gamma_T. The fit is good to a few 1e-4 of e.
    for (const double e : {0.2, 0.3, 0.5, 0.8}) {
        const double fitted = 2.0 * thorntonDamping(e);
        EXPECT_NEAR(solveDamping(NormalLaw::hertz, true, e), fitted, 2e-3 * fitted) << e;
        EXPECT_NEAR(integrateCollision(NormalLaw::hertz, true, fitted).restitution, e, 3e-4);
    }
}

TEST(Restitution, HertzUnclippedMapsOntoTheLinearOscillator)
{
    // Antypov & Elliott 2011: c = 2 sqrt(5/6) beta_lin sqrt(Sn m*), Sn = S.
    for (const double e : {0.05, 0.3, 0.5, 0.8, 0.95}) {
        const double beta = 2.0 * std::sqrt(5.0 / 6.0) * normalDamping(e);
        EXPECT_DOUBLE_EQ(solveDamping(NormalLaw::hertz, false, e), beta);
        EXPECT_NEAR(integrateCollision(NormalLaw::hertz, false, beta).restitution, e, 1e-9);
    }
    // The same damping clipped.
    const auto clipped = [](double e) {
        return integrateCollision(NormalLaw::hertz, true,
                                  2.0 * std::sqrt(5.0 / 6.0) * normalDamping(e))
            .restitution;
    };
    EXPECT_NEAR(clipped(0.3), 0.397, 1e-3);
    EXPECT_NEAR(clipped(0.5), 0.550, 1e-3);
    EXPECT_NEAR(clipped(0.8), 0.808, 1e-3);
}

TEST(Restitution, ElasticHertzCollisionHasTheClassicalDepthAndDuration)
{
    const Collision collision = integrateCollision(NormalLaw::hertz, true, 0.0);
    EXPECT_NEAR(collision.peakOverlap, std::pow(1.25, 0.4), 1e-10);
    EXPECT_NEAR(collision.duration, 2.943 * collision.peakOverlap, 1e-3);
    EXPECT_NEAR(collision.restitution, 1.0, 1e-10);
}

TEST(Restitution, DependsOnSpeedOnlyForBellYuMucha)
{
    for (const NormalLaw kind : {NormalLaw::linear, NormalLaw::hertz}) {
        const ContactCoefficients law = lawFor(kind, true, 0.4);
        EXPECT_DOUBLE_EQ(integrateRestitution(law, 1e-3, 2.5e-3, 0.01),
                         integrateRestitution(law, 5e-3, 1e-3, 10.0));
    }
    const ContactCoefficients law = lawFor(NormalLaw::bellYuMucha, true, 0.4);
    const double slow = integrateRestitution(law, 1e-3, 2.5e-3, 0.1);
    const double fast = integrateRestitution(law, 1e-3, 2.5e-3, 10.0);
    EXPECT_GT(slow, 0.4 + 0.05);
    EXPECT_LT(fast, 0.4 - 0.05);
}

TEST(Restitution, OverdampedUnclippedPairsCreepApart)
{
    for (const NormalLaw kind : {NormalLaw::linear, NormalLaw::hertz}) {
        const Collision collision = integrateCollision(kind, false, 2.5);
        EXPECT_EQ(collision.restitution, 0.0);
        EXPECT_TRUE(std::isinf(collision.duration));
        EXPECT_GT(collision.peakOverlap, 0.1);
    }
}

TEST(Restitution, RefusesWhatNoDampingCanGive)
{
    for (const double e : {-0.1, 0.0, 0.001, 1.0001, std::nan("")}) {
        EXPECT_THROW(solveDamping(NormalLaw::linear, true, e), InputError) << e;
        EXPECT_THROW(solveDamping(NormalLaw::hertz, false, e), InputError) << e;
    }
}

}  // namespace
}  // namespace sandflow
