#include "core/errors.h"
#include "io/temp_folder.h"
#include "scene/read_scene.h"
#include "solver/scenes.h"
#include "study/error_setting.h"

#include <set>

namespace sandflow {
namespace {

constexpr double kStiffness = 2000.0;  // N/m

const char* const kScene = R"(
[[solids]]
shape = "plane"
[[emitters]]
kind = "jet"
count = 100
rate = 600
position = [0, 0, 0.12]
speed = 0.5
radius = 0.03
)";

Scene readWith(const std::vector<std::string>& overrides)
{
    return parseScene(kScene, "scene.toml", overrides);
}

const ErrorSetting& find(const std::vector<ErrorSetting>& settings,
                         const std::string& approximation, const std::string& value)
{
    const auto at = std::find_if(settings.begin(), settings.end(), [&](const ErrorSetting& s) {
        return s.approximation == approximation && s.value == value;
    });
    if (at == settings.end()) {
        throw std::runtime_error("no " + approximation + " " + value);
    }
    return *at;
}

TEST(ErrorSetting, TheSceneItselfComesFirst)
{
    const auto settings = listErrorSettings(readWith({}), kStiffness, false);
    EXPECT_EQ(settings.front().approximation, kDefaultSetting);
    EXPECT_TRUE(settings.front().overrides.empty());
}

TEST(ErrorSetting, EachChangesTheSceneAndIsReadable)
{
    const Scene scene = readWith({});
    std::set<std::string> seen;
    for (const ErrorSetting& setting : listErrorSettings(scene, kStiffness, false)) {
        EXPECT_TRUE(seen.insert(setting.approximation + setting.value).second) << setting.value;
        EXPECT_NO_THROW(readWith(setting.overrides)) << setting.approximation << setting.value;
    }
    for (const char* approximation :
         {"time step", "stiffness", "R_min", "interface", "cell size", "transfer interval",
          "method", "sleep", "precision", "freeze speed", "theta0", "gamma"}) {
        EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [&](const std::string& name) {
            return name.starts_with(approximation);
        })) << approximation;
    }
}

TEST(ErrorSetting, ValuesReachTheSceneInItsUnits)
{
    const auto settings = listErrorSettings(readWith({}), kStiffness, false);
    const auto sceneOf = [&](const char* approximation, const char* value) {
        return readWith(find(settings, approximation, value).overrides);
    };
    EXPECT_EQ(sceneOf("R_min", "3 d").surfaceFlow.minFlowDepth, 3.0);
    EXPECT_EQ(sceneOf("freeze speed", "4 mm/s").surfaceFlow.freezeSpeed, 4e-3);
    EXPECT_EQ(sceneOf("transfer interval", "10 ms").surfaceFlow.interval, 0.01);
    EXPECT_EQ(sceneOf("theta0", "39 deg").surfaceFlow.reposeAngle, 39.0);
    EXPECT_EQ(sceneOf("method", "dem").mode, Mode::dem);
    EXPECT_EQ(sceneOf("precision", "double").precision, Precision::real64);
    EXPECT_FALSE(sceneOf("sleep", "off").skip.sleep);
    EXPECT_EQ(sceneOf("stiffness", "x 10").contact.stiffness, 10.0 * kStiffness);
}

TEST(ErrorSetting, WhatTheSceneHasAlreadyIsLeftOut)
{
    const auto thin = listErrorSettings(readWith({"surface_flow.min_flow_depth=3"}), kStiffness,
                                        false);
    EXPECT_THROW(find(thin, "R_min", "3 d"), std::runtime_error);
    EXPECT_NO_THROW(find(thin, "R_min", "2 d"));
    const auto wide = listErrorSettings(readWith({"precision=double"}), kStiffness, false);
    EXPECT_EQ(find(wide, "precision", "float").overrides,
              std::vector<std::string>{"precision=float"});
}

TEST(ErrorSetting, QuickKeepsTheEndsOfEachSweep)
{
    const Scene scene = readWith({});
    const auto all = listErrorSettings(scene, kStiffness, false);
    const auto ends = listErrorSettings(scene, kStiffness, true);
    EXPECT_LT(ends.size(), all.size());
    std::set<std::string> allNames, endNames;
    for (const ErrorSetting& setting : all) {
        allNames.insert(setting.approximation);
    }
    for (const ErrorSetting& setting : ends) {
        endNames.insert(setting.approximation);
    }
    EXPECT_EQ(endNames, allNames);
    EXPECT_NO_THROW(find(ends, "R_min", "1 d"));
    EXPECT_NO_THROW(find(ends, "R_min", "3 d"));
    EXPECT_THROW(find(ends, "R_min", "2 d"), std::runtime_error);
}

/// A simulation accepts the softer grains: the overlap it allows is raised with them.
TEST(ErrorSetting, SofterAndStifferGrainsRun)
{
    for (const char* law : {"contact.law=linear", "contact.law=hertz"}) {
        const Scene scene = readWith({law});
        const double stiffness = planRun(scene).law.stiffness;
        for (const auto& [value, factor] : {std::pair{"x 0.4", 0.4}, std::pair{"x 10", 10.0}}) {
            auto overrides = find(listErrorSettings(scene, stiffness, false), "stiffness", value)
                                 .overrides;
            overrides.push_back(law);
            EXPECT_NEAR(planRun(readWith(overrides)).law.stiffness, factor * stiffness,
                        1e-5 * factor * stiffness)
                << law;
        }
    }
}

TEST(ErrorSetting, ReferenceIsStiffDemAtASmallStep)
{
    const Scene scene = readWith({});
    const RunPlan plan = planRun(scene);
    const ErrorSetting setting = makeReferenceSetting(scene, plan.law.stiffness, {4.0, 0.2});
    const Scene reference = readWith(setting.overrides);
    EXPECT_EQ(reference.mode, Mode::dem);
    const RunPlan fine = planRun(reference);
    EXPECT_NEAR(fine.law.stiffness, 4.0 * plan.law.stiffness, 1e-4 * plan.law.stiffness);
    // The bound falls with the root of the stiffness, the step also with its safety.
    EXPECT_NEAR(fine.step.step, plan.step.step * (0.2 / 0.8) / 2.0, 1e-4 * plan.step.step);
}

TEST(ErrorSetting, ScenesThatLeaveNothingToStudyAreRefused)
{
    const auto refusal = [](const std::string& override) {
        return messageOf<InputError>(
            [&] { listErrorSettings(readWith({override}), kStiffness, false); });
    };
    EXPECT_NE(refusal("mode=dem").find("mode"), std::string::npos);
    EXPECT_NE(refusal("time.step=1e-5").find("time.step"), std::string::npos);
}

}  // namespace
}  // namespace sandflow
