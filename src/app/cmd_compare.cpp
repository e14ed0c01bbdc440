#include "app/commands.h"
#include "app/run_figures.h"
#include "app/scene_floor.h"
#include "io/json_writer.h"
#include "io/run_folder.h"
#include "io/state_file.h"
#include "measure/compare.h"
#include "measure/crater.h"
#include "scene/read_scene.h"

#include <fmt/format.h>

#include <optional>

namespace sandflow {
namespace {

struct CompareOptions {
    std::string runA;
    std::string runB;
    std::optional<std::uint64_t> frame, since;
    bool json = false;
};

struct Run {
    std::string path;
    RunFigures figures;
    Snapshot sand;                ///< at the end, or at the frame asked for
    std::optional<Snapshot> before;  ///< where a crater since then is asked for
};

Run readRun(const std::string& path, const CompareOptions& options)
{
    const RunFolder folder(path, FolderUse::read);
    Run run{path, readRunFigures(path), readState(folder.findState(options.frame)), std::nullopt};
    if (options.since) {
        run.before = readState(folder.findState(options.since));
    }
    return run;
}

/// What was dug in each run since the earlier frame.
struct Craters {
    CraterFigures a, b;

    /// In d, b minus a.
    double depthDifference(double diameter) const { return (b.depth - a.depth) / diameter; }
    /// % of a's; none if a has none.
    std::optional<double> volumeDifference() const
    {
        return a.volume > 0.0 ? std::optional(100.0 * (b.volume / a.volume - 1.0)) : std::nullopt;
    }
};

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

void writeCrater(JsonWriter& json, std::string_view name, const CraterFigures& crater)
{
    json.key(name).beginObject();
    json.member("x_m", crater.centre.x()).member("y_m", crater.centre.y());
    json.member("depth_m", crater.depth).member("volume_m3", crater.volume);
    json.member("rim_m", crater.rim).endObject();
}

void writeCraters(JsonWriter& json, const Craters& craters, double diameter)
{
    json.key("crater").beginObject();
    writeCrater(json, "a", craters.a);
    writeCrater(json, "b", craters.b);
    json.member("depth_d", craters.depthDifference(diameter));
    json.member("volume_percent", craters.volumeDifference());
    json.endObject();
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
    json.member("repose_deg", heap.reposeDeg);
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

std::string formatJson(const Run& a, const Run& b, const HeapComparison& heaps,
                       const std::optional<Craters>& craters)
{
    JsonWriter json;
    json.beginObject();
    writeRun(json, "a", a, heaps.a);
    writeRun(json, "b", b, heaps.b);
    json.key("difference").beginObject();
    json.member("identical", areIdentical(a.sand, b.sand)).member("diameter_m", heaps.diameter);
    writeDifference(json, "height_radial", heaps.radial);
    writeDifference(json, "height_cells", heaps.cells);
    json.member("centroid_d", heaps.centroidShift).member("apex_d", heaps.apexDifference);
    json.member("repose_deg", heaps.reposeDifference);
    json.member("r90_percent", heaps.r90Difference).member("foot_d", heaps.footDifference);
    json.member("volume_percent", heaps.volumeDifference);
    json.member("grains", heaps.countDifference);
    json.member("wall_ratio",  // b over a
                a.figures.wallPerFrame > 0.0
                    ? std::optional(b.figures.wallPerFrame / a.figures.wallPerFrame)
                    : std::nullopt);
    json.endObject();
    if (craters) {
        writeCraters(json, *craters, heaps.diameter);
    }
    json.endObject();
    return json.text();
}

std::string formatRow(std::string_view name, const std::string& a, const std::string& b)
{
    return fmt::format("{:<32} {:>12} {:>12}\n", name, a, b);
}

std::string formatCraters(const Run& a, const Craters& craters, double diameter)
{
    const auto millimetres = [](double length) { return fmt::format("{:.1f}", 1e3 * length); };
    const auto litres = [](double volume) { return fmt::format("{:.4f}", 1e3 * volume); };
    const auto difference = craters.volumeDifference();
    std::string text = fmt::format("\nsunk since frame {}, between grains of then\n",
                                   a.before->frame);
    text += formatRow("crater", "A", "B");
    text += formatRow("depth, mm", millimetres(craters.a.depth), millimetres(craters.b.depth));
    text += formatRow("rim, mm", millimetres(craters.a.rim), millimetres(craters.b.rim));
    text += formatRow("volume, dm3", litres(craters.a.volume), litres(craters.b.volume));
    text += fmt::format("B - A: depth {:+.2f} d, volume {}\n", craters.depthDifference(diameter),
                        difference ? fmt::format("{:+.1f} %", *difference) : "none in A");
    return text;
}

std::string formatText(const Run& a, const Run& b, const HeapComparison& heaps,
                       const std::optional<Craters>& craters)
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
    text += areIdentical(a.sand, b.sand) ? "the states are identical, bit for bit\n" : "";
    if (craters) {
        text += formatCraters(a, *craters, heaps.diameter);
    }
    return text;
}

ExitCode compareRuns(const CompareOptions& options)
{
    const Run a = readRun(options.runA, options);
    const Run b = readRun(options.runB, options);
    const Scene scene = readScene(RunFolder(a.path, FolderUse::read).scenePath());
    const FloorHeight floor = makeSceneFloor(scene, a.sand.time);
    const HeapComparison heaps = compareHeaps(a.sand, b.sand, floor);
    std::optional<Craters> craters;
    if (options.since) {
        craters = {measureCrater(*a.before, a.sand, floor),
                   measureCrater(*b.before, b.sand, floor)};
    }
    fmt::print("{}", options.json ? formatJson(a, b, heaps, craters)
                                  : formatText(a, b, heaps, craters));
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
    command->add_option("--frame", options->frame,
                        "Compare the sand of this frame, not the last (of runs with --keep-states)");
    command->add_option("--since", options->since,
                        "Also the crater dug since this frame: depth and volume");
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options, &action] { action = [options] { return compareRuns(*options); }; });
}

}  // namespace sandflow
