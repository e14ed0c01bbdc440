#include "core/errors.h"
#include "study/heap_sample.h"
#include "study/soundness_watch.h"
#include "study/stability_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace sandflow {
namespace {

Check makeCheck(double error, double limit, Verdict otherwise)
{
    return {fmt::format("{} of {}", error, limit), error, limit, "d", otherwise, "cause"};
}

Finding judged(const std::vector<Check>& checks)
{
    Finding finding;
    judge(checks, finding);
    return finding;
}

TEST(Verdict, IsSoundWhenEverythingIsWithinItsLimitAndNamesWhatCameNearest)
{
    const Finding f = judged({makeCheck(0.1, 1.0, Verdict::broke),
                              makeCheck(0.4, 0.5, Verdict::jitters),
                              makeCheck(0.0, 2.0, Verdict::wrongShape)});
    EXPECT_EQ(f.verdict, Verdict::sound);
    EXPECT_EQ(f.decisive.measure, "0.4 of 0.5");
    EXPECT_EQ(f.cause, "");
}

TEST(Verdict, IsTheWorstOfWhatFailed)
{
    const Finding f = judged({makeCheck(90.0, 1.0, Verdict::wrongShape),
                              makeCheck(1.1, 1.0, Verdict::broke),
                              makeCheck(0.9, 1.0, Verdict::broke),
                              makeCheck(5.0, 1.0, Verdict::jitters)});
    EXPECT_EQ(f.verdict, Verdict::broke);
    EXPECT_EQ(f.decisive.measure, "1.1 of 1");
    EXPECT_EQ(f.cause, "cause");
}

TEST(Verdict, AGuardCountsOnlyWhenItFails)
{
    Check guard = makeCheck(0.9, 1.0, Verdict::broke);
    guard.isGuard = true;
    const Check shape = makeCheck(0.1, 1.0, Verdict::wrongShape);
    EXPECT_EQ(judged({guard, shape}).decisive.measure, shape.measure);
    EXPECT_EQ(judged({shape, guard}).decisive.measure, shape.measure);
    guard.error = 1.1;
    EXPECT_EQ(judged({shape, guard}).verdict, Verdict::broke);
}

TEST(Verdict, AnErrorThatIsNoNumberFails)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(judged({makeCheck(nan, 1.0, Verdict::jitters)}).verdict, Verdict::jitters);
    EXPECT_EQ(judged({makeCheck(0.0, 1.0, Verdict::broke), makeCheck(nan, 1.0, Verdict::wrongShape)})
                  .verdict,
              Verdict::wrongShape);
}

TEST(Verdict, NothingCheckedProvesNothing)
{
    Finding finding;
    EXPECT_THROW(judge({}, finding), InternalError);
}

TEST(Verdict, OnlySoundAndRefusedCanBeReliedOn)
{
    EXPECT_TRUE(isAcceptable(Verdict::sound));
    EXPECT_TRUE(isAcceptable(Verdict::refused));
    EXPECT_FALSE(isAcceptable(Verdict::wrongShape));
    EXPECT_FALSE(isAcceptable(Verdict::jitters));
    EXPECT_FALSE(isAcceptable(Verdict::broke));
}

TEST(HeapVerdict, CatchesAPlausibleHeapOfOtherSand)
{
    // Both heaps come to rest and look like heaps; one is of sand with a third of the friction.
    Scene rough = makeStudyPour(500, Mode::dem), slippery = rough;
    slippery.contact.friction = 0.1;
    const HeapSample truth = sampleHeap(rough, 1);
    Finding same, other;
    judgeHeap(sampleHeap(rough, 1), truth, same);
    judgeHeap(sampleHeap(slippery, 1), truth, other);
    EXPECT_EQ(same.verdict, Verdict::sound) << same.cause;
    EXPECT_EQ(other.verdict, Verdict::wrongShape);
    EXPECT_NE(other.cause, "");
}

TEST(HeapVerdict, ARefusedSceneIsRefusedWithItsReason)
{
    Scene scene = makeStudyPour(100, Mode::dem);
    const HeapSample truth = sampleHeap(scene, 1);
    scene.time.step = 1.01 * planRun(scene).step.bound;
    Finding step, spread;
    judgeHeap(sampleHeap(scene, 1), truth, step);
    EXPECT_EQ(step.verdict, Verdict::refused);
    EXPECT_NE(step.cause.find("time.step"), std::string::npos) << step.cause;
    // What only the reader of scene files knows is refused as well.
    scene.time.step.reset();
    scene.grains.sizeSpread = 0.9;
    judgeHeap(sampleHeap(scene, 1), truth, spread);
    EXPECT_EQ(spread.verdict, Verdict::refused);
    EXPECT_NE(spread.cause.find("size_spread"), std::string::npos) << spread.cause;
}

TEST(HeapVerdict, ProfilesDifferByTheirMeanWeightedWithArea)
{
    EXPECT_EQ(profileDifference({4.0, 3.0, 2.0}, {4.0, 3.0, 2.0}), 0.0);
    // Annuli of areas 1 and 3: (1 * 1 + 3 * 2) / 4.
    EXPECT_DOUBLE_EQ(profileDifference({4.0, 2.0}, {3.0, 4.0}), 7.0 / 4.0);
    EXPECT_DOUBLE_EQ(profileDifference({4.0}, {4.0, 2.0}), 6.0 / 4.0) << "a missing annulus is bare";
    EXPECT_EQ(profileDifference({1.0}, {1.4}), 0.0) << "single grains do not count";
}

