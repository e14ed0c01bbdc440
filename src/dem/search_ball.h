#pragma once

#include "dem/chunk_pass.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Where a grain is promised to stay, grown by its own radius: grains whose balls do not meet cannot
/// touch.
struct SearchBall {
    double x, y, z;    ///< m
    float reach;       ///< m, of the ball and the grain's own radius
    std::uint32_t id;  ///< of the grain

    double distance2(const SearchBall& other) const
    {
        const double dx = other.x - x, dy = other.y - y, dz = other.z - z;
        return dx * dx + dy * dy + dz * dz;
    }
    /// The same seen from either.
    bool meets(const SearchBall& other) const
    {
        const double limit = static_cast<double>(reach) + static_cast<double>(other.reach);
        return distance2(other) < limit * limit;
    }
};

/// A fixed grain does not move at all.
template <class Real>
SearchBall ballOfFixed(const GrainRecord<Real>& g)
{
    return {g.x, g.y, g.z, static_cast<float>(g.radius), g.id};
}

/// Balls as columns of floats: what FindNear sieves.
struct BallColumns {
    std::vector<float> x, y, z, reach;

    /// Whole lanes may be read from any ball on.
    void resize(std::size_t count)
    {
        x.resize(count + kMaxLanes), y.resize(count + kMaxLanes), z.resize(count + kMaxLanes);
        reach.resize(count + kMaxLanes);
    }
    void set(std::size_t k, const SearchBall& ball)
    {
        x[k] = static_cast<float>(ball.x), y[k] = static_cast<float>(ball.y);
        z[k] = static_cast<float>(ball.z), reach[k] = ball.reach;
    }
    std::size_t bytes() const { return 4 * sizeof(float) * x.capacity(); }
};

}  // namespace sandflow
