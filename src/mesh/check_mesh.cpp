#include "mesh/check_mesh.h"

#include <fmt/format.h>

namespace sandflow {

std::vector<std::string> checkMeshAgainstGrains(const MeshReport& report, double scale,
                                                double grainRadius)
{
    std::vector<std::string> doubts;
    const double hole = scale * report.largestHole;
    if (hole > grainRadius) {
        doubts.push_back(
            fmt::format("its surface is open at {} edges, and the widest hole is {:.3g} m across, "
                        "{:.3g} grain radii: grains may get in; close it in a modelling program",
                        report.boundaryEdges, hole, hole / grainRadius));
    }
    // Edges of a rim are unbalanced too; those beyond are faces that look against each other.
    if (report.unbalancedEdges > report.boundaryEdges) {
        doubts.push_back(
            fmt::format("{} edges inside its surface have faces that look opposite ways: what is "
                        "inside is uncertain there; repair it in a modelling program",
                        report.unbalancedEdges - report.boundaryEdges));
    }
    const double size = scale * report.bounds.sizes().maxCoeff();
    constexpr double kSmallest = 1.0;   // grain radii: smaller than a grain
    constexpr double kLargest = 1.0e4;  // grain radii: beyond any scene that can be computed
    if (size < kSmallest * grainRadius || size > kLargest * grainRadius) {
        doubts.push_back(
            fmt::format("it is {:.3g} m long, {:.3g} grain radii: check its scale; files are often "
                        "in millimetres",
                        size, size / grainRadius));
    }
    // Single precision keeps 1e-7 of a coordinate: at this distance 1e-3 of the size.
    constexpr double kFarthest = 1.0e4;
    const double distance = report.bounds.center().norm() / report.bounds.sizes().maxCoeff();
    if (distance > kFarthest) {
        doubts.push_back(
            fmt::format("in its file it lies {:.3g} times its size from the origin, where single "
                        "precision blurs its shape; move it to the origin in a modelling program",
                        distance));
    }
    return doubts;
}

}  // namespace sandflow
