#pragma once

#include "dem/dem.h"
#include "grains/buried_grains.h"

#include <functional>
#include <vector>

namespace sandflow {

/// Moves fixed grains without pressing them into each other: a shift that differs from grain to
/// grain, then pairs that overlap are parted, a little at a time, as grains that are sheared make
/// way for each other (position based, no forces: the bed is quasi-static).
template <class Real>
class OverlapParter {
public:
    /// Shifts every fixed grain by shiftOf(record) [m] and parts those that moved by more than
    /// `least` from each other and from what did not move. Returns how many moved.
    std::size_t shiftAndPart(const std::function<Vec3(const GrainRecord<Real>&)>& shiftOf,
                             double least, const BuriedGrains& buried, Dem<Real>& dem);

    /// Parts all fixed grains until none overlap by more than a resting grain may, or it does not
    /// get better: they are about to be set free. Returns the deepest overlap left, m.
    double partAll(Dem<Real>& dem);

private:
    struct Neighbour {
        std::uint32_t grain;  ///< index of a moved grain, or kObstacle + index into obstacles_
        double reach;         ///< m, distance at which they just touch
    };
    /// A smooth solid's surface beside a grain: flat, as far as the grain goes in these rounds.
    struct Wall {
        Vec3 normal;     ///< unit, towards the grain
        double surface;  ///< m, along the normal
        double reach;    ///< m above the surface: where the grain's centre is when they just touch

        /// m, beyond a share of the reach that may be.
        double overlapAt(const Vec3& centre, double allowed) const
        {
            return reach * (1.0 - allowed) - (normal.dot(centre) - surface);
        }
    };
    void listNeighbours(const Dem<Real>& dem, const BuriedGrains* buried);
    void listWalls(const Dem<Real>& dem);
    void settle(const Vec3& down);
    void part();
    double deepestOverlap() const;

    std::vector<Vec3> place_, nextPlace_;
    std::vector<double> shift_;            ///< m, how far each moved
    std::vector<std::uint32_t> moved_;     ///< fixed grains that moved
    std::vector<std::uint32_t> movedAt_;   ///< by fixed grain: index into moved_, or none
    std::vector<Vec3> obstacles_;
    std::vector<Neighbour> neighbour_;
    std::vector<std::uint32_t> end_;       ///< of each moved grain's neighbours
    std::vector<Wall> wall_;
    std::vector<std::uint32_t> wallEnd_;   ///< of each moved grain's walls
};

}  // namespace sandflow
