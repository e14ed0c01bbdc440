#include "study/stability_study.h"

#include "core/errors.h"
#include "study/text_table.h"
#include "study/trial_csv.h"

#include <omp.h>

#include <exception>

namespace sandflow {

std::string labelOf(Mode mode)
{
    return mode == Mode::dem ? "dem" : "surface-flow";
}

StabilityCase makeCase(std::string family, std::string parameter, double value, std::string mode,
                       std::function<void(Finding&)> run)
{
    StabilityCase made;
    made.head.family = std::move(family);
    made.head.parameter = std::move(parameter);
    made.head.value = value;
    made.head.mode = std::move(mode);
    made.run = [run = std::move(run)](const Finding& head) {
        Finding finding = head;
        run(finding);
        return std::vector<Finding>{finding};
    };
    return made;
}

std::vector<StabilityCase> makeStabilityCases(StudySize size)
{
    std::vector<StabilityCase> cases;
    addRestCases(size, cases);
    addPourCases(size, cases);
    addColumnCases(size, cases);
    addBounceCases(size, cases);
    addImpactCases(size, cases);
    addOverlapCases(size, cases);
    addTiltCases(size, cases);
    return cases;
}

std::vector<Finding> runStabilityCases(const std::vector<StabilityCase>& cases,
                                       const FindingListener& tell)
{
    std::vector<std::vector<Finding>> found(cases.size());
    std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t k = 0; k < cases.size(); ++k) {
        // Nothing may leave a parallel loop by a throw.
        try {
            found[k] = cases[k].run(cases[k].head);
#pragma omp critical(tellFindings)
            tell(found[k]);
        } catch (...) {
#pragma omp critical(keepFailure)
            failure = std::current_exception();
        }
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
    std::vector<Finding> all;
    for (const std::vector<Finding>& some : found) {
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

std::vector<std::string> findingColumns()
{
    return {"family", "parameter", "value", "mode",  "verdict", "measure",
            "error",  "limit",     "unit",  "cause"};
}

std::vector<std::string> findingFields(const Finding& finding)
{
    const Check& check = finding.decisive;
    const bool isMeasured = !check.measure.empty();
    return {finding.family,
            finding.parameter,
            csvNumber(finding.value),
            finding.mode,
            nameOf(finding.verdict),
            check.measure,
            isMeasured ? csvNumber(check.error) : "",
            isMeasured ? csvNumber(check.limit) : "",
            check.unit,
            finding.cause};
}

std::string describe(const std::vector<Finding>& findings)
{
    std::string text;
    for (std::size_t begin = 0; begin < findings.size();) {
        const Finding& first = findings[begin];
        std::vector<std::vector<std::string>> rows;
        std::size_t end = begin;
        for (; end < findings.size() && findings[end].family == first.family; ++end) {
            const Finding& f = findings[end];
            const Check& check = f.decisive;
            const bool isMeasured = !check.measure.empty();
            rows.push_back({f.mode, fmt::format("{:.4g}", f.value), nameOf(f.verdict),
                            isMeasured ? fmt::format("{:.3g}", check.error) : "-",
                            isMeasured ? fmt::format("{:.3g} {}", check.limit, check.unit) : "-",
                            isMeasured ? check.measure : "-"});
        }
        text += fmt::format("\n{}\n", first.family);
        text += formatTable({"mode", first.parameter, "verdict", "error", "limit", "what is nearest to its limit"}, rows);
        for (std::size_t k = begin; k < end; ++k) {
            if (!findings[k].cause.empty()) {
                text += fmt::format("  {} {:.4g}, {}: {}\n", first.parameter, findings[k].value,
                                    findings[k].mode, findings[k].cause);
            }
        }
        begin = end;
    }
    return text;
}

}  // namespace sandflow