TEST(HeapVerdict, TheSlopeOfAConeIsItsOwn)
{
    for (const double degrees : {5.0, 15.0, 25.0, 35.0}) {
        std::vector<double> profile;
        for (int k = 0; k < 400; ++k) {
            // Mean over annulus k of h - r tan: at its mean radius.
            const double radius = 2.0 / 3.0 * (std::pow(k + 1.0, 3) - std::pow(k, 3)) / (2.0 * k + 1.0);
            profile.push_back(std::max(0.0, 30.0 - std::tan(degrees * kPi / 180.0) * radius));
        }
        EXPECT_NEAR(coneAngle(profile), degrees, 0.02) << degrees;
    }
    EXPECT_EQ(coneAngle({}), 0.0);
    EXPECT_LT(coneAngle(std::vector<double>(40, 1.0)), 3.0) << "a flat layer";
}

/// The verdict of a short run that `spoil` told a lie about.
Finding watchSpoiled(const std::function<void(Scene&)>& pretend)
{
    Scene ran = makeStudyPour(60, Mode::dem);
    ran.time.duration = 0.3;
    Scene told = ran;
    pretend(told);
    SoundnessWatch watch(told);
    runTrial(ran, [&](const Simulation& sand, const FrameReport& report) {
        watch.look(sand, report);
        return true;
    });
    std::vector<Check> checks;
    watch.addChecks(checks);
    Finding finding;
    judge(checks, finding);
    return finding;
}

TEST(SoundnessWatch, SeesSpeedsThatNoFallExplains)
{
    EXPECT_EQ(watchSpoiled([](Scene&) {}).verdict, Verdict::sound);
    // Told that the grains start slowly and on the floor, it must find them too fast.
    const Finding fast = watchSpoiled([](Scene& told) {
        told.emitters[0].position.z() = 0.02;
        told.emitters[0].speed = 0.1;
    });
    EXPECT_EQ(fast.verdict, Verdict::broke);
    EXPECT_EQ(fast.decisive.measure, "speed / speed of the fall");
}

TEST(SoundnessWatch, SeesEnergyFromNowhere)
{
    // Told that everything is in from the start and that down is up, falling is gaining.
    const Finding made = watchSpoiled([](Scene& told) {
        told.emitters[0].rate = 1e6;
        told.gravity = -told.gravity;
        told.emitters[0].speed = 100.0;
    });
    EXPECT_EQ(made.verdict, Verdict::broke);
    EXPECT_EQ(made.decisive.measure, "energy made");
}

TEST(SoundnessWatch, SeesSandThatIsNotAtRest)
{
    Scene scene = makeStudyPour(60, Mode::dem);
    scene.time.duration = 0.1;  // the jet is still pouring
    SoundnessWatch watch(scene);
    runTrial(scene, [&](const Simulation& sand, const FrameReport& report) {
        watch.look(sand, report);
        return true;
    });
    std::vector<Check> checks;
    watch.addRestCheck(checks);
    Finding finding;
    judge(checks, finding);
    EXPECT_EQ(finding.verdict, Verdict::jitters);
}

TEST(StabilityStudy, HasEveryFamilyInBothSizes)
{
    const auto familiesOf = [](StudySize size) {
        std::vector<std::string> names;
        for (const StabilityCase& c : makeStabilityCases(size)) {
            if (std::find(names.begin(), names.end(), c.head.family) == names.end()) {
                names.push_back(c.head.family);
            }
        }
        return names;
    };
    EXPECT_EQ(familiesOf(StudySize::quick), familiesOf(StudySize::whole));
    EXPECT_GT(familiesOf(StudySize::whole).size(), 10u);
}

TEST(StabilityStudy, KeepsTheOrderOfItsCasesOnAnyNumberOfThreads)
{
    std::vector<StabilityCase> cases;
    for (int k = 0; k < 20; ++k) {
        cases.push_back(makeCase("family", "n", k, "dem", [k](Finding& f) {
            judge({makeCheck(k, 10.0, Verdict::broke)}, f);
        }));
    }
    std::size_t told = 0;
    const std::vector<Finding> findings = runStabilityCases(
        cases, [&](const std::vector<Finding>& found) { told += found.size(); });
    ASSERT_EQ(findings.size(), 20u);
    EXPECT_EQ(told, 20u);
    for (std::size_t k = 0; k < 20; ++k) {
        EXPECT_EQ(findings[k].value, static_cast<double>(k));
        EXPECT_EQ(findings[k].verdict, k > 10 ? Verdict::broke : Verdict::sound);
    }
}

TEST(StabilityStudy, PassesOnWhatIsNoVerdict)
{
    const std::vector<StabilityCase> cases = {
        makeCase("family", "n", 1.0, "dem", [](Finding&) { throw SystemError("no memory"); })};
    EXPECT_THROW(runStabilityCases(cases, [](const std::vector<Finding>&) {}), SystemError);
}

}  // namespace
}  // namespace sandflow
