#pragma once

#include <cstdint>

namespace sandflow {

/// One line of frames.csv: what one frame held and what it cost. Members in the order of the
/// columns.
struct FrameRow {
    std::uint64_t frame = 0;
    double time = 0.0;             ///< time_s, simulated
    double wall = 0.0;             ///< wall_s, seconds this frame took
    std::uint64_t steps = 0;
    double dtMin = 0.0;            ///< dt_min_s
    double dtMean = 0.0;           ///< dt_mean_s
    std::uint64_t emitted = 0;
    std::uint64_t mobile = 0;      ///< asleep ones included
    std::uint64_t asleep = 0;
    std::uint64_t interface = 0;
    std::uint64_t buried = 0;
    std::uint64_t exited = 0;
    std::uint64_t exported = 0;    ///< grains in the frame's picture file
    double maxOverlap = 0.0;       ///< max_overlap_r, in grain radii
    double kineticEnergy = 0.0;    ///< kinetic_energy_j
    // Seconds of wall time per stage.
    double surfaceFlowTime = 0.0;  ///< t_surface_flow_s
    double transferTime = 0.0;     ///< t_transfer_s
    double rebuildTime = 0.0;      ///< t_rebuild_s
    double forcesTime = 0.0;       ///< t_forces_s
    double emitTime = 0.0;         ///< t_emit_s
    double outputTime = 0.0;       ///< t_output_s
};

}  // namespace sandflow
