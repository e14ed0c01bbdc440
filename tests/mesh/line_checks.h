#pragma once

#include "mesh/mesh_columns.h"

#include <random>
#include <vector>

namespace sandflow::testing {

inline std::vector<SolidInterval> stretchesAt(const MeshColumns& columns, double x, double y)
{
    std::vector<SolidInterval> out;
    columns.solidIntervalsAt(x, y, out);
    return out;
}

inline double uniformIn(std::mt19937_64& random, double min, double max)
{
    return std::uniform_real_distribution<double>(min, max)(random);
}

inline Vec3 pointIn(std::mt19937_64& random, const Eigen::AlignedBox3d& box)
{
    const double x = uniformIn(random, box.min().x(), box.max().x());
    const double y = uniformIn(random, box.min().y(), box.max().y());
    return {x, y, uniformIn(random, box.min().z(), box.max().z())};
}

/// m3 inside the solid, by linesPerEdge^2 lines spread evenly over its bounds.
inline double spanVolume(const MeshColumns& columns, int linesPerEdge)
{
    const Vec3 min = columns.bounds().min();
    const Vec3 step = columns.bounds().sizes() / linesPerEdge;
    std::vector<SolidInterval> stretches;
    double length = 0.0;
    for (int j = 0; j < linesPerEdge; ++j) {
        for (int i = 0; i < linesPerEdge; ++i) {
            columns.solidIntervalsAt(min.x() + (i + 0.5) * step.x(), min.y() + (j + 0.5) * step.y(),
                                     stretches);
            for (const SolidInterval& stretch : stretches) {
                length += stretch.hi - stretch.lo;
            }
        }
    }
    return length * step.x() * step.y();
}

}  // namespace sandflow::testing
