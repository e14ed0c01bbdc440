#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <utility>
#include <vector>

/// Discharge of a flat-bottomed bin through a round hole.
namespace sandflow::verification {

struct DischargeResult {
    double rate = 0.0;          ///< kg/s
    double unsteadiness = 0.0;  ///< largest relative difference of a third of the time from `rate`
    double bulkDensity = 0.0;   ///< kg/m3, before the hole was opened
    std::vector<std::pair<double, double>> outflow;  ///< s since the opening, grains gone
};

/// `orifice`: clear diameter of the hole, in d.
DischargeResult measureDischarge(Mode mode, double orifice, std::uint64_t seed);

}  // namespace sandflow::verification
