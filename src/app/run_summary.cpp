#include "app/run_summary.h"

#include "app/environment.h"
#include "dem/force_kernel.h"
#include "measure/heap.h"

#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>

namespace sandflow {
namespace {

constexpr double kAfterLastEmission = 0.5;  // s that still count as the busy part of a run

std::int64_t peakRssBytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} * 1024;
}

std::string modeName(const Scene& scene)
{
    return scene.mode == Mode::dem ? "dem" : "surface-flow";
}

void writeRelease(JsonWriter& json, const ReleaseFigures& release)
{
    json.key("release").beginObject();
    json.member("seconds", release.seconds).member("apex_moved_d", release.apexMoved);
    json.member("mean_dh_d", release.meanHeightChange);
    json.member("repose_moved_deg", release.reposeMoved);
    json.member("fastest_m_s", release.fastest).member("could_fall_m_s", release.couldFall);
    json.endObject();
}

std::string describeRelease(const ReleaseFigures& release)
{
    return fmt::format(
        "set free for {:.3g} s: apex moved {:+.3f} d, mean |dH| {:.3f} d, repose {} deg, fastest "
        "grain {:.3f} m/s where a fall makes {:.3f} m/s\n",
        release.seconds, release.apexMoved, release.meanHeightChange,
        release.reposeMoved ? fmt::format("{:+.2f}", *release.reposeMoved) : "none",
        release.fastest, release.couldFall);
}

}  // namespace

std::string findPovrayFolder()
{
    const char* own = std::getenv("SANDFLOW_POVRAY_PATH");
    const std::string folder = own ? own : SANDFLOW_POVRAY_DIR;
    if (!std::filesystem::exists(folder + "/materials.inc")) {
        throw InputError(fmt::format("{}: no POV-Ray materials here; set SANDFLOW_POVRAY_PATH to the "
                                     "povray folder of the sources, or run with --no-frames",
                                     folder));
    }
    return folder;
}

void RunSummary::add(const FrameReport& report, const FrameRow& row)
{
    reports_.push_back(report);
    rows_.push_back(row);
    transfer_ += report.transfer;
}

void RunSummary::finish(const Simulation& sand, const Snapshot& last)
{
    meshes_ = describeMeshes(scene_, sand.solids());
    hash_ = sand.stateHash();
    bytesMobile_ = sand.bytesMobile();
    bytesBuried_ = sand.bytesBuried();
    bytesCover_ = sand.bytesCover();
    const HeapFigures heap = measureHeap(last);
    apex_ = heap.apex;
    r90_ = heap.r90;
    repose_ = heap.reposeDeg;
}

