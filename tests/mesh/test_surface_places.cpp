#include "mesh/sampling_shapes.h"
#include "mesh/scattered_order.h"
#include "mesh/surface_places.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sandflow {
namespace {

TEST(ScatteredOrder, HoldsEachNumberOnce)
{
    for (std::uint64_t count = 1; count < 300; ++count) {
        for (const std::uint64_t seed : {0u, 1u, 99u}) {
            const ScatteredOrder order(count, seed);
            std::vector<int> seen(count, 0);
            for (std::uint64_t k = 0; k < count; ++k) {
                ASSERT_LT(order.at(k), count);
                ++seen[order.at(k)];
            }
            ASSERT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(count));
        }
    }
}

/// Neither the places nor the steps between them show a trend: each is as a random order has it,
/// within five standard deviations.
TEST(ScatteredOrder, HasNoPattern)
{
    const std::uint64_t count = 100000;
    const double n = static_cast<double>(count);
    for (const std::uint64_t seed : {0u, 1u, 2u, 3u}) {
        const ScatteredOrder order(count, seed);
        double withPlace = 0.0;
        double withNext = 0.0;
        double upSteps = 0.0;
        const auto centred = [&](std::uint64_t k) {
            return static_cast<double>(order.at(k)) / n - 0.5;
        };
        for (std::uint64_t k = 0; k + 1 < count; ++k) {
            withPlace += centred(k) * (static_cast<double>(k) / n - 0.5);
            withNext += centred(k) * centred(k + 1);
            upSteps += centred(k + 1) > centred(k) ? 1.0 : 0.0;
        }
        EXPECT_NEAR(withPlace / n * 12.0, 0.0, 5.0 / std::sqrt(n));
        EXPECT_NEAR(withNext / n * 12.0, 0.0, 5.0 / std::sqrt(n));
        EXPECT_NEAR(upSteps / n, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / n));
    }
}

TEST(SurfacePlaces, LieInTheirTriangleAndAreSharedByArea)
{
    TriangleMesh mesh = makeSpike(0.2, 1.0);
    mesh.triangles.insert(mesh.triangles.begin() + 1, {0, 0, 3});  // without area
    mesh.triangles.push_back({1, 1, 1});
    const std::uint64_t count = 5000;
    const SurfacePlaces places(mesh, count, 3);
    std::vector<double> found(mesh.triangles.size(), 0.0);
    for (std::uint64_t k = 0; k < count; ++k) {
        const auto [point, triangle] = places.at(k);
        found[triangle] += 1.0;
        const auto& [a, b, c] = mesh.triangles[triangle];
        const auto doubleArea = [](const Vec3& p, const Vec3& q, const Vec3& r) {
            return (q - p).cross(r - p).norm();
        };
        const Vec3& pa = mesh.points[a];
        const Vec3& pb = mesh.points[b];
        const Vec3& pc = mesh.points[c];
        EXPECT_NEAR(
            doubleArea(point, pb, pc) + doubleArea(pa, point, pc) + doubleArea(pa, pb, point),
            doubleArea(pa, pb, pc), 1e-12);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        TriangleMesh single = mesh;
        single.triangles = {mesh.triangles[t]};
        const double expected = areaOf(single) / areaOf(mesh) * static_cast<double>(count);
        // Stretches of equal area: only the two that cross its ends are chance.
        EXPECT_NEAR(found[t], expected, expected == 0.0 ? 0.0 : 2.0) << t;
    }
}

TEST(SurfacePlaces, AreUniformWithinATriangle)
{
    TriangleMesh mesh;
    mesh.points = {Vec3::Zero(), {2.0, 0.0, 0.0}, {0.0, 3.0, 0.0}};
    mesh.triangles = {{0, 1, 2}};
    const std::uint64_t count = 90000;
    const SurfacePlaces places(mesh, count, 8);
    // Nine equal triangles, three to a side: row of the cell, column, upper or lower half.
    std::vector<double> found(18, 0.0);
    for (std::uint64_t k = 0; k < count; ++k) {
        const Vec3 p = places.at(k).point;
        const double u = 3.0 * p.x() / 2.0;
        const double v = 3.0 * p.y() / 3.0;
        const bool upper = u - std::floor(u) + v - std::floor(v) > 1.0;
        found[static_cast<std::size_t>(u) + 3 * static_cast<std::size_t>(v) + (upper ? 9 : 0)] += 1;
    }
    double cells = 0.0;
    for (const double in : found) {
        if (in > 0.0) {
            EXPECT_NEAR(in, 10000.0, 500.0);
            cells += 1.0;
        }
    }
    EXPECT_EQ(cells, 9.0);
}

}  // namespace
}  // namespace sandflow
