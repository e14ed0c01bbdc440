#include "app/bench_error.h"
#include "app/bench_kernel.h"
#include "app/bench_stability.h"
#include "app/commands.h"
#include "app/environment.h"
#include "dem/kernel_target.h"
#include "io/json_writer.h"

#include <fmt/format.h>

namespace sandflow {
namespace {

struct BenchOptions {
    KernelBenchOptions kernel;
    std::size_t grains = 107687;
    int threads = 0;
    std::string simd = "auto";
    std::string positions;
    std::string writePositions;
    bool noRolling = false;
    bool json = false;
};

std::string formatJson(const KernelBenchResult& result, const BenchOptions& options, const Bed& bed)
{
    JsonWriter json;
    json.beginObject().key("kernel").beginObject();
    json.member("mps", result.mps).member("mps_without_rebuilds", result.mpsWithoutRebuilds);
    json.member("mps_low", result.mpsLow).member("mps_high", result.mpsHigh);
    if (options.kernel.busy > 0) {
        json.member("busy", options.kernel.busy).member("mps_busy", result.mpsBusy);
    }
    json.member("threads", result.threads).member("target", kernelTargetName());
    json.member("precision", options.kernel.real64 ? "double" : "float");
    json.member("rolling", options.kernel.rolling);
    json.member("grains", result.grains).member("steps", result.steps);
    json.member("repeats", result.repeats.size()).member("rebuilds", result.rebuilds);
    json.member("rebuild_share", result.rebuildShare);
    json.member("bytes_per_grain", result.bytesPerGrain);
    json.member("contacts_per_grain", result.contactsPerGrain);
    json.member("pairs_per_grain", result.pairsPerGrain);
    json.member("kinetic_energy_j", result.kineticEnergy);
    json.member("max_overlap_r", result.deepestOverlap);
    json.member("settling_steps", bed.settlingSteps);
    json.member("settling_wall_s", bed.secondsToMake);
    json.member("version", describeVersion()).endObject().endObject();
    return json.text();
}

std::string formatText(const KernelBenchResult& result, const BenchOptions& options)
{
    std::string text = fmt::format(
        "{} grains, {} steps, {} thread{}, {} kernel, {}, rolling {}\n", result.grains,
        result.steps, result.threads, result.threads == 1 ? "" : "s", kernelTargetName(),
        options.kernel.real64 ? "double" : "float", options.kernel.rolling ? "on" : "off");
    text += fmt::format(
        "{:.2f} M particle-steps/s with rebuilds, {:.2f} without (median of {}; "
        "{:.2f} to {:.2f})\n",
        result.mps, result.mpsWithoutRebuilds, result.repeats.size(), result.mpsLow,
        result.mpsHigh);
    if (options.kernel.busy > 0) {
        text += fmt::format("{:.2f} M particle-steps/s beside {} busy process{}: {:.2f} times slower\n",
                            result.mpsBusy, options.kernel.busy, options.kernel.busy == 1 ? "" : "es",
                            result.mps / result.mpsBusy);
    }
    text += fmt::format("{} rebuilds, {:.1f} % of the time\n", result.rebuilds,
                        100.0 * result.rebuildShare);
    text += fmt::format("a grain has {:.2f} contacts, {:.2f} listed pairs, {:.0f} bytes\n",
                        result.contactsPerGrain, result.pairsPerGrain, result.bytesPerGrain);
    text += fmt::format("kinetic energy {:.4g} J, deepest overlap {:.3f} r\n", result.kineticEnergy,
                        result.deepestOverlap);
    return text;
}

ExitCode runKernelBench(BenchOptions options)
{
    useThreads(options.threads);
    useKernel(options.simd);
    options.kernel.rolling = !options.noRolling;
    const Bed bed =
        options.positions.empty() ? makeBed(options.grains) : readBed(options.positions);
    if (!options.json && bed.settlingSteps > 0) {
        fmt::print("bed of {} grains made in {:.1f} s ({} steps to settle)\n", bed.centre.size(),
                   bed.secondsToMake, bed.settlingSteps);
    }
    if (!options.writePositions.empty()) {
        writeBed(options.writePositions, bed);
    }
    const KernelBenchResult result = benchKernel(bed, options.kernel);
    fmt::print("{}", options.json ? formatJson(result, options, bed) : formatText(result, options));
    return ExitCode::done;
}

}  // namespace

void addBenchCommand(CLI::App& app, Action& action)
{
    auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Time parts of the program");
    command->require_subcommand(1);
    CLI::App* kernel = command->add_subcommand(
        "kernel", "Grain solver on a settled bed in a box, in million particle-steps per second");
    // A million steps or repeats are a slip of the finger.
    CLI::Option* grains =
        kernel->add_option("--grains", options->grains, "Grains in the bed (default 107687)")
            ->check(CLI::Range(1, 100'000'000));
    kernel->add_option("--steps", options->kernel.steps, "Timed steps (default 300)")
        ->check(CLI::Range(1, 1'000'000));
    kernel->add_option("--warmup", options->kernel.warmup, "Steps before them (default 300)")
        ->check(CLI::Range(0, 1'000'000));
    kernel->add_option("--repeat", options->kernel.repeats, "Timings, median counts (default 3)")
        ->check(CLI::Range(1, 1000));
    kernel->add_option("--busy", options->kernel.busy,
                       "Time it beside so many busy processes as well")
        ->check(CLI::Range(0, 1024));
    kernel->add_option("--threads", options->threads, "Threads (default: all processors)");
    kernel->add_option("--simd", options->simd,
                       "Kernel: auto, scalar, sse4, avx2, avx512 (same results)");
    kernel->add_option("--positions", options->positions, "Take the bed from this file: id,x,y,z")
        ->excludes(grains);
    kernel->add_option("--write-positions", options->writePositions,
                       "Write the bed's positions at rest to this file");
    kernel->add_flag("--no-rolling", options->noRolling, "No rolling friction");
    kernel->add_flag("--double", options->kernel.real64, "Compute in double precision");
    kernel->add_flag("--json", options->json, "Print JSON");
    kernel->callback(
        [options, &action] { action = [options] { return runKernelBench(*options); }; });
    addErrorBench(*command, action);
    addStabilityBench(*command, action);
}

}  // namespace sandflow
