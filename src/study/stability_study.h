#pragma once

#include "study/stability_cases.h"

#include <functional>
#include <string>
#include <vector>

namespace sandflow {

/// Every case of the study, in the order of its table.
std::vector<StabilityCase> makeStabilityCases(StudySize size);

/// Told what was found as soon as it was, one call at a time.
using FindingListener = std::function<void(const std::vector<Finding>&)>;

/// Runs the cases, as many side by side as OpenMP has threads, each on one: what is found is the same
/// on any number of them. Findings come back in the order of the cases.
std::vector<Finding> runStabilityCases(const std::vector<StabilityCase>& cases,
                                       const FindingListener& tell);

/// A table for people: one block for each family.
std::string describe(const std::vector<Finding>& findings);

/// Columns of the study's CSV file, and one finding as such a row.
std::vector<std::string> findingColumns();
std::vector<std::string> findingFields(const Finding& finding);

/// A gnuplot script that draws `png`: for each family, error over limit against the parameter,
/// coloured by verdict. `title` stands above all.
std::string makeStabilityPlot(const std::vector<Finding>& findings, const std::string& title,
                              const std::string& png);

}  // namespace sandflow
