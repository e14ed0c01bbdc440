#pragma once

#include "core/vec3.h"
#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace sandflow {

/// Closed meshes of known area and volume, facing outwards.
inline TriangleMesh makeBoxMesh(const Vec3& min, const Vec3& max)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.points.push_back({(corner & 1) ? max.x() : min.x(), (corner & 2) ? max.y() : min.y(),
                               (corner & 4) ? max.z() : min.z()});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Inscribed in the sphere: all corners are on it. 20 * 4^level triangles of about the same size.
inline TriangleMesh makeIcosphereMesh(const Vec3& centre, double radius, int level)
{
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    TriangleMesh mesh;
    mesh.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int round = 0; round < level; ++round) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middleOf = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, isNew] =
                middles.insert({std::minmax(a, b), static_cast<std::uint32_t>(mesh.points.size())});
            if (isNew) {
                mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
            }
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middleOf(a, b);
            const std::uint32_t bc = middleOf(b, c);
            const std::uint32_t ca = middleOf(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (Vec3& point : mesh.points) {
        point *= radius / point.norm();
        point += centre;
    }
    return mesh;
}

/// A closed outline in the (x, z) half plane x > 0, counter-clockwise there, turned about the z
/// axis in `steps` steps.
inline TriangleMesh makeTurnedMesh(const std::vector<Vec2>& outline, int steps)
{
    TriangleMesh mesh;
    const auto corners = static_cast<std::uint32_t>(outline.size());
    const auto sectors = static_cast<std::uint32_t>(steps);
    for (std::uint32_t s = 0; s < sectors; ++s) {
        const double angle = 2.0 * kPi * s / steps;
        for (const Vec2& p : outline) {
            mesh.points.push_back({p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()});
        }
    }
    for (std::uint32_t s = 0; s < sectors; ++s) {
        const std::uint32_t here = s * corners;
        const std::uint32_t there = (s + 1) % sectors * corners;
        for (std::uint32_t k = 0; k < corners; ++k) {
            const std::uint32_t next = (k + 1) % corners;
            mesh.triangles.push_back({here + k, there + k, there + next});
            mesh.triangles.push_back({here + k, there + next, here + next});
        }
    }
    return mesh;
}

/// Lying flat about the origin; the tube's cross-section has `sides` sides.
inline TriangleMesh makeTorusMesh(double ringRadius, double tubeRadius, int steps, int sides)
{
    std::vector<Vec2> outline;
    for (int k = 0; k < sides; ++k) {
        const double angle = 2.0 * kPi * k / sides;
        outline.emplace_back(ringRadius + tubeRadius * std::cos(angle),
                             tubeRadius * std::sin(angle));
    }
    return makeTurnedMesh(outline, steps);
}

/// A closed outline in the (x, z) plane, counter-clockwise, as a strip of quadrilaterals between
/// upper and lower corners upper[k], lower[k] (left to right), drawn out from y = from to y = to.
inline TriangleMesh makeDrawnMesh(const std::vector<Vec2>& upper, const std::vector<Vec2>& lower,
                                  double from, double to)
{
    TriangleMesh mesh;
    const auto count = static_cast<std::uint32_t>(upper.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        for (const Vec2& p : {upper[k], lower[k]}) {
            mesh.points.push_back({p.x(), from, p.y()});
            mesh.points.push_back({p.x(), to, p.y()});
        }
    }
    const auto addQuad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    // Corners of cut k: 4k upper front, +1 upper back, +2 lower front, +3 lower back.
    for (std::uint32_t k = 0; k + 1 < count; ++k) {
        const std::uint32_t a = 4 * k;
        const std::uint32_t b = a + 4;
        addQuad(a, b, b + 1, a + 1);
        addQuad(a + 2, a + 3, b + 3, b + 2);
        addQuad(a, a + 2, b + 2, b);
        addQuad(a + 1, b + 1, b + 3, a + 3);
    }
    const std::uint32_t end = 4 * (count - 1);
    addQuad(0, 1, 3, 2);
    addQuad(end, end + 2, end + 3, end + 1);
    return mesh;
}

