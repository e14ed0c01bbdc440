#include "dem/stable_step.h"

#include "core/errors.h"
#include "crystal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sandflow {
namespace {

using rig::Crystal;
using rig::crystalLimit;
using rig::Lattice;

/// Unclipped linear law of unit stiffness for grains of unit mass.
ContactCoefficients unitLaw(double beta, double ratio, double tangentialDamping,
                            double rollingFriction = 0.0)
{
    ContactCoefficients law;
    law.clipAttraction = false;
    law.stiffness = 1.0;
    law.damping = beta;
    law.friction = 1e9;
    law.tangentialRatio = ratio;
    law.tangentialDamping = tangentialDamping;
    law.rollingFriction = rollingFriction;
    law.rollingStiffness = 2.25 * rollingFriction * rollingFriction;
    law.rollingDamping = rollingFriction > 0.0 ? 0.3 : 0.0;
    return law;
}

double betaOf(double e)
{
    const double decay = std::log(e);
    return -decay / std::sqrt(kPi * kPi + decay * decay);
}

double least(const ModeBounds& modes)
{
    return std::min({modes.translation, modes.rotation, modes.rolling});
}

/// Laws whose worst mode is translation, rotation or rolling.
std::vector<ContactCoefficients> variedLaws()
{
    return {unitLaw(betaOf(0.3), 2.0 / 7.0, 0.5), unitLaw(betaOf(0.3), 2.0 / 7.0, 0.0),
            unitLaw(betaOf(0.3), 2.0 / 7.0, 0.2, 0.1), unitLaw(0.497, 2.0 / 7.0, 0.2, 0.1),
            unitLaw(betaOf(0.9), 2.0 / 7.0, 1.0), unitLaw(betaOf(0.3), 0.8, 0.5),
            unitLaw(0.0, 0.8, 0.0), unitLaw(0.497, 2.0 / 7.0, 0.0, 0.5)};
}

TEST(StableStep, SymplecticEulerIsStableJustUpToTheBound)
{
    for (const double w2 : {0.0, 0.5, 4.0}) {
        for (const double c : {0.0, 0.3, 3.0}) {
            if (w2 + c == 0.0) {
                EXPECT_TRUE(std::isinf(boundSymplecticEuler(w2, c)));
                continue;
            }
            const double bound = boundSymplecticEuler(w2, c);
            const auto run = [&](double dt) {
                double x = 1e-3;
                double v = 1e-3;
                for (int i = 0; i < 4000 && std::abs(v) < 1e9; ++i) {
                    v -= dt * (w2 * x + c * v);
                    x += dt * v;
                }
                return std::abs(v);
            };
            EXPECT_LT(run(0.99 * bound), 1.0);
            EXPECT_GT(run(1.01 * bound), 1e6);
        }
    }
}

TEST(StableStep, KnownShareOfTheContactTime)
{
    // dt / (pi sqrt(m / 2k)) at 6 and 12 contacts.
    const double unit = kPi / std::sqrt(2.0);
    struct Case {
        double e, ratio, damping, at6, at12;
    };
    for (const Case& c : {Case{0.3, 2.0 / 7.0, 0.5, 0.150, 0.081},
                          Case{0.9, 2.0 / 7.0, 1.0, 0.31, 0.20},
                          Case{0.3, 0.8, 0.5, 0.124, 0.071}, Case{1.0, 0.8, 0.0, 0.225, 0.159}}) {
        const ContactCoefficients law = unitLaw(betaOf(c.e), c.ratio, c.damping);
        EXPECT_NEAR(boundModes(law, 1.0, 0.5, 0.0, 6.0).rotation / unit, c.at6, 0.0025);
        EXPECT_NEAR(boundModes(law, 1.0, 0.5, 0.0, 12.0).rotation / unit, c.at12, 0.0025);
    }
    const ContactCoefficients law = unitLaw(betaOf(0.3), 2.0 / 7.0, 0.0);
    EXPECT_NEAR(boundModes(law, 1.0, 0.5, 0.0, 6.0).translation / unit, 0.24, 0.003);
    EXPECT_NEAR(boundModes(law, 1.0, 0.5, 0.0, 12.0).translation / unit, 0.147, 0.001);
}

TEST(StableStep, BoundIsTheExactLimitOfCoupledModesInCubicCrystals)
{
    for (const ContactCoefficients& law : variedLaws()) {
        for (const Lattice lattice : {Lattice::simpleCubic, Lattice::bodyCentred}) {
            const double z = lattice == Lattice::simpleCubic ? 6.0 : 8.0;
            const double bound = least(boundModes(law, 1.0, 0.5, 0.0, z));
            EXPECT_NEAR(crystalLimit(lattice, law) / bound, 1.0, 0.003);
        }
    }
}

TEST(StableStep, BoundIsSafeAndNotWastefulInTheDensestCrystal)
{
    for (const ContactCoefficients& law : variedLaws()) {
        const double bound = least(boundModes(law, 1.0, 0.5, 0.0, 12.0));
        const double limit = crystalLimit(Lattice::faceCentred, law);
        EXPECT_LT(bound, limit * (1.0 + 1e-4));
        EXPECT_GT(bound, limit * 0.85);
    }
}

TEST(StableStep, SteppedCrystalsStandBelowTheLimitAndBreakAboveIt)
{
    for (const ContactCoefficients& law : variedLaws()) {
        for (const Lattice lattice :
             {Lattice::simpleCubic, Lattice::bodyCentred, Lattice::faceCentred}) {
            const double limit = crystalLimit(lattice, law);
            EXPECT_LT(Crystal::growth(lattice, law, 0.95 * limit), 3.0);
            EXPECT_GT(Crystal::growth(lattice, law, 1.10 * limit), 1e4);
        }
    }
}

// ------------------------------------------------------------------------------ the reported step

LoadCase pour(double speed)
{
    LoadCase load;
    load.fastestSpeed = speed;
    load.deepestColumn = 0.2;
    load.minRadius = 0.0046;
    load.maxRadius = 0.0054;
    load.density = 2600.0;
    return load;
}

ContactCoefficients sandLaw(double tangentialDamping)
{
    ContactCoefficients law = unitLaw(0.497, 2.0 / 7.0, tangentialDamping, 0.1);
    law.clipAttraction = true;
    law.stiffness = 3e3;
    law.friction = 0.5;
    return law;
}

TEST(StableStep, NamesTheModeThatSetsIt)
{
    const auto reasonFor = [](const ContactCoefficients& law, double speed) {
        return stableStep(law, pour(speed), 0.0, 0.8, std::nullopt).reason;
    };
    EXPECT_EQ(reasonFor(sandLaw(0.2), 3.0), "translation (springs and dashpots at 12 contacts)");
    EXPECT_EQ(reasonFor(sandLaw(1.0), 3.0),
              "rotation (tangential springs and dashpots at 12 contacts)");
    ContactCoefficients rolling = sandLaw(0.0);
    rolling.rollingStiffness = 2.25;
    EXPECT_EQ(reasonFor(rolling, 3.0), "rolling (rolling springs and dashpots at 12 contacts)");
    EXPECT_EQ(reasonFor(sandLaw(0.2), 30.0), "fastest grain");
}

TEST(StableStep, ScalesWithMassAndStiffnessAndTakesTheSafety)
{
    ContactCoefficients law = sandLaw(0.2);
    const StepReport report = stableStep(law, pour(0.0), 0.0, 0.8, std::nullopt);
    EXPECT_DOUBLE_EQ(report.step, 0.8 * report.bound);
    law.stiffness *= 4.0;
    EXPECT_NEAR(stableStep(law, pour(0.0), 0.0, 0.8, std::nullopt).bound, 0.5 * report.bound,
                1e-9 * report.bound);
    LoadCase large = pour(0.0);
    large.minRadius *= 4.0;
    large.maxRadius *= 4.0;
    law.stiffness /= 4.0;
    EXPECT_NEAR(stableStep(law, large, 0.0, 0.8, std::nullopt).bound, 8.0 * report.bound,
                1e-9 * report.bound);
    EXPECT_NEAR(stableStep(sandLaw(0.2), pour(30.0), 0.0, 0.5, std::nullopt).step,
                0.5 * 0.1 * 0.0046 / 30.0, 1e-15);
}

TEST(StableStep, HertzLikeLawsFollowTheOverlap)
{
    for (const NormalLaw kind : {NormalLaw::hertz, NormalLaw::bellYuMucha}) {
        ContactCoefficients law = sandLaw(0.2);
        law.law = kind;
        law.stiffness = 2e6;
        law.damping = 0.0;
        const double shallow = stableStep(law, pour(0.0), 1e-5, 0.8, std::nullopt).bound;
        const double deep = stableStep(law, pour(0.0), 16e-5, 0.8, std::nullopt).bound;
        EXPECT_NEAR(deep, 0.5 * shallow, 1e-9 * shallow);  // w ~ overlap^(1/4)
        // Without dashpots it is that of a linear spring of stiffness S.
        ContactCoefficients spring = law;
        spring.law = NormalLaw::linear;
        spring.stiffness = 1.5 * 2e6 * std::sqrt(0.5 * 0.0046 * 1e-5);
        EXPECT_NEAR(stableStep(spring, pour(0.0), 0.0, 0.8, std::nullopt).bound, shallow,
                    1e-9 * shallow);
        EXPECT_THROW(stableStep(law, pour(0.0), 0.0, 0.8, std::nullopt), InternalError);
    }
}

TEST(StableStep, TakesAGivenStepUpToTheBoundAndRefusesMore)
{
    const ContactCoefficients law = sandLaw(0.2);
    const double bound = stableStep(law, pour(3.0), 0.0, 0.8, std::nullopt).bound;
    const StepReport given = stableStep(law, pour(3.0), 0.0, 0.8, 0.99 * bound);
    EXPECT_EQ(given.step, 0.99 * bound);
    EXPECT_EQ(given.reason, "given");
    EXPECT_EQ(given.bound, bound);
    EXPECT_THROW(stableStep(law, pour(3.0), 0.0, 0.8, 1.01 * bound), InputError);
    EXPECT_THROW(stableStep(law, pour(3.0), 0.0, 0.8, 0.0), InputError);
    EXPECT_THROW(stableStep(law, pour(3.0), 0.0, 0.8, std::nan("")), InputError);
}

}  // namespace
}  // namespace sandflow
