#include "app/run_driver.h"

#include "app/environment.h"
#include "app/progress.h"
#include "app/run_summary.h"
#include "app/scene_floor.h"
#include "app/seen_through.h"
#include "core/stage_clock.h"
#include "io/atomic_file.h"
#include "io/frame_log.h"
#include "io/picture_extent.h"
#include "io/pov_frame.h"
#include "io/pov_scene.h"
#include "io/run_folder.h"
#include "io/state_file.h"
#include "measure/release.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "solids/resolve_meshes.h"
#include "solver/simulation.h"

#include <fmt/format.h>

#include <cmath>

namespace sandflow {
namespace {

Scene readRunScene(const RunOptions& options)
{
    std::vector<std::string> overrides = options.overrides;
    if (!options.mode.empty()) {
        overrides.push_back("mode=\"" + options.mode + "\"");
    }
    if (options.seed) {
        overrides.push_back(fmt::format("seed={}", *options.seed));
    }
    if (options.noSkip) {
        overrides.push_back("skip.sleep=false");
    }
    return readScene(options.scenePath, overrides);
}

FrameRow makeRow(const FrameReport& r, double meanRadius)
{
    FrameRow row;
    row.frame = r.frame;
    row.time = r.time;
    row.steps = r.steps;
    row.dtMin = r.dtMin;
    row.dtMean = r.dtMean;
    row.emitted = r.ledger.emitted;
    row.mobile = r.ledger.mobile;
    row.asleep = r.ledger.asleep;
    row.interface = r.ledger.interface;
    row.buried = r.ledger.buried;
    row.exited = r.ledger.exited;
    row.maxOverlap = r.deepestOverlap / meanRadius;
    row.kineticEnergy = r.kineticEnergy;
    row.surfaceFlowTime = r.seconds.surfaceFlow;
    row.transferTime = r.seconds.transfer;
    row.rebuildTime = r.seconds.rebuild;
    row.forcesTime = r.seconds.forces;
    row.emitTime = r.seconds.emit;
    return row;
}

void printPlan(const Scene& scene, const RunPlan& plan)
{
    fmt::print("{}: {} grains, {} mode, {} frames of {:.4g} s\n", scene.name, plan.grains,
               scene.mode == Mode::dem ? "dem" : "surface-flow", plan.frames, plan.framePeriod);
    fmt::print("  stiffness {:.4g}: {}\n", plan.law.stiffness, plan.stiffness.reason);
    fmt::print("  step {:.3g} s (bound {:.3g} s): {}\n", plan.step.step, plan.step.bound,
               plan.step.reason);
    if (scene.mode == Mode::surfaceFlow) {
        fmt::print("  {}\n", plan.repose.reason);
    }
}

/// Frames that `seconds` take, the last one perhaps longer.
std::uint64_t countFrames(double seconds, double framePeriod)
{
    return static_cast<std::uint64_t>(std::ceil(seconds / framePeriod - 1e-9));
}

/// The scene as it was run, but for its meshes: with the slopes that were used.
Scene resolveSlopes(Scene scene, const RunPlan& plan)
{
    scene.surfaceFlow.reposeAngle = plan.repose.angle;
    scene.surfaceFlow.reposeMargin = plan.repose.margin;
    return scene;
}

/// For the picture; none if there is no picture.
std::vector<SceneMesh> copyMeshes(const SolidSet& solids, bool wanted)
{
    std::vector<SceneMesh> copies;
    for (const MeshSolid& mesh : solids.meshes()) {
        if (wanted) {
            copies.push_back({static_cast<std::size_t>(mesh.solid), mesh.mesh});
        }
    }
    return copies;
}

}  // namespace

ExitCode runScene(const RunOptions& options)
{
    useThreads(options.threads);
    useKernel(options.simd);
    const Scene scene = readRunScene(options);
    const std::unique_ptr<Simulation> sand = makeSimulation(scene);
    const RunPlan& plan = sand->plan();
    const std::string modeName = scene.mode == Mode::dem ? "dem" : "surface-flow";
    const RunFolder folder(
        options.folder.empty() ? "runs/" + scene.name + "-" + modeName : options.folder,
        options.force ? FolderUse::force : FolderUse::fresh);

    const std::uint64_t ordinary = std::min(plan.frames, options.frames.value_or(plan.frames));
    const std::uint64_t frames =
        ordinary + countFrames(options.releaseSeconds.value_or(0.0), plan.framePeriod);
    if (!options.quiet) {
        printPlan(scene, plan);
    }
    for (const std::string& notice : sand->solids().notices()) {
        fmt::print(stderr, "note: {}\n", notice);
    }
    writeFileAtomically(folder.scenePath(),
                        writeScene(resolveMeshes(resolveSlopes(scene, plan), sand->solids())));
    const std::vector<SceneMesh> meshes = copyMeshes(sand->solids(), !options.noFrames);
    if (!options.noFrames) {
        writePovScene(folder.path(), findPovrayFolder(), scene,
                      {frames, estimateSandBox(scene, meshes)}, meshes);
    }

    const std::function<bool(const Vec3&)> isSeen = findSeenThrough(scene, sand->solids());
    FrameLog log(folder.frameLogPath());
    Progress progress(frames, options.quiet);
    RunSummary summary(scene, plan);
    Snapshot snapshot;
    const auto runFrame = [&](std::uint64_t f) {
        double wall = 0.0;
        FrameRow row;
        FrameReport report;
        {
            StageClock frameClock(wall);
            report = sand->advanceFrame();
            row = makeRow(report, scene.grains.radius);
            StageClock outputClock(row.outputTime);
            if (!options.noFrames || options.keepStates || f >= ordinary) {
                sand->takeSnapshot(snapshot);
            }
            if (!options.noFrames) {
                row.exported = writePovFrame(folder.framePath(f), snapshot,
                                             {options.allGrains, isSeen, GrainColour::family});
            }
            if (options.keepStates) {
                writeState(folder.statePath(f), snapshot);
            }
            summary.addLeaks(sand->countLeaks());
        }
        row.wall = wall;
        if (f <= ordinary) {
            summary.add(report, row);
        }
        log.append(row);
        progress.show(row);
    };
    for (std::uint64_t f = 1; f <= ordinary; ++f) {
        runFrame(f);
    }
    summary.finish(*sand, snapshot);
    if (options.releaseSeconds) {
        sand->takeSnapshot(snapshot);  // also of a run of no frames
        ReleaseWatch watch(snapshot, makeSceneFloor(scene, snapshot.time), scene.gravity.norm());
        sand->releaseAll();
        for (std::uint64_t f = ordinary + 1; f <= frames; ++f) {
            runFrame(f);
            watch.look(snapshot);
        }
        summary.addRelease(watch.figures(snapshot));
    }
    writeState(folder.lastStatePath(), snapshot);
    if (!options.noFrames) {
        writePovScene(folder.path(), findPovrayFolder(), scene, {frames, measureSandBox(snapshot)},
                      meshes);
    }
    folder.writeSummary(summary.json());
    progress.finish();
    fmt::print("{}", summary.text());
    fmt::print("run folder: {}\n", folder.path());
    return ExitCode::done;
}

}  // namespace sandflow
