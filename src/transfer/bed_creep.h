#pragma once

#include "bcre/columns.h"
#include "dem/dem.h"
#include "transfer/part_overlaps.h"

#include <vector>

namespace sandflow {

/// Lengths in m.
struct CreepParams {
    double diameter = 0.01;  ///< mean, of the grains
    double decay = 0.008;    ///< the bed's speed falls by e over this depth; 0: the bed is rigid
    double depth = 0.02;     ///< below the top of the bed: there it does not move any more
};

/// The bed under flowing sand is not still. Its speed falls off exponentially with depth, by e over
/// about a diameter whatever the flow above (Komatsu et al., Phys. Rev. Lett. 86, 1757 (2001); 1.7 d
/// in our own full DEM, below 5 d). A rigid bed would hold the flow back: the same sand would need a
/// slope three degrees steeper to get past it. So the interface moves with the flow, and carries what
/// lies on it:
///
///     u(z) = u_b exp(-z / lambda)            z below the bed's top
///     v(z) = u_b (exp(z / lambda) - 1)       z above it, relative to the bed: the same profile
///
/// u_b follows from the mean of v over the lowest two diameters of the flow. How much of it the bed
/// takes over depends on lambda alone: 0.46 at 1 d, 0.29 at 0.8 d, 0.14 at 0.6 d, the default, with
/// which heaps stand as in full DEM once they have settled (bed_settling.h); at 0.8 d they end two
/// degrees too flat, without creep more than one too steep.
template <class Real>
class BedCreep {
public:
    explicit BedCreep(const CreepParams& params);

    /// Carries fixed and mobile grains along for `interval` [s]; between Dem::recordContacts() and
    /// Dem::rebuild(). Returns how many fixed grains moved.
    std::size_t carry(const ColumnGrid& columns, double interval, const BuriedGrains& buried,
                      Dem<Real>& dem);

    /// Velocity of the top of the bed [m/s], by span. For tests and diagnostics.
    const std::vector<Vec3>& bedVelocity() const { return velocity_; }

private:
    /// Sand of a column between two depths below its surface.
    struct Layer {
        double still = 0.0, moving = 0.0;  ///< grains
        Vec3 velocity = Vec3::Zero();      ///< m/s, sum over the moving ones
    };
    void sortIntoLayers(const ColumnGrid& columns, const Dem<Real>& dem);
    void findBedVelocity(const ColumnGrid& columns, double interval);
    void smooth(const ColumnGrid& columns);
    Vec3 velocityAt(const ColumnGrid& columns, const GrainRecord<Real>& grain) const;

    CreepParams params_;
    double share_;                  ///< u_b over the mean speed of the lowest flow
    std::vector<Layer> layers_;     ///< kLayers of each span
    std::vector<Vec3> averaged_;    ///< m/s, top of the bed, over time; by span
    std::vector<Vec3> velocity_;    ///< m/s, that over space too
    std::vector<Vec3> smoothed_;
    std::vector<double> bedTop_;    ///< m, by span
    double fastest_ = 0.0;          ///< m/s, of all spans
    OverlapParter<Real> parter_;
};

}  // namespace sandflow
