#include "scene/repose_angle.h"

#include "scene/field_format.h"
#include "scene/repose_table.h"

namespace sandflow {
namespace {

std::string describeMaterial(const ContactSpec& contact, const ReposeReport& report)
{
    const ReposeTable& table = measuredRepose();
    const std::string pair = fmt::format("friction {:.4g} and rolling friction {:.4g}",
                                         contact.friction, contact.rollingFriction);
    if (report.measured) {
        return fmt::format("heaps of {} stand at {:.1f} degrees (+-{:.1f} from pour to pour){}",
                           pair, report.expected, table.scatter(),
                           contact.reposeAngle ? ", as contact.repose_angle asks" : "");
    }
    return fmt::format(
        "{} were not measured (friction {:.4g} to {:.4g}, rolling friction {:.4g} to {:.4g} were); "
        "the nearest that were stand at {:.1f} degrees",
        pair, table.frictions().low, table.frictions().high, table.rollingFrictions().low,
        table.rollingFrictions().high, report.expected);
}

std::string describeNeutralSlope(const SurfaceFlowSpec& flow, const ReposeReport& report)
{
    return fmt::format(
        "theta0 {:.4g} degrees: {:.4g} {}, {:.4g} added {}", report.neutralSlope(), report.angle,
        flow.reposeAngle ? "from surface_flow.repose_angle" : "as the material's heaps stand",
        report.margin, flow.reposeMargin ? "as surface_flow.repose_margin" : "by default");
}

}  // namespace

ReposeReport reportRepose(const Scene& scene)
{
    const ContactSpec& contact = scene.contact;
    const SurfaceFlowSpec& flow = scene.surfaceFlow;
    ReposeReport report;
    report.expected = measuredRepose().angle(contact.friction, contact.rollingFriction);
    report.measured = measuredRepose().covers(contact.friction, contact.rollingFriction);
    report.angle = flow.reposeAngle.value_or(report.expected);
    report.margin = flow.reposeMargin.value_or(flow.reposeAngle ? 0.0 : kAutoReposeMargin);
    report.material = describeMaterial(contact, report);
    report.reason = describeNeutralSlope(flow, report);
    return report;
}

}  // namespace sandflow
