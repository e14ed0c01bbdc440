#include "app/commands.h"
#include "app/mesh_figures.h"
#include "app/run_costs.h"
#include "app/scene_doubts.h"
#include "io/json_writer.h"
#include "scene/read_scene.h"
#include "scene/scene_choices.h"
#include "solver/simulation.h"

#include <fmt/format.h>

#include <unistd.h>

namespace sandflow {
namespace {

struct CheckOptions {
    std::string scenePath;
    std::string mode;
    std::vector<std::string> overrides;
    bool json = false;
};

/// All that check has to say.
struct CheckReport {
    RunPlan plan;
    std::vector<EmitterPlan> emitters;
    RunCosts costs;
    std::vector<MeshFigures> meshes;
    std::vector<std::string> doubts;
};

/// The word that a scene file uses.
template <class Choices, class Value>
std::string nameOf(const Choices& choices, Value value)
{
    for (const auto& choice : choices) {
        if (choice.value == value) {
            return choice.name;
        }
    }
    throw InternalError("a choice without a name");
}

double machineMemory()
{
    return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
           static_cast<double>(::sysconf(_SC_PAGESIZE));
}

CheckReport makeReport(const Scene& scene)
{
    CheckReport report;
    // Made as for a run, so that whatever a run would refuse is refused here.
    const std::unique_ptr<Simulation> sand = makeSimulation(scene);
    report.plan = sand->plan();
    report.meshes = describeMeshes(scene, sand->solids());
    report.emitters = planEmitters(scene);
    report.costs = estimateCosts(scene, report.plan, report.emitters);
    report.doubts = findDoubts(scene, sand->solids(), report.plan);
    if (report.costs.memoryBytes > machineMemory()) {
        report.doubts.push_back(
            fmt::format("it needs about {:.3g} GB of memory, and this machine has {:.3g} GB",
                        1e-9 * report.costs.memoryBytes, 1e-9 * machineMemory()));
    }
    return report;
}

std::string formatJson(const Scene& scene, const CheckReport& report)
{
    const RunPlan& plan = report.plan;
    JsonWriter json;
    json.beginObject();
    json.member("scene", scene.name).member("mode", nameOf(words::kModes, scene.mode));
    json.member("grains", plan.grains).member("frames", plan.frames);
    json.member("frame_period_s", plan.framePeriod).member("end_time_s", plan.endTime);
    json.key("emitters").beginArray();
    for (std::size_t e = 0; e < report.emitters.size(); ++e) {
        const EmitterPlan& emitter = report.emitters[e];
        json.beginObject().member("name", scene.emitters[e].name);
        json.member("kind", nameOf(words::kKinds, scene.emitters[e].kind));
        json.member("grains", emitter.count).member("start_s", emitter.start);
        json.member("end_s", emitter.end).endObject();
    }
    json.endArray();
    json.key("meshes").beginArray();
    for (const MeshFigures& mesh : report.meshes) {
        writeMesh(json, mesh);
    }
    json.endArray();
    json.key("load").beginObject();
    json.member("fastest_speed_m_s", plan.load.fastestSpeed);
    json.member("deepest_column_m", plan.load.deepestColumn);
    json.member("min_radius_m", plan.load.minRadius);
    json.member("max_radius_m", plan.load.maxRadius).endObject();
    json.key("stiffness").beginObject();
    json.member("value", plan.law.stiffness).member("automatic", plan.stiffness.automatic);
    json.member("impact_overlap_r", plan.stiffness.impactOverlap);
    json.member("load_overlap_r", plan.stiffness.loadOverlap);
    json.member("reason", plan.stiffness.reason).endObject();
    json.key("step").beginObject();
    json.member("step_s", plan.step.step).member("bound_s", plan.step.bound);
    json.member("reason", plan.step.reason);
    json.member("per_frame", plan.framePeriod / plan.step.step).endObject();
    json.key("repose").beginObject();
    json.member("expected_deg", plan.repose.expected).member("measured", plan.repose.measured);
    json.member("theta0_deg", plan.repose.neutralSlope());
    json.member("reason", plan.repose.reason).endObject();
    json.key("costs").beginObject();
    json.member("grain_steps", report.costs.grainSteps);
    json.member("memory_bytes", report.costs.memoryBytes);
    json.member("frame_bytes", report.costs.frameBytes).endObject();
    json.key("doubts").beginArray();
    for (const std::string& doubt : report.doubts) {
        json.value(doubt);
    }
    json.endArray().endObject();
    return json.text();
}

std::string formatBytes(double bytes)
{
    return bytes < 1e9 ? fmt::format("{:.0f} MB", 1e-6 * bytes)
                       : fmt::format("{:.3g} GB", 1e-9 * bytes);
}

std::string formatText(const Scene& scene, const CheckReport& report)
{
    const RunPlan& plan = report.plan;
    std::string text =
        fmt::format("{}: can run, in {} mode\n", scene.name, nameOf(words::kModes, scene.mode));
    for (std::size_t e = 0; e < report.emitters.size(); ++e) {
        const EmitterPlan& emitter = report.emitters[e];
        text += fmt::format("  {:<12} {:<7} {:>10} grains, {}\n",
                            scene.emitters[e].name.empty() ? fmt::format("emitters[{}]", e)
                                                           : scene.emitters[e].name,
                            nameOf(words::kKinds, scene.emitters[e].kind), emitter.count,
                            emitter.end > emitter.start
                                ? fmt::format("{:.4g} s to {:.4g} s", emitter.start, emitter.end)
                                : fmt::format("all at {:.4g} s", emitter.start));
    }
    for (const MeshFigures& mesh : report.meshes) {
        text += "  " + formatMesh(mesh) + '\n';
    }
    text += fmt::format("grains     {} in all, radii {:.4g} to {:.4g} mm\n", plan.grains,
                        1e3 * plan.load.minRadius, 1e3 * plan.load.maxRadius);
    text += fmt::format("time       {} frames of {:.4g} s, end at {:.4g} s\n", plan.frames,
                        plan.framePeriod, plan.endTime);
    text += fmt::format("load       fastest grain {:.3g} m/s, deepest column of sand {:.3g} m\n",
                        plan.load.fastestSpeed, plan.load.deepestColumn);
    text += fmt::format("stiffness  {}\n", plan.stiffness.reason);
    text += fmt::format("           predicted overlap: {:.2g} r at impact, {:.2g} r under load\n",
                        plan.stiffness.impactOverlap, plan.stiffness.loadOverlap);
    text += fmt::format("step       {:.3g} s, {:.0f} a frame; bound {:.3g} s set by {}\n",
                        plan.step.step, plan.framePeriod / plan.step.step, plan.step.bound,
                        plan.step.reason);
    text += fmt::format("repose     {}\n", plan.repose.material);
    if (scene.mode == Mode::surfaceFlow) {
        text += fmt::format("           {}\n", plan.repose.reason);
    }
    text += fmt::format(
        "costs      about {} of memory ({:.0f} bytes a computed grain, {:.0f} a buried one), {} of "
        "picture files; {:.2g} grain-steps if none were skipped\n",
        formatBytes(report.costs.memoryBytes), kBytesPerMobile, kBytesPerBuried,
        formatBytes(report.costs.frameBytes), report.costs.grainSteps);
    text += report.doubts.empty() ? "doubts     none\n" : "doubts\n";
    for (const std::string& doubt : report.doubts) {
        text += fmt::format("  - {}\n", doubt);
    }
    return text;
}

ExitCode checkScene(const CheckOptions& options)
{
    std::vector<std::string> overrides = options.overrides;
    if (!options.mode.empty()) {
        overrides.push_back("mode=\"" + options.mode + "\"");
    }
    const Scene scene = readScene(options.scenePath, overrides);
    const CheckReport report = makeReport(scene);
    fmt::print("{}", options.json ? formatJson(scene, report) : formatText(scene, report));
    return ExitCode::done;
}

}  // namespace

void addCheckCommand(CLI::App& app, Action& action)
{
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand(
        "check", "Read a scene, report sizes, costs and doubts; simulate nothing");
    command->add_option("scene", options->scenePath, "Scene file (TOML)")->required();
    command->add_option("--mode", options->mode, "surface-flow or dem")
        ->check(CLI::IsMember({"surface-flow", "dem"}));
    command->add_option("--set", options->overrides, "Another value for a scene key: KEY=VALUE")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options, &action] { action = [options] { return checkScene(*options); }; });
}

}  // namespace sandflow
