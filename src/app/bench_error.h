#pragma once

#include "app/commands.h"

namespace sandflow {

/// Adds `bench error` to the bench command.
void addErrorBench(CLI::App& bench, Action& action);

}  // namespace sandflow
