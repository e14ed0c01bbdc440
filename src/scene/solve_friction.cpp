#include "scene/solve_friction.h"

#include "scene/field_format.h"
#include "scene/repose_table.h"
#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace sandflow {
namespace {

constexpr const char* kTarget = "contact.repose_angle";
constexpr const char* kFriction = "contact.friction";
constexpr const char* kRolling = "contact.rolling_friction";

enum class Said { nothing, automatic, number };

Said lookUp(const SceneSource& source, const char* key)
{
    const auto node = toml::at_path(source.root(), key);
    if (!node) {
        return Said::nothing;
    }
    return node.is_string() ? Said::automatic : Said::number;
}

/// "0.1 to 1"
std::string formatInterval(const Interval& interval)
{
    return fmt::format("{:.4g} to {:.4g}", interval.low, interval.high);
}

/// All that the table can give.
Interval reachOfTable()
{
    Interval reach{90.0, 0.0};
    for (const ReposeMeasurement& row : reposeMeasurements()) {
        reach.low = std::min(reach.low, row.angle);
        reach.high = std::max(reach.high, row.angle);
    }
    return reach;
}

/// One of the two coefficients is solved, the other is given.
struct Role {
    const char* solved;
    const char* given;
    double value;             ///< of the given one
    Interval solvedMeasured;  ///< values in the table
    Interval givenMeasured;
    Interval reach;  ///< degrees, with the given one
};

void checkReach(const SceneSource& source, double wanted, const Role& role)
{
    if (!role.givenMeasured.contains(role.value)) {
        source.fail(
            {role.given, kTarget},
            fmt::format("is {}, expected {}, where heaps were measured, as {} is solved for "
                        "{}",
                        formatShortest(role.value), formatInterval(role.givenMeasured), role.solved,
                        kTarget));
    }
    if (!role.reach.contains(wanted)) {
        source.fail(
            {kTarget, role.given},
            fmt::format("is {}, but with {} = {} heaps stand at {} degrees ({} {}), "
                        "expected an angle in that range or another {}: with {}, heaps of "
                        "{} degrees can be had",
                        formatShortest(wanted), role.given, formatShortest(role.value),
                        formatInterval(role.reach), role.solved,
                        formatInterval(role.solvedMeasured), role.given,
                        formatInterval(role.givenMeasured), formatInterval(reachOfTable())));
    }
}

}  // namespace

void solveFriction(const SceneSource& source, ContactSpec& contact)
{
    const Said friction = lookUp(source, kFriction);
    const Said rolling = lookUp(source, kRolling);
    if (!contact.reposeAngle) {
        if (friction == Said::automatic || rolling == Said::automatic) {
            source.fail({friction == Said::automatic ? kFriction : kRolling},
                        "is \"auto\", expected contact.repose_angle, for which it is solved");
        }
        return;
    }
    if (friction == Said::automatic && rolling == Said::automatic) {
        source.fail({kFriction, kRolling},
                    "is \"auto\" like rolling_friction, expected a number for one of the two");
    }
    if (friction == Said::number && rolling == Said::number) {
        source.fail({kTarget, kFriction, kRolling},
                    "is given beside friction and rolling_friction, expected one of these to be "
                    "\"auto\" or absent");
    }
    const double wanted = *contact.reposeAngle;
    const ReposeTable& table = measuredRepose();
    const bool solvesFriction =
        friction == Said::automatic || (friction == Said::nothing && rolling == Said::number);
    if (solvesFriction) {
        checkReach(source, wanted,
                   {kFriction, kRolling, contact.rollingFriction, table.frictions(),
                    table.rollingFrictions(), table.reachByFriction(contact.rollingFriction)});
        contact.friction = table.frictionFor(wanted, contact.rollingFriction).value();
    } else {
        checkReach(source, wanted,
                   {kRolling, kFriction, contact.friction, table.rollingFrictions(),
                    table.frictions(), table.reachByRolling(contact.friction)});
        contact.rollingFriction = table.rollingFrictionFor(wanted, contact.friction).value();
    }
}

}  // namespace sandflow
