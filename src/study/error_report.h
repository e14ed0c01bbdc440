#pragma once

#include "study/error_figures.h"

#include <string>

namespace sandflow {

/// One line per setting: cost, errors, and what they say of it; then what the defaults are worth.
std::string describeErrors(const ErrorEvaluation& evaluation);

/// The same as JSON.
std::string errorsAsJson(const ErrorEvaluation& evaluation, const std::string& scene,
                         const std::string& version, int threads);

/// One row per setting, as settings.csv has it, header included.
std::string errorsAsCsv(const ErrorEvaluation& evaluation);

}  // namespace sandflow
