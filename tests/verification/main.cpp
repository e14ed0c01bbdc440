#include "verification/verdict.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>

namespace sandflow::verification {
namespace {

struct Options {
    bool bulk = false;
    std::string only;
    std::string csv;
    /// A handful of grains: a team of threads costs a thousand times what it gives.
    int threads = 1;
    Settings settings;
};

std::string describeGate(const Verdict& v)
{
    switch (v.gate) {
    case Gate::relative: return fmt::format("{:g} %", 100.0 * v.tolerance);
    case Gate::absolute: return fmt::format("{:g}", v.tolerance);
    case Gate::atMost: return "at most";
    case Gate::atLeast: return "at least";
    case Gate::report: break;
    }
    return "reported";
}

std::string describeError(const Verdict& v)
{
    const bool isShare = v.gate != Gate::absolute && v.expected != 0.0;
    return isShare ? fmt::format("{:+.3g} %", 100.0 * v.error())
                   : fmt::format("{:+.3g}", v.error());
}

std::string describeShipped(const Verdict& v)
{
    return std::isnan(v.atShippingStep) ? "" : fmt::format("{:.5g}", v.atShippingStep);
}

/// How many numbers did not hold.
int printVerdicts(const Case& c, const std::vector<Verdict>& verdicts, std::ofstream& csv)
{
    int failures = 0;
    for (const Verdict& v : verdicts) {
        failures += v.holds() ? 0 : 1;
        fmt::print("  {:<52} expected {:>11.5g}  ours {:>11.5g}  {:>10} of {:>8}  {:>11}  {}\n",
                   v.quantity, v.expected, v.ours, describeError(v), describeGate(v),
                   describeShipped(v), v.holds() ? "holds" : "FAILS");
        if (csv.is_open()) {
            csv << fmt::format("{},\"{}\",\"{}\",{:.9g},{:.9g},{:.4g},{},{},{}\n", c.name, c.source,
                               v.quantity, v.expected, v.ours, v.error(), describeGate(v),
                               describeShipped(v), v.holds() ? "yes" : "no");
        }
    }
    return failures;
}

/// A case that throws has failed; the others are still of interest.
int runCase(const Case& c, const Settings& settings, std::ofstream& csv)
{
    fmt::print("{}: {}\n", c.name, c.source);
    try {
        const std::vector<Verdict> verdicts = c.run(settings);
        if (verdicts.empty()) {
            fmt::print("  FAILS: judges nothing\n");
            return 1;
        }
        return printVerdicts(c, verdicts, csv);
    } catch (const std::exception& error) {
        fmt::print("  FAILS: {}\n", error.what());
        return 1;
    }
}

/// Runs the chosen cases; how many numbers did not hold.
int runCases(const Options& options)
{
    std::ofstream csv;
    if (!options.csv.empty()) {
        csv.open(options.csv);
        csv << "case,source,quantity,expected,ours,error,tolerance,at_shipping_step,holds\n";
    }
    int failures = 0;
    for (const Case& c : allCases()) {
        const bool isWanted =
            options.only.empty() ? c.bulk == options.bulk : c.name == options.only;
        if (isWanted) {
            failures += runCase(c, options.settings, csv);
            std::fflush(stdout);
        }
    }
    if (!options.csv.empty() && !csv.flush()) {
        fmt::print(stderr, "verify: cannot write {}\n", options.csv);
        return 1;
    }
    return failures;
}

}  // namespace
}  // namespace sandflow::verification

/// verify [--bulk] [--only CASE] [--seeds N] [--threads N] [--csv FILE] [--list]: exit code 1 if a
/// number that is judged does not hold, 2 for a case that is not there.
int main(int argc, char** argv)
{
    using namespace sandflow::verification;
    CLI::App app("Published numbers beside ours");
    Options options;
    bool list = false;
    app.add_flag("--bulk", options.bulk, "The cases that take minutes, not the fast ones");
    app.add_option("--only", options.only, "One case");
    app.add_option("--seeds", options.settings.seeds, "Pours per bulk case")
        ->check(CLI::Range(1, 20));
    app.add_option("--threads", options.threads, "Threads per case")->check(CLI::Range(1, 1024));
    app.add_option("--csv", options.csv, "Write the table there as well");
    app.add_flag("--list", list, "Names of the fast cases (with --bulk: of the others)");
    CLI11_PARSE(app, argc, argv);
    if (list) {
        for (const Case& c : allCases()) {
            if (c.bulk == options.bulk) {
                fmt::print("{}\n", c.name);
            }
        }
        return 0;
    }
    const auto isAsked = [&](const Case& c) { return c.name == options.only; };
    if (!options.only.empty() && std::none_of(allCases().begin(), allCases().end(), isAsked)) {
        fmt::print(stderr, "verify: there is no case {}; --list and --bulk --list name them\n",
                   options.only);
        return 2;
    }
    omp_set_num_threads(options.threads);
    return runCases(options) == 0 ? 0 : 1;
}
