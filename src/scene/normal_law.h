#pragma once

namespace sandflow {

/// How the force between two grains rises with their overlap.
enum class NormalLaw { linear, hertz, bellYuMucha };

}  // namespace sandflow
