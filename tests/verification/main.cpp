#include "verification/verdict.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace sandflow::verification {
namespace {

struct Options {
    bool bulk = false;
    std::string only;
    std::string csv;
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
    return v.gate == Gate::absolute || v.expected == 0.0 ? fmt::format("{:+.3g}", v.error())
                                                         : fmt::format("{:+.3g} %", 100.0 * v.error());
}

std::string describeShipped(const Verdict& v)
{
    return std::isnan(v.atShippingStep) ? "" : fmt::format("{:.5g}", v.atShippingStep);
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
        const bool isWanted = options.only.empty() ? c.bulk == options.bulk : c.name == options.only;
        if (!isWanted) {
            continue;
        }
        fmt::print("{}: {}\n", c.name, c.source);
        for (const Verdict& v : c.run(options.settings)) {
            failures += v.holds() ? 0 : 1;
            fmt::print("  {:<44} expected {:>11.5g}  ours {:>11.5g}  {:>10} of {:>9}  {:>11}  {}\n",
                       v.quantity, v.expected, v.ours, describeError(v), describeGate(v),
                       describeShipped(v), v.holds() ? "holds" : "FAILS");
            if (csv) {
                csv << fmt::format("{},\"{}\",\"{}\",{:.9g},{:.9g},{:.4g},{},{},{}\n", c.name,
                                   c.source, v.quantity, v.expected, v.ours, v.error(),
                                   describeGate(v), describeShipped(v), v.holds() ? "yes" : "no");
            }
        }
        std::fflush(stdout);
    }
    if (!options.csv.empty() && !csv.flush()) {
        fmt::print(stderr, "verify: cannot write {}\n", options.csv);
        return 1;
    }
    return failures;
}

}  // namespace
}  // namespace sandflow::verification

/// verify [--bulk] [--only CASE] [--seeds N] [--csv FILE] [--list]: exit code 1 if a number that is
/// judged does not hold.
int main(int argc, char** argv)
{
    using namespace sandflow::verification;
    CLI::App app("Published numbers beside ours");
    Options options;
    bool list = false;
    app.add_flag("--bulk", options.bulk, "The cases that take minutes, not the fast ones");
    app.add_option("--only", options.only, "One case");
    app.add_option("--seeds", options.settings.seeds, "Pours per bulk case")->check(CLI::Range(1, 20));
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
    return runCases(options) == 0 ? 0 : 1;
}
