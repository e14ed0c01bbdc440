#include "app/bench_stability.h"

#include "app/environment.h"
#include "io/atomic_file.h"
#include "io/json_writer.h"
#include "study/gnuplot.h"
#include "study/stability_study.h"
#include "study/study_folder.h"
#include "study/trial_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace sandflow {
namespace {

struct StabilityOptions {
    std::string folder;
    std::string only;
    int threads = 0;
    bool quick = false;
    bool noPlot = false;
    bool json = false;
};

std::vector<StabilityCase> chooseCases(const StabilityOptions& options)
{
    std::vector<StabilityCase> cases =
        makeStabilityCases(options.quick ? StudySize::quick : StudySize::whole);
    std::erase_if(cases, [&](const StabilityCase& c) {
        return c.head.family.find(options.only) == std::string::npos;
    });
    if (cases.empty()) {
        throw InputError(fmt::format(
            "bench stability: --only \"{}\" is part of no family's name", options.only));
    }
    return cases;
}

std::string countVerdicts(const std::vector<Finding>& findings)
{
    std::string text = fmt::format("{} runs judged:", findings.size());
    for (const Verdict verdict : {Verdict::sound, Verdict::refused, Verdict::wrongShape,
                                  Verdict::jitters, Verdict::broke}) {
        const auto count = std::count_if(findings.begin(), findings.end(), [&](const Finding& f) {
            return f.verdict == verdict;
        });
        text += fmt::format(" {} {}{}", count, nameOf(verdict),
                            verdict == Verdict::broke ? "" : ",");
    }
    return text;
}

std::string formatJson(const std::vector<Finding>& findings)
{
    JsonWriter json;
    json.beginObject().member("version", describeVersion());
    json.member("acceptable", std::all_of(findings.begin(), findings.end(), [](const Finding& f) {
        return isAcceptable(f.verdict);
    }));
    json.key("findings").beginArray();
    for (const Finding& f : findings) {
        json.beginObject().member("family", f.family).member("parameter", f.parameter);
        json.member("value", f.value).member("mode", f.mode);
        json.member("verdict", nameOf(f.verdict)).member("measure", f.decisive.measure);
        json.member("error", f.decisive.error).member("limit", f.decisive.limit);
        json.member("unit", f.decisive.unit).member("cause", f.cause).endObject();
    }
    json.endArray().endObject();
    return json.text();
}

/// One line on the way, so that one sees that it lives and what it found.
void tellProgress(const std::vector<Finding>& found, std::size_t done, std::size_t all)
{
    for (const Finding& f : found) {
        fmt::print(stderr, "[{}/{}] {}, {} {:.4g}, {}: {}\n", done, all, f.family, f.parameter,
                   f.value, f.mode, nameOf(f.verdict));
    }
}

ExitCode runStabilityBench(const StabilityOptions& options)
{
    useThreads(options.threads);
    const std::vector<StabilityCase> cases = chooseCases(options);
    const bool plots = !options.noPlot && !options.folder.empty();
    if (plots) {
        requireGnuplot();
    }
    std::unique_ptr<TrialCsv> csv;
    if (!options.folder.empty()) {
        makeStudyFolder(options.folder);
        csv = std::make_unique<TrialCsv>(options.folder + "/stability.csv", findingColumns());
    }
    std::size_t done = 0;
    const std::vector<Finding> findings =
        runStabilityCases(cases, [&](const std::vector<Finding>& found) {
            tellProgress(found, ++done, cases.size());
            for (const Finding& finding : found) {
                if (csv) {
                    csv->append(findingFields(finding));
                }
            }
        });
    const std::string summary = countVerdicts(findings);
    if (plots) {
        plotWithGnuplot(options.folder + "/stability.gp",
                        makeStabilityPlot(findings, summary, options.folder + "/stability.png"));
    }
    fmt::print("{}", options.json ? formatJson(findings) : describe(findings));
    const bool acceptable = std::all_of(findings.begin(), findings.end(), [](const Finding& f) {
        return isAcceptable(f.verdict);
    });
    if (!options.json) {
        fmt::print("\n{}\n", summary);
    }
    if (!acceptable) {
        fmt::print(stderr, "sandflow: some runs gave sand that cannot be relied on, without "
                           "a word: see the lines with a cause above\n");
    }
    return acceptable ? ExitCode::done : ExitCode::physicsBroke;
}

}  // namespace

void addStabilityBench(CLI::App& bench, Action& action)
{
    auto options = std::make_shared<StabilityOptions>();
    CLI::App* command = bench.add_subcommand(
        "stability", "Small scenes at the ends of what a scene may ask for, each with a verdict: "
                     "sound, refused, wrong shape, jitters, broke");
    command->add_option("--out", options->folder,
                        "Folder to make for table (CSV) and plot; without it there are none");
    command->add_option("--only", options->only, "Only families whose name holds this");
    command->add_flag("--quick", options->quick, "Few values of each parameter, single pours");
    command->add_option("--threads", options->threads,
                        "Runs side by side (default: all processors); the same verdicts");
    command->add_flag("--no-plot", options->noPlot, "No picture, no gnuplot");
    command->add_flag("--json", options->json, "Print JSON");
    command->callback(
        [options, &action] { action = [options] { return runStabilityBench(*options); }; });
}

}  // namespace sandflow
