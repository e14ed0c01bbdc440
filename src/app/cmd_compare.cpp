#include "app/commands.h"
#include "app/run_figures.h"
#include "app/scene_floor.h"
#include "io/json_writer.h"
#include "io/run_folder.h"
#include "io/state_file.h"
#include "measure/compare.h"
#include "scene/read_scene.h"

#include <fmt/format.h>

namespace sandflow {
namespace {

struct CompareOptions {
    std::string runA;
    std::string runB;
    bool json = false;
};

struct Run {
    std::string path;
    RunFigures figures;
    Snapshot last;
};

Run readRun(const std::string& path)
{
    const RunFolder folder(path, FolderUse::read);
    return {path, readRunFigures(path), readState(folder.findState(std::nullopt))};
}

/// True if both hold the same grains, to the last bit.
bool areIdentical(const Snapshot& a, const Snapshot& b)
{
    return a.time == b.time && a.id == b.id && a.position == b.position &&
           a.velocity == b.velocity && a.spin == b.spin && a.radius == b.radius &&
           a.state == b.state;
}

void writeShares(JsonWriter& json, std::string_view name, const GrainShares& shares)
{
    json.key(name).beginObject();
    json.member("mobile", shares.mobile).member("awake", shares.awake);
    json.member("interface", shares.interface).member("buried", shares.buried).endObject();
}

void writeRun(JsonWriter& json, std::string_view name, const Run& run, const HeapFigures& heap)
{
    const RunFigures& f = run.figures;
    json.key(name).beginObject();
    json.member("run", run.path).member("grains", f.grains).member("exited", f.exited);
    json.member("frames", f.frames).member("end_time_s", f.endTime);
    json.member("last_emission_s", f.lastEmission);
    writeShares(json, "share_at_end", f.atEnd);
    writeShares(json, "share_pouring", f.pouring);
    json.member("wall_s_per_frame", f.wallPerFrame).member("steps_per_frame", f.stepsPerFrame);
    json.member("dt_mean_s", f.step).member("ledger_ok", f.ledgerOk);
    json.key("repose_deg");
    if (heap.reposeDeg) {
        json.value(*heap.reposeDeg);
    } else {
        json.null();
    }
    json.member("apex_m", heap.apex).member("r90_m", heap.r90).member("foot_m", heap.foot);
    json.member("volume_m3", heap.volume).member("solid_fraction", heap.solidFraction);
    json.endObject();
}

void writeDifference(JsonWriter& json, std::string_view name, const HeightDifference& difference)
{
    json.key(name).beginObject();
    json.member("mean_d", difference.mean).member("rms_d", difference.rms);
    json.member("bias_d", difference.bias).member("worst_d", difference.worst);
    json.member("places", difference.places).endObject();
}

std::string formatJson(const Run& a, const Run& b, const HeapComparison& heaps)
{
    JsonWriter json;
    json.beginObject();
    writeRun(json, "a", a, heaps.a);
    writeRun(json, "b", b, heaps.b);
    json.key("difference").beginObject();
    json.member("identical", areIdentical(a.last, b.last)).member("diameter_m", heaps.diameter);
    writeDifference(json, "height_radial", heaps.radial);
    writeDifference(json, "height_cells", heaps.cells);
    json.member("centroid_d", heaps.centroidShift).member("apex_d", heaps.apexDifference);
    json.key("repose_deg");
    if (heaps.reposeDifference) {
        json.value(*heaps.reposeDifference);
    } else {
        json.null();
    }
    json.member("r90_percent", heaps.r90Difference).member("foot_d", heaps.footDifference);
    json.member("volume_percent", heaps.volumeDifference);
    json.member("grains", heaps.countDifference);
    json.key("wall_ratio");  // b over a
    if (a.figures.wallPerFrame > 0.0) {
        json.value(b.figures.wallPerFrame / a.figures.wallPerFrame);
    } else {
        json.null();
    }
    json.endObject().endObject();
    return json.text();
}

std::string formatRow(std::string_view name, const std::string& a, const std::string& b)
{
    return fmt::format("{:<32} {:>12} {:>12}\n", name, a, b);
}

std::string formatText(const Run& a, const Run& b, const HeapComparison& heaps)
{
    const auto percent = [](double share) { return fmt::format("{:.1f} %", 100.0 * share); };
    const auto number = [](auto value) { return fmt::format("{}", value); };
    const RunFigures& fa = a.figures;
    const RunFigures& fb = b.figures;
    const auto shareRows = [&](std::string_view when, const GrainShares& sa,
                               const GrainShares& sb) {
        return formatRow(fmt::format("mobile {}", when), percent(sa.mobile), percent(sb.mobile)) +
               formatRow("  of which awake", percent(sa.awake), percent(sb.awake)) +
               formatRow(fmt::format("interface {}", when), percent(sa.interface),
                         percent(sb.interface));
    };
    std::string text = fmt::format("A: {}\nB: {}\n", a.path, b.path);
    text += formatRow("run", "A", "B");
    text += formatRow("grains emitted", number(fa.grains), number(fb.grains));
    text += formatRow("exited", number(fa.exited), number(fb.exited));
    text += formatRow("frames", number(fa.frames), number(fb.frames));
    text += formatRow("simulated time, s", fmt::format("{:.3f}", fa.endTime),
                      fmt::format("{:.3f}", fb.endTime));
    text += shareRows("at the end", fa.atEnd, fb.atEnd);
    text += shareRows("in the last 1 s of pouring", fa.pouring, fb.pouring);
    text += formatRow("wall s per frame, pouring", fmt::format("{:.4f}", fa.wallPerFrame),
                      fmt::format("{:.4f}", fb.wallPerFrame));
    text += formatRow("steps per frame, pouring", fmt::format("{:.1f}", fa.stepsPerFrame),
                      fmt::format("{:.1f}", fb.stepsPerFrame));
    text +=
        formatRow("mean step, s", fmt::format("{:.3e}", fa.step), fmt::format("{:.3e}", fb.step));
    text += formatRow("ledger", fa.ledgerOk ? "balances" : "BROKEN",
                      fb.ledgerOk ? "balances" : "BROKEN");
    text += "\n" + describe(heaps);
    text += areIdentical(a.last, b.last) ? "the last states are identical, bit for bit\n" : "";
    return text;
}

ExitCode compareRuns(const CompareOptions& options)
{
    const Run a = readRun(options.runA);
    const Run b = readRun(options.runB);
    const Scene scene = readScene(RunFolder(a.path, FolderUse::read).scenePath());
    const HeapComparison heaps = compareHeaps(a.last, b.last, makeSceneFloor(scene, a.last.time));
    fmt::print("{}", options.json ? formatJson(a, b, heaps) : formatText(a, b, heaps));
    return ExitCode::done;
}

}  // namespace

void addCompareCommand(CLI::App& app, Action& action)
{
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand(
        "compare", "Compare two runs: heap shape in grain diameters and degrees, shares, cost");
    command->add_option("run_a", options->runA, "Run folder A, the reference")->required();
    command->add_option("run_b", options->runB, "Run folder B")->required();
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options, &action] { action = [options] { return compareRuns(*options); }; });
}

}  // namespace sandflow
