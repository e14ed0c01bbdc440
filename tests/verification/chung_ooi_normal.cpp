#include "dem/restitution.h"
#include "verification/contact_bench.h"

#include <fmt/format.h>

/// Chung & Ooi, Granular Matter 13 (2011) 643, tests 1 to 3: impacts along the normal.
namespace sandflow::verification {
namespace {

constexpr double kPeakTolerance = 0.005;         ///< relative, of Hertz peaks
constexpr double kRestitutionTolerance = 0.005;  ///< absolute
constexpr double kFineStepsPerImpact = 1e4;

struct Peaks {
    Material material;
    double overlap;   ///< m
    double force;     ///< N
    double duration;  ///< s
};

std::vector<Expectation> expectPeaks(const Peaks& peaks)
{
    const std::string name = peaks.material.name;
    return {{name + ": peak overlap [um]", 1e6 * peaks.overlap, Gate::relative, kPeakTolerance},
            {name + ": peak force [N]", peaks.force, Gate::relative, kPeakTolerance},
            {name + ": contact time [us]", 1e6 * peaks.duration, Gate::relative, kPeakTolerance}};
}

std::vector<double> numbersOf(const Impact& impact)
{
    return {1e6 * impact.deepest, impact.strongest, 1e6 * impact.duration};
}

std::vector<Verdict> hitEqualSpheres(const Settings&)
{
    std::vector<Verdict> verdicts;
    for (const Peaks& peaks :
         {Peaks{{"glass", 48e9, 0.20, 2800.0}, 274.1e-6, 10.697e3, 40.34e-6},
          Peaks{{"limestone", 20e9, 0.25, 2500.0}, 368.3e-6, 7.108e3, 54.20e-6}}) {
        ContactCoefficients law = hertzLaw(peaks.material.pairStiffness());
        law.friction = 0.35;
        law.tangentialRatio = peaks.material.tangentialRatio();
        Ball a = makeBall(0.01, peaks.material.density);
        Ball b = a;
        b.position.x() = 0.02;
        a.velocity.x() = 10.0;
        b.velocity.x() = -10.0;
        judge(
            expectPeaks(peaks),
            [&](const Stepping& stepping) {
                return numbersOf(hitEachOther(law, a, b, stepping));
            },
            peaks.duration / kFineStepsPerImpact, shippingStep(law, a, 20.0), verdicts);
    }
    return verdicts;
}

std::vector<Verdict> hitRigidPlane(const Settings&)
{
    std::vector<Verdict> verdicts;
    for (const Peaks& peaks :
         {Peaks{{"aluminium alloy", 70e9, 0.30, 2699.0}, 49.72e-6, 11.370e3, 731.7e-6},
          Peaks{{"magnesium alloy", 40e9, 0.35, 1800.0}, 52.12e-6, 7.233e3, 767.1e-6}}) {
        const ContactCoefficients law = hertzLaw(peaks.material.planeStiffness());
        Ball ball = makeBall(0.1, peaks.material.density);
        ball.position.z() = ball.radius;
        ball.velocity.z() = -0.2;
        judge(
            expectPeaks(peaks),
            [&](const Stepping& stepping) { return numbersOf(hitPlane(law, ball, stepping)); },
            peaks.duration / kFineStepsPerImpact, shippingStep(law, ball, 0.2), verdicts);
    }
    return verdicts;
}

std::vector<Verdict> reboundAsDamped(const Settings&)
{
    constexpr double kSpeed = 3.9;
    constexpr double kStep = 8.1e-9;  ///< s, theirs
    std::vector<Verdict> verdicts;
    for (const Material& material : {Material{"aluminium oxide", 380e9, 0.23, 4000.0},
                                     Material{"cast iron", 100e9, 0.25, 7000.0}}) {
        Ball ball = makeBall(0.0025, material.density);
        ball.position.z() = ball.radius;
        ball.velocity.z() = -kSpeed;
        for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
            for (const bool clip : {true, false}) {
                ContactCoefficients law = hertzLaw(material.planeStiffness());
                law.clipAttraction = clip;
                law.damping = solveDamping(NormalLaw::hertz, clip, e);
                judge({{fmt::format("{}: restitution {}{}", material.name, e,
                                    clip ? "" : ", contact may pull"),
                        e, Gate::absolute, kRestitutionTolerance}},
                      [&](const Stepping& stepping) {
                          return std::vector<double>{
                              hitPlane(law, ball, stepping).after[0].velocity.z() / kSpeed};
                      },
                      kStep, shippingStep(law, ball, kSpeed), verdicts);
            }
        }
        if (material.density == 4000.0) {
            const ContactCoefficients law = hertzLaw(material.planeStiffness());
            judge(
                expectPeaks({material, 8.089e-6, 615.4, 6.104e-6}),
                [&](const Stepping& stepping) { return numbersOf(hitPlane(law, ball, stepping)); },
                kStep / 10.0, shippingStep(law, ball, kSpeed), verdicts);
        }
    }
    return verdicts;
}

const Registration kEqualSpheres({"ChungOoi1", "Chung & Ooi 2011, test 1: two equal spheres", false,
                                  hitEqualSpheres});
const Registration kRigidPlane({"ChungOoi2", "Chung & Ooi 2011, test 2: sphere on a rigid plane",
                                false, hitRigidPlane});
const Registration kRestitution({"ChungOoi3", "Chung & Ooi 2011, test 3: normal restitution", false,
                                 reboundAsDamped});

}  // namespace
}  // namespace sandflow::verification
