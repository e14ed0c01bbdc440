#pragma once

#include "solids/primitive.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

/// Independent knowledge of the primitives for tests: their surfaces as parametric patches,
/// searched by sampling. Shares no code with the library.
namespace sandflow::testing {

/// Surface patch: (s, t) in [0, 1]^2 to a point.
using SurfacePatch = std::function<Vec3(double s, double t)>;

inline const std::vector<Primitive::Kind>& allKinds()
{
    static const std::vector<Primitive::Kind> kinds = {
        Primitive::Kind::halfSpace, Primitive::Kind::solidBox,      Primitive::Kind::panel,
        Primitive::Kind::disc,      Primitive::Kind::solidCylinder, Primitive::Kind::tube};
    return kinds;
}

inline std::string nameKind(Primitive::Kind kind)
{
    switch (kind) {
        case Primitive::Kind::halfSpace:
            return "halfSpace";
        case Primitive::Kind::solidBox:
            return "solidBox";
        case Primitive::Kind::panel:
            return "panel";
        case Primitive::Kind::disc:
            return "disc";
        case Primitive::Kind::solidCylinder:
            return "solidCylinder";
        case Primitive::Kind::tube:
            return "tube";
    }
    return "?";
}

inline double drawUniform(std::mt19937_64& random, double lo, double hi)
{
    return std::uniform_real_distribution<double>(lo, hi)(random);
}

inline Vec3 drawPoint(std::mt19937_64& random, double reach)
{
    return {drawUniform(random, -reach, reach), drawUniform(random, -reach, reach),
            drawUniform(random, -reach, reach)};
}

inline Vec3 drawDirection(std::mt19937_64& random)
{
    while (true) {
        const Vec3 v = drawPoint(random, 1.0);
        if (v.norm() > 0.1 && v.norm() < 1.0) {
            return v.normalized();
        }
    }
}

/// Sizes between 0.1 and 1 m, near the origin; every third one has a vertical axis.
inline Primitive drawPrimitive(std::mt19937_64& random, Primitive::Kind kind)
{
    Primitive primitive;
    primitive.kind = kind;
    primitive.point = drawPoint(random, 0.5);
    primitive.axis = random() % 3 == 0 ? Vec3::UnitZ() : drawDirection(random);
    primitive.radius = drawUniform(random, 0.1, 1.0);
    primitive.height = drawUniform(random, 0.1, 1.0);
    primitive.min = drawPoint(random, 0.5);
    for (int axis = 0; axis < 3; ++axis) {
        primitive.max[axis] = primitive.min[axis] + drawUniform(random, 0.1, 1.0);
    }
    if (kind == Primitive::Kind::panel) {
        const int axis = static_cast<int>(random() % 3);
        primitive.max[axis] = primitive.min[axis];
    }
    return primitive;
}

/// Two unit vectors that make a frame with the axis.
inline std::pair<Vec3, Vec3> frameOf(const Vec3& axis)
{
    Eigen::Index smallest = 0;
    axis.cwiseAbs().minCoeff(&smallest);
    const Vec3 e1 = axis.cross(Vec3::Unit(smallest)).normalized();
    return {e1, axis.cross(e1).normalized()};
}

inline std::vector<SurfacePatch> surfacePatches(const Primitive& p)
{
    std::vector<SurfacePatch> patches;
    const auto [e1, e2] = frameOf(p.axis);
    const Vec3 c1 = e1;
    const Vec3 c2 = e2;
    // A square in the middle (corners just inside the rim) and the outer half in quarters: no seam
    // and no centre, where a direction has no meaning, for a search to be caught at.
    const auto addPlate = [&](double along) {
        const Vec3 centre = p.point + along * p.axis;
        patches.push_back([=](double s, double t) -> Vec3 {
            return centre + 1.4 * p.radius * ((s - 0.5) * c1 + (t - 0.5) * c2);
        });
        for (int quarter = 0; quarter < 4; ++quarter) {
            patches.push_back([=](double s, double t) -> Vec3 {
                const double angle = 0.5 * kPi * (quarter + t);
                const double radial = 0.5 * (1.0 + s) * p.radius;
                return centre + radial * (std::cos(angle) * c1 + std::sin(angle) * c2);
            });
        }
    };
    // In quarters for the same reason.
    const auto addSide = [&] {
        for (int quarter = 0; quarter < 4; ++quarter) {
            patches.push_back([=](double s, double t) -> Vec3 {
                const double angle = 0.5 * kPi * (quarter + t);
                return p.point + s * p.height * p.axis +
                       p.radius * (std::cos(angle) * c1 + std::sin(angle) * c2);
            });
        }
    };
    const auto addFace = [&](int axis, double at) {
        patches.push_back([=](double s, double t) -> Vec3 {
            const int i = (axis + 1) % 3;
            const int j = (axis + 2) % 3;
            Vec3 q;
            q[axis] = at;
            q[i] = p.min[i] + s * (p.max[i] - p.min[i]);
            q[j] = p.min[j] + t * (p.max[j] - p.min[j]);
            return q;
        });
    };
    switch (p.kind) {
        case Primitive::Kind::halfSpace:  // as much of it as points near the origin can see
            patches.push_back([=](double s, double t) -> Vec3 {
                return p.point + (8.0 * s - 4.0) * c1 + (8.0 * t - 4.0) * c2;
            });
            break;
        case Primitive::Kind::solidBox:
            for (int axis = 0; axis < 3; ++axis) {
                addFace(axis, p.min[axis]);
                addFace(axis, p.max[axis]);
            }
            break;
        case Primitive::Kind::panel:
            for (int axis = 0; axis < 3; ++axis) {
                if (p.min[axis] == p.max[axis]) {
                    addFace(axis, p.min[axis]);
                }
            }
            break;
        case Primitive::Kind::disc:
            addPlate(0.0);
            break;
        case Primitive::Kind::solidCylinder:
            addPlate(0.0);
            addPlate(p.height);
            addSide();
            break;
        case Primitive::Kind::tube:
            addSide();
            break;
    }
    return patches;
}

/// Distance from q to the patch: a 40 x 40 sampling, then eleven times a finer one about the
/// best sample, down to 1e-7 of the patch.
inline double searchPatch(const SurfacePatch& patch, const Vec3& q)
{
    double best2 = 1e300;
    double bestS = 0.5;
    double bestT = 0.5;
    const auto sweep = [&](double s0, double t0, double half, int n) {
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= n; ++j) {
                const double s = std::clamp(s0 + half * (2.0 * i / n - 1.0), 0.0, 1.0);
                const double t = std::clamp(t0 + half * (2.0 * j / n - 1.0), 0.0, 1.0);
                const double d2 = (patch(s, t) - q).squaredNorm();
                if (d2 < best2) {
                    best2 = d2;
                    bestS = s;
                    bestT = t;
                }
            }
        }
    };
    sweep(0.5, 0.5, 0.5, 40);
    double half = 0.05;
    for (int level = 0; level < 11; ++level) {
        sweep(bestS, bestT, half, 8);
        half *= 0.3;
    }
    return std::sqrt(best2);
}

/// Unsigned distance from q to the primitive's surface, by search; good to 1e-5 m.
inline double searchDistance(const Primitive& primitive, const Vec3& q)
{
    double best = 1e300;
    for (const SurfacePatch& patch : surfacePatches(primitive)) {
        best = std::min(best, searchPatch(patch, q));
    }
    return best;
}

/// True inside a filled primitive.
inline bool isInside(const Primitive& p, const Vec3& q)
{
    const double along = p.axis.dot(q - p.point);
    switch (p.kind) {
        case Primitive::Kind::halfSpace:
            return along < 0.0;
        case Primitive::Kind::solidBox:
            return (q.array() > p.min.array()).all() && (q.array() < p.max.array()).all();
        case Primitive::Kind::solidCylinder:
            return along > 0.0 && along < p.height && p.axis.cross(q - p.point).norm() < p.radius;
        case Primitive::Kind::panel:
        case Primitive::Kind::disc:
        case Primitive::Kind::tube:
            return false;
    }
    return false;
}

}  // namespace sandflow::testing
