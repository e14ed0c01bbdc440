#pragma once

#include "core/errors.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace sandflow {

/// A subcommand adds itself to the command line; when it was chosen it sets `action`, which main
/// then runs inside its one error boundary.
using Action = std::function<ExitCode()>;

void addRunCommand(CLI::App& app, Action& action);
void addCheckCommand(CLI::App& app, Action& action);
void addCompareCommand(CLI::App& app, Action& action);
void addExportCommand(CLI::App& app, Action& action);
void addBenchCommand(CLI::App& app, Action& action);

}  // namespace sandflow