/// From the first emission to half a second after the last: the part that works.
double RunSummary::meanWall() const
{
    double sum = 0.0, lastGrowth = 0.0;
    std::uint64_t emitted = 0, count = 0;
    for (const FrameRow& row : rows_) {
        lastGrowth = row.emitted > emitted ? row.time : lastGrowth;
        emitted = row.emitted;
    }
    for (const FrameRow& row : rows_) {
        if (row.emitted > 0 && row.time <= lastGrowth + kAfterLastEmission) {
            sum += row.wall;
            ++count;
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Momentum that grains lost because they were fixed while they still moved, over what they brought;
/// none where nothing has landed.
std::optional<double> RunSummary::trappedShare() const
{
    return transfer_.landedMomentum > 0.0
               ? std::optional(transfer_.trappedMomentum / transfer_.landedMomentum)
               : std::nullopt;
}

JsonWriter RunSummary::json() const
{
    const FrameRow last = rows_.empty() ? FrameRow{} : rows_.back();
    const Ledger ledger = reports_.empty() ? Ledger{} : reports_.back().ledger;
    std::uint64_t steps = 0, grainSteps = 0, skipped = 0, rebuilds = 0;
    double time = 0.0;
    for (const FrameReport& r : reports_) {
        steps += r.steps, grainSteps += r.grainSteps, skipped += r.skippedGrainSteps;
        rebuilds += r.rebuilds, time += r.dtMean * static_cast<double>(r.steps);
    }
    JsonWriter json;
    json.beginObject();
    json.member("scene", scene_.name).member("mode", modeName(scene_));
    json.member("version", describeVersion()).member("simd_target", kernelTargetName());
    json.member("threads", omp_get_max_threads()).member("seed", scene_.seed);
    json.member("grains", ledger.emitted).member("frames", rows_.size());
    json.member("mobile", ledger.mobile).member("asleep", ledger.asleep);
    json.member("interface", ledger.interface).member("buried", ledger.buried);
    json.member("exited", ledger.exited);
    json.member("ledger_ok", ledger.balances()).member("leaks", leaks_);
    json.member("held_back", reports_.empty() ? 0 : reports_.back().heldBack);
    json.member("mean_wall_s_per_frame", meanWall());
    json.member("steps", steps).member("rebuilds", rebuilds);
    json.member("dt_mean_s", steps > 0 ? time / static_cast<double>(steps) : 0.0);
    json.member("dt_reason", plan_.step.reason);
    json.member("stiffness", plan_.law.stiffness);
    json.member("stiffness_reason", plan_.stiffness.reason);
    json.member("peak_rss_bytes", peakRssBytes());
    json.member("dem_bytes", bytesMobile_).member("cover_bytes", bytesCover_);
    json.member("buried_bytes", bytesBuried_);
    json.member("state_hash", fmt::format("{:016x}", hash_));
    json.key("heap").beginObject();
    json.member("repose_deg", repose_);
    json.member("apex_m", apex_).member("r90_m", r90_).endObject();
    json.key("meshes").beginArray();
    for (const MeshFigures& mesh : meshes_) {
        writeMesh(json, mesh);
    }
    json.endArray();
    json.key("transfer").beginObject();
    json.member("trapped", transfer_.trapped).member("dislodged", transfer_.dislodged);
    json.member("buried", transfer_.buried).member("uncovered", transfer_.uncovered);
    json.member("fell_asleep", transfer_.fellAsleep).member("woken", transfer_.woken);
    json.member("trapped_momentum_kg_m_s", transfer_.trappedMomentum);
    json.member("landed_momentum_kg_m_s", transfer_.landedMomentum).endObject();
    json.member("trapped_momentum_share", trappedShare());
    if (release_) {
        writeRelease(json, *release_);
    }
    json.key("skipped").beginObject();
    json.member("grain_steps_done", grainSteps).member("grain_steps_skipped", skipped);
    json.endObject();
    json.member("last_frame_time_s", last.time);
    json.endObject();
    return json;
}

std::string RunSummary::text() const
{
    const Ledger ledger = reports_.empty() ? Ledger{} : reports_.back().ledger;
    const auto share = [&](std::uint64_t n) {
        return ledger.emitted ? 100.0 * static_cast<double>(n) / static_cast<double>(ledger.emitted)
                              : 0.0;
    };
    std::uint64_t done = 0, skipped = 0;
    for (const FrameReport& r : reports_) {
        done += r.grainSteps, skipped += r.skippedGrainSteps;
    }
    std::string out;
    out += fmt::format(
        "{} grains: {} mobile ({:.1f} %, of which {} asleep), {} interface ({:.1f} %), {} buried "
        "({:.1f} %), {} exited; ledger {}\n",
        ledger.emitted, ledger.mobile, share(ledger.mobile), ledger.asleep, ledger.interface,
        share(ledger.interface), ledger.buried, share(ledger.buried), ledger.exited,
        ledger.balances() ? "balances" : "DOES NOT BALANCE");
    out += fmt::format("heap: repose {} deg, apex {:.4f} m, r90 {:.4f} m; leaks {}\n",
                       repose_ ? fmt::format("{:.2f}", *repose_) : "none", apex_, r90_, leaks_);
    if (!reports_.empty() && reports_.back().heldBack > 0) {
        out += fmt::format("{} grains never came in: their place at the emitter was taken to the "
                           "end (sand lies there, or a solid)\n",
                           reports_.back().heldBack);
    }
    out += fmt::format("{:.4f} s/frame while pouring; skipped {:.1f} % of all grain steps; state "
                       "{:016x}\n",
                       meanWall(),
                       done + skipped ? 100.0 * static_cast<double>(skipped) /
                                            static_cast<double>(done + skipped)
                                      : 0.0,
                       hash_);
    if (trappedShare()) {
        out += fmt::format("momentum lost to trapping: {:.3f} % of what landed\n",
                           100.0 * *trappedShare());
    }
    if (release_) {
        out += describeRelease(*release_);
    }
    return out;
}

}  // namespace sandflow
