#include "scene/repose_angle.h"
#include "scene/repose_table.h"
#include "scene/write_scene.h"
#include "scene_support.h"

namespace sandflow {
namespace {

Scene withFlow(const std::string& keys)
{
    return parseScene(kJet + "[surface_flow]\n" + keys, "s.toml");
}

TEST(ReposeAngle, ANumberIsTakenAsItIs)
{
    const ReposeReport plain = reportRepose(withFlow("repose_angle = 33.1\n"));
    EXPECT_EQ(plain.neutralSlope(), 33.1);
    EXPECT_EQ(plain.margin, 0.0);
    const ReposeReport raised = reportRepose(withFlow("repose_angle = 30\nrepose_margin = -2.5\n"));
    EXPECT_EQ(raised.neutralSlope(), 27.5);
    EXPECT_NE(raised.reason.find("from surface_flow.repose_angle"), std::string::npos)
        << raised.reason;
}

TEST(ReposeAngle, AutoIsTheMaterialsWithAMargin)
{
    Scene scene = withFlow("repose_angle = \"auto\"\n");
    const ReposeReport report = reportRepose(scene);
    EXPECT_EQ(report.angle, measuredRepose().angle(0.5, 0.1));
    EXPECT_EQ(report.angle, report.expected);
    EXPECT_EQ(report.margin, kAutoReposeMargin);
    EXPECT_TRUE(report.measured);
    scene.contact.friction = 0.2;
    EXPECT_LT(reportRepose(scene).neutralSlope(), report.neutralSlope() - 3.0);
    scene.surfaceFlow.reposeMargin = 1.0;
    EXPECT_EQ(reportRepose(scene).neutralSlope(), measuredRepose().angle(0.2, 0.1) + 1.0);
}

TEST(ReposeAngle, StaysAutoInASceneThatIsWrittenOut)
{
    const std::string text = writeScene(withFlow("repose_angle = \"auto\"\n"));
    EXPECT_NE(text.find("\nrepose_angle = \"auto\"\nrepose_margin = \"auto\"\n"), std::string::npos)
        << text;
}

TEST(ReposeAngle, SaysWhenTheMaterialWasNotMeasured)
{
    Scene scene = withFlow("repose_angle = \"auto\"\n");
    scene.contact.friction = 3.0;
    const ReposeReport report = reportRepose(scene);
    EXPECT_FALSE(report.measured);
    EXPECT_EQ(report.expected, measuredRepose().angle(1.0, 0.1));
    EXPECT_NE(report.material.find("were not measured"), std::string::npos) << report.material;
}

}  // namespace
}  // namespace sandflow
