#pragma once

#include "mesh/shapes.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sandflow {

/// A profile (distance from the z axis, height) turned about that axis, in `sectors` steps; outward
/// if the profile runs with the solid on its left.
inline TriangleMesh makeRevolved(const std::vector<Vec2>& profile, int sectors)
{
    TriangleMesh mesh;
    for (const Vec2& ring : profile) {
        for (int s = 0; s < sectors; ++s) {
            const double angle = 2.0 * kPi * s / sectors;
            mesh.points.push_back(
                {ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y()});
        }
    }
    const auto at = [&](std::size_t ring, int s) {
        return static_cast<std::uint32_t>(ring * static_cast<std::size_t>(sectors) +
                                          static_cast<std::size_t>(s % sectors));
    };
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
        for (int s = 0; s < sectors; ++s) {
            // At the axis one of the two has no area and is left out.
            if (profile[ring].x() > 0.0) {
                mesh.triangles.push_back({at(ring, s), at(ring, s + 1), at(ring + 1, s)});
            }
            if (profile[ring + 1].x() > 0.0) {
                mesh.triangles.push_back({at(ring + 1, s), at(ring, s + 1), at(ring + 1, s + 1)});
            }
        }
    }
    return mesh;
}

/// Half a hollow ball, open upwards, its rim at z = 0. The walls of the mesh are chords: the inner
/// one lies a little within the ball of `inner`, the outer one within that of `outer`.
inline TriangleMesh makeBowl(double inner, double outer)
{
    constexpr int kRings = 24;
    std::vector<Vec2> profile;
    for (int k = 0; k <= kRings; ++k) {
        const double angle = 0.5 * kPi * k / kRings;
        profile.push_back(outer * Vec2(std::sin(angle), -std::cos(angle)));
    }
    profile.back().y() = 0.0;
    for (int k = kRings; k >= 0; --k) {
        const double angle = 0.5 * kPi * k / kRings;
        profile.push_back(inner * Vec2(std::sin(angle), -std::cos(angle)));
    }
    profile[kRings + 1].y() = 0.0;
    return makeRevolved(profile, 4 * kRings);
}

/// Four faces; the tip stands `height` over a base of edge `base`.
inline TriangleMesh makeSpike(double base, double height)
{
    TriangleMesh mesh;
    mesh.points = {Vec3::Zero(), {base, 0, 0}, {0, base, 0}, {0.5 * base, 0.4 * base, height}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return mesh;
}

/// A curved sheet of cells of the given size with a square hole, open at all rims.
inline TriangleMesh makeSheet(int nx, int ny, double cell)
{
    TriangleMesh mesh;
    for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) {
            mesh.points.push_back(cell * Vec3(i, j, 0.02 * (i * i - j * j)));
        }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i + (nx + 1) * j); };
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const bool isHole = std::abs(2 * i - nx) <= 4 && std::abs(2 * j - ny) <= 4;
            if (!isHole) {
                mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
            }
        }
    }
    return mesh;
}

/// A tube whose sides are triangles as long as the tube and a fraction of the gap wide, and one
/// needle that stands alone.
inline TriangleMesh makeNeedles(double gap)
{
    TriangleMesh mesh = makeRevolved({{2.0 * gap, 0.0}, {2.0 * gap, 120.0 * gap}}, 200);
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back({5.0 * gap, 0.0, 0.0});
    mesh.points.push_back({5.0 * gap, 1e-4 * gap, 0.0});
    mesh.points.push_back({25.0 * gap, 3.0 * gap, 60.0 * gap});
    mesh.triangles.push_back({first, first + 1, first + 2});
    return mesh;
}

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// What a surface can be like, seen from a gap of that many metres.
inline std::vector<NamedMesh> makeSampledMeshes(double gap)
{
    return {{"box", makeBoxMesh(Vec3(0.1, -0.2, 0.3),
                                Vec3(0.1, -0.2, 0.3) + gap * Vec3(40.0, 30.0, 20.0))},
            {"plate", makeBoxMesh(Vec3::Zero(), gap * Vec3(50.0, 40.0, 0.3))},
            {"sphere", makeIcosphereMesh(Vec3::Zero(), 15.0 * gap, 4)},
            {"spike", makeSpike(4.0 * gap, 60.0 * gap)},
            {"sheet", makeSheet(24, 18, 1.7 * gap)},
            {"needles", makeNeedles(gap)},
            {"small triangles", makeIcosphereMesh(Vec3::Zero(), 5.0 * gap, 6)}};
}

}  // namespace sandflow
