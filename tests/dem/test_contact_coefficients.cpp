#include "contact_rig.h"
#include "core/errors.h"
#include "dem/contact_coefficients.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace sandflow {
namespace {

constexpr NormalLaw kLaws[] = {NormalLaw::linear, NormalLaw::hertz, NormalLaw::bellYuMucha};

LoadCase pour(double speed, double column)
{
    LoadCase load;
    load.fastestSpeed = speed;
    load.deepestColumn = column;
    load.minRadius = 0.0046;
    load.maxRadius = 0.0054;
    load.density = 2600.0;
    return load;
}

double massOf(double radius)
{
    return 4.0 / 3.0 * kPi * radius * radius * radius * 2600.0;
}

Scene sceneWith(NormalLaw law, bool clip = true)
{
    Scene scene;
    scene.contact.law = law;
    scene.contact.clipAttraction = clip;
    return scene;
}

std::string errorOf(const Scene& scene, const LoadCase& load)
{
    StiffnessReport report;
    try {
        makeContactCoefficients(scene, load, report);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ContactCoefficients, HaveTheScenesRestitution)
{
    const double pairMass = 0.5 * massOf(0.005);
    for (const NormalLaw kind : kLaws) {
        for (const bool clip : {true, false}) {
            for (const double e : {0.3, 0.7, 1.0}) {
                Scene scene = sceneWith(kind, clip);
                scene.contact.restitution = e;
                StiffnessReport report;
                const auto law = makeContactCoefficients(scene, pour(4.0, 0.2), report);
                // Bell-Yu-Mucha is made right for mean grains at half the fastest speed.
                EXPECT_NEAR(integrateRestitution(law, pairMass, 0.0025, 2.0), e, 1e-9);
            }
        }
    }
}

TEST(ContactCoefficients, AutoStiffnessJustKeepsTheOverlapOfTheFastestGrain)
{
    for (const NormalLaw kind : kLaws) {
        for (const bool clip : {true, false}) {
            StiffnessReport report;
            const auto law =
                makeContactCoefficients(sceneWith(kind, clip), pour(5.0, 0.05), report);
            const double peak = integratePeakOverlap(law, massOf(0.0054), 0.0027, 5.0);
            EXPECT_NEAR(peak / 0.0046, 0.3, 1e-8);
            EXPECT_NEAR(report.impactOverlap, 0.3, 1e-8);
            EXPECT_LT(report.loadOverlap, 0.3);
            EXPECT_TRUE(report.automatic);

            // And the law that runs does the same, stepped.
            rig::Ball ball = rig::makeBall(0.0054, 2600.0);
            ball.position.z = ball.radius;
            ball.velocity.z = -5.0;
            // Against a fixed sphere R* = r / 2; the plane has R* = r, so give it K / sqrt(2).
            ContactCoefficients againstPlane = law;
            if (kind != NormalLaw::linear) {
                againstPlane.stiffness /= std::sqrt(2.0);
            }
            rig::Touch contact;
            rig::hitPlane(againstPlane, ball, contact, 1e-7);
            EXPECT_NEAR(contact.peakOverlap / 0.0046, 0.3, 5e-4);
        }
    }
}

TEST(ContactCoefficients, AutoStiffnessCarriesTheDeepestLoad)
{
    for (const NormalLaw kind : kLaws) {
        StiffnessReport report;
        const auto law = makeContactCoefficients(sceneWith(kind), pour(0.1, 3.0), report);
        EXPECT_NEAR(report.loadOverlap, 0.3, 1e-9);
        EXPECT_LT(report.impactOverlap, 0.3);
        // Elastic force at that overlap is several times a grain's share of the column's weight.
        const double overlap = 0.3 * 0.0046;
        const double force = rig::evaluateNormalOf(kind, LawNumbers<double>(law), overlap, 0.0,
                                                   massOf(0.0054), 0.0027)
                                 .force;
        const double share = 0.6 * 2600.0 * 9.81 * 3.0 * std::pow(2.0 * 0.0054, 2);
        EXPECT_NEAR(force / share, 3.0, 1e-6);
    }
}

TEST(ContactCoefficients, PredictsTheOverlapOfAGivenStiffness)
{
    // delta = V sqrt(m/k) exp(-beta acos(beta) / sqrt(1 - beta^2)) for the linear law, unclipped:
    // 0.42 r for a grain of 5 mm at 5 m/s with k = 3e3 N/m and e = 0.3.
    Scene scene = sceneWith(NormalLaw::linear, false);
    scene.contact.stiffness = 3e3;
    scene.contact.maxOverlap = 1.0;
    for (const double speed : {3.0, 5.0, 8.0}) {
        LoadCase load = pour(speed, 0.1);
        load.minRadius = load.maxRadius = 0.005;
        StiffnessReport report;
        makeContactCoefficients(scene, load, report);
        const double beta = 0.35785713;
        const double expected = speed * std::sqrt(massOf(0.005) / 3e3)
                                * std::exp(-beta * std::acos(beta) / std::sqrt(1.0 - beta * beta))
                                / 0.005;
        EXPECT_NEAR(report.impactOverlap, expected, 1e-7);
        EXPECT_NEAR(report.impactOverlap / speed, 0.085, 0.0002);
        EXPECT_FALSE(report.automatic);
    }
}

TEST(ContactCoefficients, RefusesASoftGivenStiffnessAndSaysWhatIsEnough)
{
    Scene scene = sceneWith(NormalLaw::linear);
    scene.contact.stiffness = 500.0;
    const std::string message = errorOf(scene, pour(5.0, 0.1));
    EXPECT_NE(message.find("contact.stiffness = 500 N/m"), std::string::npos) << message;
    const auto at = message.find("at least ");
    ASSERT_NE(at, std::string::npos) << message;
    scene.contact.stiffness = std::stod(message.substr(at + 9));
    EXPECT_EQ(errorOf(scene, pour(5.0, 0.1)), "");
    // And it is not much more than enough.
    scene.contact.stiffness = 0.98 * *scene.contact.stiffness;
    EXPECT_NE(errorOf(scene, pour(5.0, 0.1)), "");
}

TEST(ContactCoefficients, RefusesASoftGivenModulusAndSaysWhatIsEnough)
{
    for (const NormalLaw kind : {NormalLaw::hertz, NormalLaw::bellYuMucha}) {
        Scene scene = sceneWith(kind);
        scene.contact.youngModulus = 1e3;
        const std::string message = errorOf(scene, pour(5.0, 0.1));
        EXPECT_NE(message.find("contact.young_modulus = 1e+03 Pa"), std::string::npos) << message;
        const auto at = message.find("at least ");
        ASSERT_NE(at, std::string::npos) << message;
        scene.contact.youngModulus = std::stod(message.substr(at + 9));
        EXPECT_EQ(errorOf(scene, pour(5.0, 0.1)), "");
        scene.contact.youngModulus = 0.98 * *scene.contact.youngModulus;
        EXPECT_NE(errorOf(scene, pour(5.0, 0.1)), "");
    }
}

TEST(ContactCoefficients, HertzTakesBothStiffnessesFromTheMaterial)
{
    Scene scene = sceneWith(NormalLaw::hertz);
    scene.contact.youngModulus = 48e9;
    scene.contact.poissonRatio = 0.2;
    StiffnessReport report;
    const auto law = makeContactCoefficients(scene, pour(5.0, 0.1), report);
    const double pairModulus = 48e9 / (2.0 * (1.0 - 0.04));
    EXPECT_NEAR(law.stiffness, 4.0 / 3.0 * pairModulus, 1e-6 * law.stiffness);
    // Mindlin: kt = 8 G* sqrt(R* delta) over S = 2 E* sqrt(R* delta).
    const double pairShear = 48e9 / (4.0 * (2.0 - 0.2) * (1.0 + 0.2));
    EXPECT_NEAR(law.tangentialRatio, 4.0 * pairShear / pairModulus, 1e-12);
    EXPECT_NEAR(law.rollingStiffness, 2.25 * 0.1 * 0.1, 1e-15);
}

TEST(ContactCoefficients, NoRollingFrictionMeansNoRollingTerms)
{
    Scene scene;
    scene.contact.rollingFriction = 0.0;
    StiffnessReport report;
    const auto law = makeContactCoefficients(scene, pour(3.0, 0.1), report);
    EXPECT_EQ(law.rollingFriction, 0.0);
    EXPECT_EQ(law.rollingStiffness, 0.0);
    EXPECT_EQ(law.rollingDamping, 0.0);
}

TEST(ContactCoefficients, RefusesNumbersWithoutMeaning)
{
    const auto refused = [](auto change) {
        Scene scene;
        change(scene.contact);
        return errorOf(scene, pour(3.0, 0.1)) != "";
    };
    EXPECT_TRUE(refused([](ContactSpec& c) { c.friction = -0.1; }));
    EXPECT_TRUE(refused([](ContactSpec& c) { c.rollingFriction = std::nan(""); }));
    EXPECT_TRUE(refused([](ContactSpec& c) { c.restitution = 1.2; }));
    EXPECT_TRUE(refused([](ContactSpec& c) { c.stiffness = 0.0; }));
    EXPECT_TRUE(refused([](ContactSpec& c) { c.poissonRatio = 0.7; }));
    EXPECT_TRUE(refused([](ContactSpec& c) { c.maxOverlap = 0.0; }));
    EXPECT_FALSE(refused([](ContactSpec& c) { c.friction = 0.7; }));
    LoadCase still = pour(0.0, 0.0);
    still.gravity = 0.0;
    EXPECT_NE(errorOf(Scene(), still), "");
}

}  // namespace
}  // namespace sandflow
