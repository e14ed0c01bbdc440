#pragma once

#include "bcre/columns.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// Lengths in m.
struct SettlingParams {
    double depth = 0.15;   ///< below the surface: how far down sand is set free; 0: none ever is
    double least = 0.002;  ///< a bed that crept less holds as it did
    double ending = 0.8;   ///< of the speed that a region's bed had lately: if it is slower, its
                           ///< flow is ending
    double lately = 0.5;   ///< s, memory of that
};

/// Creep moves the grains of the bed without asking what bears them. They lie where sheared sand
/// would, but how they touch does not balance the weight on them: set free, they shear by another
/// two per cent. So when the flow has ended the sand that crept is set free once, and finds its rest
/// by the forces on it. All of a region at a time: sand between columns that are held is held too.
class BedSettling {
public:
    explicit BedSettling(const SettlingParams& params) : params_(params) {}

    /// Lets `interval` [s] pass, during which the beds crept at bedVelocity [m/s, by span]. Returns
    /// by span the height [m] above which sand is to be set free now, kNowhere for none; it is empty
    /// if that is nowhere.
    const std::vector<double>& endedFlows(const ColumnGrid& columns,
                                          const std::vector<Vec3>& bedVelocity, double interval);

    static constexpr double kNowhere = 1e30;

private:
    bool owesRest(std::int32_t span) const { return crept_[span] >= params_.least; }
    void findRegion(const ColumnGrid& columns, std::int32_t first);
    bool flowIsEnding(const std::vector<Vec3>& bedVelocity) const;

    SettlingParams params_;
    std::vector<double> crept_;  ///< m, by span, since it was last set free
    std::vector<double> usual_;  ///< m/s, by span, mean speed of the bed lately
    std::vector<char> visited_;  ///< by span
    std::vector<std::int32_t> region_;
    std::vector<double> line_;
};

}  // namespace sandflow
