#pragma once

#include <string>

namespace sandflow::verification {

/// A square plate with a round hole in its middle, about the z axis.
struct OrificePlate {
    double halfEdge = 0.0;    ///< m
    double holeRadius = 0.0;  ///< m
    double top = 0.0;         ///< m
    double thickness = 0.0;   ///< m
};

/// Writes the plate as a closed mesh into the temporary folder; returns its path.
std::string writeOrificePlate(const OrificePlate& plate);

}  // namespace sandflow::verification
