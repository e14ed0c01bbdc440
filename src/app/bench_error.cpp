#include "app/bench_error.h"

#include "app/environment.h"
#include "app/scene_floor.h"
#include "io/atomic_file.h"
#include "scene/read_scene.h"
#include "study/error_plot.h"
#include "study/error_report.h"
#include "study/error_study.h"
#include "study/gnuplot.h"
#include "study/study_folder.h"

#include <fmt/format.h>
#include <omp.h>

#include <cstdio>

namespace sandflow {
namespace {

struct ErrorBenchOptions {
    ErrorStudyPlan plan;
    std::vector<std::string> from;
    std::string folder;
    std::string measure = "radial";
    std::string clock = "wall";
    int threads = 0;
    bool noPlot = false;
    bool json = false;
};

void printTrial(const ErrorTrial& trial, std::size_t done, std::size_t planned)
{
    const std::string outcome =
        trial.isReference() && trial.end == TrialEnd::finished ? ""
        : trial.end == TrialEnd::finished
            ? fmt::format(", {:.3f} d radial, {:.3f} d on cells", trial.errors.radial,
                          trial.errors.cells)
            : fmt::format(", {}: {}", nameOf(trial.end), trial.message);
    fmt::print(stderr, "[{}/{}] seed {}, {}: {:.1f} s{}\n", done, planned, trial.seed,
               labelOf(trial.setting), trial.wallSeconds, outcome);
}

ErrorEvaluation evaluateRecord(const ErrorStudyRecord& record, const ErrorBenchOptions& options)
{
    return evaluateErrors(
        record.trials, record.referencePairs,
        options.measure == "cells" ? ErrorMeasure::cells : ErrorMeasure::radial,
        options.clock == "processor" ? StudyClock::processor : StudyClock::wall);
}

void writePlots(const ErrorEvaluation& evaluation, const std::string& scene,
                const std::string& folder)
{
    const std::string seeds =
        fmt::format("{} seed{}", evaluation.seeds.size(), evaluation.seeds.size() == 1 ? "" : "s");
    plotWithGnuplot(folder + "/front.gp",
                    scriptOfFront(evaluation, fmt::format("{}: run time against error, {}", scene,
                                                          seeds),
                                  folder + "/front.png"));
    plotWithGnuplot(folder + "/sweeps.gp",
                    scriptOfSweeps(evaluation,
                                   fmt::format("{}: run time (x) against error (y) of each "
                                               "approximation, {}; red: default; bars: all seeds",
                                               scene, seeds),
                                   folder + "/sweeps.png"));
}

ExitCode runErrorBench(ErrorBenchOptions options)
{
    if (options.plan.scenePath.empty() == options.from.empty()) {
        throw InputError("bench error: name either a scene to study or, with --from, studies to "
                         "evaluate again");
    }
    useThreads(options.threads);
    if (!options.noPlot) {
        requireGnuplot();
    }
    if (options.from.empty()) {
        if (options.folder.empty()) {
            const Scene scene = readScene(options.plan.scenePath, options.plan.overrides);
            options.folder = "runs/" + scene.name + "-error";
        }
        runErrorStudy(options.plan, options.folder, makeSceneFloor, printTrial);
        options.from = {options.folder};
    } else if (!options.folder.empty()) {
        makeStudyFolder(options.folder);
    }
    const ErrorStudyRecord record = readErrorStudies(options.from, makeSceneFloor);
    const ErrorEvaluation evaluation = evaluateRecord(record, options);
    if (!options.folder.empty()) {
        writeFileAtomically(options.folder + "/settings.csv", errorsAsCsv(evaluation));
        if (!options.noPlot) {
            writePlots(evaluation, record.scene.name, options.folder);
        }
    }
    fmt::print("{}", options.json ? errorsAsJson(evaluation, record.scene.name, describeVersion(),
                                                 omp_get_max_threads())
                                  : describeErrors(evaluation));
    if (!options.json && !options.folder.empty()) {
        fmt::print("study folder: {}\n", options.folder);
    }
    return ExitCode::done;
}

}  // namespace

void addErrorBench(CLI::App& bench, Action& action)
{
    auto options = std::make_shared<ErrorBenchOptions>();
    CLI::App* command = bench.add_subcommand(
        "error", "Run time against error of every approximation, one changed at a time, each "
                 "against a reference (dem, stiff, small step) of the same seed");
    command->add_option("scene", options->plan.scenePath, "Scene file (TOML)");
    command->add_option("--out", options->folder,
                        "Folder to make for tables and plots (default: runs/NAME-error)");
    command->add_option("--seeds", options->plan.seeds, "Seeds, from the scene's on (default 2)")
        ->check(CLI::Range(1, 1000));
    command->add_option("--set", options->plan.overrides,
                        "Another value for a scene key, in every trial: KEY=VALUE; the way to a "
                        "smaller scene, as --set emitters[0].count=5000")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command->add_flag("--quick", options->plan.quick, "Only the two ends of each sweep");
    command->add_option("--reference-stiffness", options->plan.reference.stiffness,
                        "Stiffness of the reference over the scene's (default 10)")
        ->check(CLI::Range(1.0, 1e4));
    command->add_option("--reference-step", options->plan.reference.stepSafety,
                        "Step of the reference over the stability bound (default 0.4)")
        ->check(CLI::Range(0.001, 1.0));
    command->add_option("--measure", options->measure,
                        "The error that counts: radial (a single heap) or cells (any scene)")
        ->check(CLI::IsMember({"radial", "cells"}));
    command->add_option("--clock", options->clock,
                        "The time that counts: wall, or processor on a busy machine")
        ->check(CLI::IsMember({"wall", "processor"}));
    command->add_option("--from", options->from,
                        "Run nothing: evaluate this study's trials, or several studies' of one "
                        "scene with different seeds")
        ->type_name("DIR")
        ->allow_extra_args(false);
    command->add_option("--threads", options->threads, "Threads (default: all processors)");
    command->add_flag("--no-plot", options->noPlot, "No pictures, no gnuplot");
    command->add_flag("--json", options->json, "Print JSON");
    command->callback(
        [options, &action] { action = [options] { return runErrorBench(*options); }; });
}

}  // namespace sandflow
