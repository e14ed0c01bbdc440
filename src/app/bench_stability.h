#pragma once

#include "app/commands.h"

namespace sandflow {

/// `bench stability`: adds itself below `bench`.
void addStabilityBench(CLI::App& bench, Action& action);

}  // namespace sandflow
