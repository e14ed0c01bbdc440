#pragma once

#include "measure/heap.h"
#include "scene/scene.h"

/// Repose of a poured heap against sliding and rolling friction.
namespace sandflow::verification {

/// 10,000 grains poured onto a rough floor as scenes/floor.toml does on a large scale, one and a
/// half seconds after the last one.
HeapFigures pourHeap(Mode mode, double friction, double rollingFriction, std::uint64_t seed);

}  // namespace sandflow::verification