/// The blocks [xs[i], xs[i+1]] x [ys[j], ys[j+1]] x [zs[k], zs[k+1]] for which filled(i, j, k), as
/// one closed surface without the faces between them.
inline TriangleMesh makeBlocksMesh(const std::vector<double>& xs, const std::vector<double>& ys,
                                   const std::vector<double>& zs,
                                   const std::function<bool(int, int, int)>& filled)
{
    TriangleMesh mesh;
    const std::array<int, 3> blocks = {static_cast<int>(xs.size()) - 1,
                                       static_cast<int>(ys.size()) - 1,
                                       static_cast<int>(zs.size()) - 1};
    const auto isFilled = [&](const std::array<int, 3>& at) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (at[axis] < 0 || at[axis] >= blocks[axis]) {
                return false;
            }
        }
        return filled(at[0], at[1], at[2]);
    };
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    const auto numberOf = [&](const std::array<int, 3>& at) {
        const auto [found, isNew] =
            numbers.try_emplace(at, static_cast<std::uint32_t>(mesh.points.size()));
        if (isNew) {
            mesh.points.push_back({xs[static_cast<std::size_t>(at[0])],
                                   ys[static_cast<std::size_t>(at[1])],
                                   zs[static_cast<std::size_t>(at[2])]});
        }
        return found->second;
    };
    std::array<int, 3> at{};
    for (at[0] = 0; at[0] < blocks[0]; ++at[0]) {
        for (at[1] = 0; at[1] < blocks[1]; ++at[1]) {
            for (at[2] = 0; at[2] < blocks[2]; ++at[2]) {
                if (!isFilled(at)) {
                    continue;
                }
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    for (const int side : {0, 1}) {
                        std::array<int, 3> beyond = at;
                        beyond[axis] += side == 0 ? -1 : 1;
                        if (isFilled(beyond)) {
                            continue;
                        }
                        std::array<int, 3> corner = at;
                        corner[axis] += side;
                        const std::size_t u = (axis + 1) % 3;
                        const std::size_t v = (axis + 2) % 3;
                        const std::uint32_t a = numberOf(corner);
                        ++corner[u];
                        std::uint32_t b = numberOf(corner);
                        ++corner[v];
                        const std::uint32_t c = numberOf(corner);
                        --corner[u];
                        std::uint32_t d = numberOf(corner);
                        if (side == 0) {
                            std::swap(b, d);
                        }
                        mesh.triangles.push_back({a, b, c});
                        mesh.triangles.push_back({a, c, d});
                    }
                }
            }
        }
    }
    return mesh;
}

/// A square sheet of cells that faces up, at z = heightAt(x, y). Not closed.
inline TriangleMesh makeSheetMesh(double min, double max, int cells,
                                  const std::function<double(double, double)>& heightAt)
{
    TriangleMesh mesh;
    const auto count = static_cast<std::uint32_t>(cells);
    for (std::uint32_t j = 0; j <= count; ++j) {
        for (std::uint32_t i = 0; i <= count; ++i) {
            const double x = min + (max - min) * i / count;
            const double y = min + (max - min) * j / count;
            mesh.points.push_back({x, y, heightAt(x, y)});
        }
    }
    for (std::uint32_t j = 0; j < count; ++j) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t a = j * (count + 1) + i;
            const std::uint32_t b = a + count + 1;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
    }
    return mesh;
}

inline TriangleMesh turnedInsideOut(TriangleMesh mesh)
{
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

/// Both surfaces in one mesh.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b)
{
    const auto first = static_cast<std::uint32_t>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const auto& [i, j, k] : b.triangles) {
        a.triangles.push_back({first + i, first + j, first + k});
    }
    return a;
}

inline TriangleMesh mapped(TriangleMesh mesh, const std::function<Vec3(const Vec3&)>& map)
{
    for (Vec3& point : mesh.points) {
        point = map(point);
    }
    return mesh;
}

}  // namespace sandflow
