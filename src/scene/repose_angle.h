#pragma once

#include "scene/scene.h"

#include <string>

namespace sandflow {

/// theta0 lies so far above the angle at which the material's heaps stand [degrees] unless the
/// scene says otherwise. The flow must be able to settle on a slope that stands: with theta0 at the
/// repose angle itself two fifths of a heap stay mobile, with 7 degrees more about the paper's
/// quarter.
inline constexpr double kAutoReposeMargin = 8.0;

/// The slopes that belong to a scene's sand, and where they come from. Degrees.
struct ReposeReport {
    double expected = 0.0;  ///< of a heap of this friction and rolling friction, full DEM
    bool measured = true;   ///< false: they lie beyond the table, and the nearest pair is taken
    double angle = 0.0;     ///< surface_flow.repose_angle, "auto" resolved
    double margin = 0.0;    ///< surface_flow.repose_margin, "auto" resolved
    std::string material;   ///< one sentence on `expected`
    std::string reason;     ///< one sentence on theta0

    /// theta0: steeper slopes erode, flatter ones settle.
    double neutralSlope() const { return angle + margin; }
};

ReposeReport reportRepose(const Scene& scene);

}  // namespace sandflow
