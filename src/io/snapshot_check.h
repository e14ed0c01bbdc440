#pragma once

#include "grains/snapshot.h"

namespace sandflow {

/// Throws InternalError unless every array has one entry per grain and the ids ascend.
void checkSnapshot(const Snapshot& snapshot);

}  // namespace sandflow
