#pragma once

#include "core/cell_key.h"
#include "mesh/sample_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <unordered_map>
#include <vector>

namespace sandflow {

/// Finds samples near a point, by other means than the code under test.
class SampleSearch {
public:
    SampleSearch(const SurfaceSamples& samples, double reach)
        : samples_(samples), reach_(reach), inverseCell_(1.0 / reach)
    {
        for (std::uint32_t s = 0; s < samples.points.size(); ++s) {
            cells_[keyOf(samples.points[s], Vec3::Zero())].push_back(s);
        }
    }

    /// Distance to the nearest sample with a normal similar to this one, m; infinite beyond reach.
    double distanceTo(const Vec3& point, const Vec3& normal) const
    {
        double best2 = std::numeric_limits<double>::infinity();
        visitNear(point, [&](std::uint32_t s) {
            if (samples_.normals[s].dot(normal) > 0.5) {
                best2 = std::min(best2, (samples_.points[s] - point).squaredNorm());
            }
        });
        return std::sqrt(best2);
    }

    /// Calls visit(index) for all samples within reach, and some beyond.
    template <typename Visit>
    void visitNear(const Vec3& point, const Visit& visit) const
    {
        for (int n = 0; n < 27; ++n) {
            const Vec3 step = reach_ * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            const auto cell = cells_.find(keyOf(point, step));
            if (cell != cells_.end()) {
                std::for_each(cell->second.begin(), cell->second.end(), visit);
            }
        }
    }

private:
    std::uint64_t keyOf(const Vec3& point, const Vec3& step) const
    {
        const Vec3 cell = (point * inverseCell_).array().floor() + (step * inverseCell_).array();
        const Eigen::Vector3i index = cell.array().round().cast<int>();
        return packCellKey(index.x(), index.y(), index.z());
    }

    const SurfaceSamples& samples_;
    double reach_;
    double inverseCell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// A point of a mesh, m, and the unit normal there.
struct SurfacePoint {
    Vec3 point;
    Vec3 normal;
};

/// Random points of a mesh: `count` uniform by area, a tenth as many on edges of random triangles,
/// and all corners.
inline std::vector<SurfacePoint> drawOnSurface(const TriangleMesh& mesh, std::size_t count,
                                               std::mt19937_64& random)
{
    std::vector<double> areaUpTo;
    std::vector<Vec3> normals;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 doubleArea =
            (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
        areaUpTo.push_back((areaUpTo.empty() ? 0.0 : areaUpTo.back()) + doubleArea.norm());
        normals.push_back(doubleArea.normalized());
    }
    std::vector<SurfacePoint> drawn;
    const auto drawIn = [&](std::size_t triangle, bool onEdge) {
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        double u = unit(random);
        double v = onEdge ? 0.0 : unit(random);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const std::size_t turn = onEdge ? random() % 3 : 0;
        const auto& corner = mesh.triangles[triangle];
        const Vec3& a = mesh.points[corner[turn]];
        const Vec3& b = mesh.points[corner[(turn + 1) % 3]];
        const Vec3& c = mesh.points[corner[(turn + 2) % 3]];
        drawn.push_back({(1.0 - u - v) * a + u * b + v * c, normals[triangle]});
    };
    std::uniform_real_distribution<double> area(0.0, areaUpTo.back());
    for (std::size_t k = 0; k < count; ++k) {
        const auto end = std::upper_bound(areaUpTo.begin(), areaUpTo.end() - 1, area(random));
        drawIn(static_cast<std::size_t>(end - areaUpTo.begin()), false);
    }
    for (std::size_t k = 0; k < count / 10; ++k) {
        drawIn(random() % mesh.triangles.size(), true);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t corner : mesh.triangles[t]) {
            drawn.push_back({mesh.points[corner], normals[t]});
        }
    }
    return drawn;
}

}  // namespace sandflow
