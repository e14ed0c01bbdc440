#pragma once

#include "dem/contact_lists.h"
#include "grains/frozen_info.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

/// Random clouds of grains with contact lists of their own.
namespace sandflow::cloud {

inline constexpr double kMeanRadius = 0.005;
inline constexpr double kSkin = 0.3 * kMeanRadius;
inline constexpr double kHorizon = 0.008;  // s, 64 steps of 1.25e-4 s

/// A ball that a grain is promised to stay in, and the grain's radius.
struct Ball {
    Vec3 centre;
    double reach, radius;
    std::uint32_t id;
};

inline Ball ballOf(const GrainRecord<float>& g, bool isFixed)
{
    const Vec3 ahead = isFixed ? Vec3::Zero() : Vec3(Vec3(g.vx, g.vy, g.vz) * (0.5 * kHorizon));
    return {Vec3(g.x, g.y, g.z) + ahead, isFixed ? 0.0 : 0.5 * kSkin + ahead.norm(),
            static_cast<double>(g.radius), g.id};
}

/// A random cloud of grains: `fastShare` of them at 1 to 4 m/s, the others below 0.1 m/s; radii
/// from smallest to largest.
struct Cloud {
    double largest = 1.08 * kMeanRadius;
    MobileGrains<float> mobile;
    FixedGrains<float, FrozenInfo> frozen;
    FixedGrains<float, BoundaryInfo> boundary;
    ContactLists<float> lists;
    ContactBook<float> book;

    explicit Cloud(double largestRadius)
        : largest(largestRadius),
          frozen(cellSize()),
          boundary(cellSize()),
          lists(cellSize(), kSkin, largestRadius)
    {
    }

    double cellSize() const { return std::max(3.0 * kMeanRadius, 2.0 * largest + 1.05 * kSkin); }

    void rebuild()
    {
        lists.rebuild(kHorizon, mobile, frozen, boundary, {}, 0.0, book, [](const SortedCells&) {});
    }
};

struct CloudSpec {
    std::size_t mobile = 3000, frozen = 800, boundary = 800;
    double smallest = 0.92 * kMeanRadius, largest = 1.08 * kMeanRadius;
    double fastShare = 0.02;
    double halfWidth = 0.12;  ///< m
    Vec3 centre = Vec3::Zero();
    unsigned seed = 1;
};

inline Cloud makeCloud(const CloudSpec& spec)
{
    Cloud cloud(spec.largest);
    std::mt19937 random(spec.seed);
    std::uniform_real_distribution<double> place(-spec.halfWidth, spec.halfWidth), share(0.0, 1.0);
    std::normal_distribution<double> normal;
    const auto makeRecord = [&](std::uint32_t id) {
        GrainRecord<float> g;
        const double x = place(random), y = place(random), z = place(random);
        g.x = spec.centre.x() + x, g.y = spec.centre.y() + y, g.z = spec.centre.z() + z;
        g.radius =
            static_cast<float>(spec.smallest + (spec.largest - spec.smallest) * share(random));
        g.id = id;
        return g;
    };
    std::uint32_t id = 0;
    for (std::size_t n = 0; n < spec.mobile; ++n) {
        GrainRecord<float> g = makeRecord(id++);
        g.inverseMass = 1.0f;
        const double vx = normal(random), vy = normal(random), vz = normal(random);
        const double speed =
            share(random) < spec.fastShare ? 1.0 + 3.0 * share(random) : 0.1 * share(random);
        const Vec3 v = speed * Vec3(vx, vy, vz).normalized();
        g.vx = static_cast<float>(v.x()), g.vy = static_cast<float>(v.y());
        g.vz = static_cast<float>(v.z());
        cloud.mobile.add(g);
    }
    for (std::size_t n = 0; n < spec.frozen; ++n) {
        cloud.frozen.add(makeRecord(id++), {});
    }
    for (std::uint32_t n = 0; n < spec.boundary; ++n) {
        cloud.boundary.add(makeRecord(kFirstBoundaryId + n), {});
    }
    return cloud;
}

}  // namespace sandflow::cloud
