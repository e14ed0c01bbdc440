#include "mesh/leak_flood.h"
#include "mesh/sample_surface.h"
#include "mesh/sampling_shapes.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

// Lengths in grain radii: boundary particles of half a radius touch grains at a distance of 1.5.
constexpr double kGap = 0.9;
constexpr double kContact = 1.5;
constexpr double kCell = 0.25;
/// How near to a boundary particle a grain is let: pressed in by 40% of the contact distance, far
/// more than the overlap at which a run stops.
constexpr double kPressed = 0.6 * kContact;

const auto kEverywhere = [](const Vec3&) { return true; };

Eigen::AlignedBox3d widened(Eigen::AlignedBox3d box)
{
    box.min() -= Vec3::Constant(2.1);
    box.max() += Vec3::Constant(2.2);
    return box;
}

/// Cells of the solid that a flood from outside reaches.
template <typename IsInside>
std::size_t leaksInto(const TriangleMesh& mesh, double gap, const IsInside& isInside)
{
    const SurfaceSamples samples = sampleSurface(mesh, gap, 1);
    const Eigen::AlignedBox3d box = widened(boundsOf(mesh));
    const LeakFlood flood(samples.points, box, kCell, kPressed);
    return flood.countReached(box.min() + Vec3::Constant(0.5 * kCell), kEverywhere, isInside);
}

TEST(SampleLeaks, BoxIsTight)
{
    const Eigen::AlignedBox3d solid(Vec3(1.0, 2.0, 3.0), Vec3(17.3, 14.1, 13.2));
    const TriangleMesh mesh = makeBoxMesh(solid.min(), solid.max());
    const auto isInside = [&](const Vec3& p) { return solid.contains(p); };
    EXPECT_EQ(leaksInto(mesh, kGap, isInside), 0u);
    EXPECT_GT(leaksInto(mesh, 3.0, isInside), 1000u);
}

TEST(SampleLeaks, SphereIsTight)
{
    const double radius = 10.0;
    for (const int level : {1, 4}) {
        const TriangleMesh mesh = makeIcosphereMesh(Vec3::Zero(), radius, level);
        // The ball within the faces: inside for certain.
        double within = radius;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 normal =
                (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
            within = std::min(within, normal.normalized().dot(mesh.points[a]));
        }
        const auto isInside = [&](const Vec3& p) { return p.norm() < within; };
        EXPECT_EQ(leaksInto(mesh, kGap, isInside), 0u);
        EXPECT_GT(leaksInto(mesh, 3.0, isInside), 1000u);
    }
}

/// A thin spike is all surface: what can leak is its foot.
TEST(SampleLeaks, SpikeIsTight)
{
    const TriangleMesh mesh = makeSpike(9.0, 40.0);
    const auto isInside = [&](const Vec3& p) {
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 normal =
                (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
            if (normal.dot(p - mesh.points[a]) > 0.0) {
                return false;
            }
        }
        return true;
    };
    EXPECT_EQ(leaksInto(mesh, kGap, isInside), 0u);
    EXPECT_GT(leaksInto(mesh, 3.0, isInside), 100u);
}

/// Flooded from its hollow up to the rim, as sand would fill it.
std::size_t leaksOutOf(double inner, double outer, double gap)
{
    const TriangleMesh mesh = makeBowl(inner, outer);
    const SurfaceSamples samples = sampleSurface(mesh, gap, 1);
    const LeakFlood flood(samples.points, widened(boundsOf(mesh)), kCell, kPressed);
    // From the ball of the inner radius on everything is wall, and then outside.
    return flood.countReached(
        Vec3(0.0, 0.0, -0.5 * inner), [](const Vec3& p) { return p.z() < 0.0; },
        [&](const Vec3& p) { return p.norm() > inner; });
}

TEST(SampleLeaks, BowlIsTight)
{
    EXPECT_EQ(leaksOutOf(9.0, 13.0, kGap), 0u);
    EXPECT_EQ(leaksOutOf(9.0, 9.2, kGap), 0u);
    EXPECT_GT(leaksOutOf(9.0, 13.0, 3.0), 1000u);
    EXPECT_GT(leaksOutOf(9.0, 9.2, 3.0), 1000u);
}

}  // namespace
}  // namespace sandflow
