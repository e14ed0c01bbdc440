#include "core/errors.h"
#include "core/hash.h"
#include "mesh/sample_search.h"
#include "mesh/sample_surface.h"
#include "mesh/sampling_shapes.h"

#include <gtest/gtest.h>

#include <limits>
#include <omp.h>

namespace sandflow {
namespace {

constexpr double kGap = 0.0045;  ///< m

std::uint64_t hashOf(const SurfaceSamples& samples)
{
    StateHash hash;
    hash.add(samples.points.data(), samples.points.size() * sizeof(Vec3));
    hash.add(samples.normals.data(), samples.normals.size() * sizeof(Vec3));
    return hash.value();
}

double densityOf(const SurfaceSamples& samples, const TriangleMesh& mesh)
{
    return static_cast<double>(samples.points.size()) * kGap * kGap / areaOf(mesh);
}

/// The certificate, with the stronger meaning: within the gap of a sample of the same face.
TEST(SampleSurface, NoPointIsFartherThanTheGapFromASample)
{
    std::mt19937_64 random(1);
    for (const NamedMesh& named : makeSampledMeshes(kGap)) {
        const SurfaceSamples samples = sampleSurface(named.mesh, kGap, 1);
        const SampleSearch search(samples, kGap);
        double worst = 0.0;
        for (const auto& [point, normal] : drawOnSurface(named.mesh, 200000, random)) {
            worst = std::max(worst, search.distanceTo(point, normal));
        }
        RecordProperty("worst_over_gap " + named.name, std::to_string(worst / kGap));
        EXPECT_LE(worst, kGap) << named.name;
        EXPECT_GT(worst, 0.8 * kGap) << named.name << " has more samples than it needs";
    }
}

TEST(SampleSurface, HoldsForOtherGapsAndSeeds)
{
    std::mt19937_64 random(2);
    const TriangleMesh mesh = makeSheet(10, 8, 0.01);
    for (const double gap : {0.0007, 0.003, 0.02, 0.5}) {
        for (const std::uint64_t seed : {0u, 7u, 4000000000u}) {
            const SurfaceSamples samples = sampleSurface(mesh, gap, seed);
            const SampleSearch search(samples, gap);
            for (const auto& [point, normal] : drawOnSurface(mesh, 5000, random)) {
                ASSERT_LE(search.distanceTo(point, normal), gap) << gap << " m, seed " << seed;
            }
        }
    }
}

/// Darts come first and keep the whole gap; only the certificate comes closer, to 0.85 gap.
TEST(SampleSurface, SamplesKeepApart)
{
    for (const NamedMesh& named : makeSampledMeshes(kGap)) {
        const SurfaceSamples samples = sampleSurface(named.mesh, kGap, 1);
        const SampleSearch search(samples, kGap);
        double closest = kGap;
        std::size_t latecomers = 0;
        std::uint32_t firstLate = std::numeric_limits<std::uint32_t>::max();
        for (std::uint32_t s = 0; s < samples.points.size(); ++s) {
            bool isLate = false;
            search.visitNear(samples.points[s], [&](std::uint32_t other) {
                const double apart = (samples.points[s] - samples.points[other]).norm();
                if (other < s && apart < kGap &&
                    samples.normals[s].dot(samples.normals[other]) > 0.5) {
                    closest = std::min(closest, apart);
                    isLate = true;
                }
            });
            latecomers += isLate ? 1 : 0;
            if (isLate) {
                firstLate = std::min(firstLate, s);
            }
        }
        const double count = static_cast<double>(samples.points.size());
        const double share = static_cast<double>(latecomers) / count;
        RecordProperty("closest_over_gap " + named.name, std::to_string(closest / kGap));
        RecordProperty("late_share " + named.name, std::to_string(share));
        EXPECT_GE(closest, 0.85 * kGap) << named.name;
        EXPECT_LT(share, 0.27) << named.name;
        // All that come close are at the end, behind the darts.
        EXPECT_GT(firstLate, 0.7 * count) << named.name;
    }
}

TEST(SampleSurface, CountFollowsTheArea)
{
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        const TriangleMesh sphere = makeIcosphereMesh(Vec3::Zero(), 25.0 * kGap, 4);
        const TriangleMesh box = makeBoxMesh(Vec3::Zero(), kGap * Vec3(60.0, 50.0, 40.0));
        const double onSphere = densityOf(sampleSurface(sphere, kGap, seed), sphere);
        const double onBox = densityOf(sampleSurface(box, kGap, seed), box);
        RecordProperty("sphere " + std::to_string(seed), std::to_string(onSphere));
        RecordProperty("box " + std::to_string(seed), std::to_string(onBox));
        EXPECT_NEAR(onSphere, 0.74, 0.015);
        EXPECT_NEAR(onBox, 0.765, 0.015);  // edges have samples on both sides
    }
}

TEST(SampleSurface, BothFacesOfAThinPlateGetSamples)
{
    const Vec3 size = kGap * Vec3(50.0, 40.0, 0.3);
    const SurfaceSamples samples = sampleSurface(makeBoxMesh(Vec3::Zero(), size), kGap, 1);
    const double faceDensity = kGap * kGap / (size.x() * size.y());
    std::array<double, 2> found{};
    for (std::size_t s = 0; s < samples.points.size(); ++s) {
        const double up = samples.normals[s].z();
        if (std::abs(up) > 0.5) {
            EXPECT_NEAR(samples.points[s].z(), up > 0.0 ? size.z() : 0.0, 1e-12);
            found[up > 0.0 ? 1 : 0] += faceDensity;
        }
    }
    for (const double density : found) {
        EXPECT_NEAR(density, 0.765, 0.03);
    }
}

TEST(SampleSurface, SamplesLieOnTheSurfaceWithItsNormals)
{
    const double radius = 15.0 * kGap;
    const TriangleMesh mesh = makeIcosphereMesh(Vec3::Zero(), radius, 4);
    const SurfaceSamples samples = sampleSurface(mesh, kGap, 1);
    ASSERT_EQ(samples.points.size(), samples.normals.size());
    for (std::size_t s = 0; s < samples.points.size(); ++s) {
        const Vec3 outward = samples.points[s].normalized();
        EXPECT_NEAR(samples.points[s].norm(), radius, 0.002 * radius);
        EXPECT_NEAR(samples.normals[s].norm(), 1.0, 1e-12);
        EXPECT_GT(samples.normals[s].dot(outward), 0.99);
    }
}

/// Nothing is random but by the seed, and the threads of the machine do not matter. The value also
/// holds for other compilers and processors. If it must change, raise the version of the cache.
TEST(SampleSurface, SameBitsEverywhere)
{
    const TriangleMesh mesh = makeBoxMesh(Vec3(0.1, 0.2, 0.3), Vec3(0.2, 0.25, 0.33));
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const std::uint64_t alone = hashOf(sampleSurface(mesh, kGap, 5));
    omp_set_num_threads(4);
    const std::uint64_t together = hashOf(sampleSurface(mesh, kGap, 5));
    omp_set_num_threads(threads);
    EXPECT_EQ(alone, together);
    EXPECT_EQ(alone, 0xa1ed63f7efb3ca74ULL) << std::hex << alone;
    EXPECT_NE(alone, hashOf(sampleSurface(mesh, kGap, 6)));
}

TEST(SampleSurface, TrianglesWithoutAreaCountAsLines)
{
    TriangleMesh mesh;
    mesh.points = {
        Vec3::Zero(), {20.0 * kGap, 0.0, 0.0}, {0.1 * kGap, 0.0, 0.0}, {0.0, 9.0 * kGap, 0.0}};
    mesh.triangles = {{0, 1, 2}, {3, 3, 3}, {0, 1, 1}};
    const SurfaceSamples samples = sampleSurface(mesh, kGap, 1);
    const SampleSearch search(samples, kGap);
    for (int k = 0; k <= 1000; ++k) {
        const Vec3 point(0.02 * kGap * k, 0.0, 0.0);
        EXPECT_LE(search.distanceTo(point, Vec3::UnitZ()), kGap) << k;
    }
    EXPECT_LE(search.distanceTo(mesh.points[3], Vec3::UnitZ()), kGap);
    EXPECT_LT(samples.points.size(), 25u);  // once, not once per triangle
}

/// A needle costs what its length costs: about a sample per gap, and no time beyond that. (Cutting
/// it into triangles would take 3^15 of them.)
TEST(SampleSurface, NeedlesAreNoTrouble)
{
    const double length = 30000.0 * kGap;
    TriangleMesh mesh;
    mesh.points = {Vec3::Zero(), {length, 0.0, 0.0}, {0.0, 0.3 * kGap, 0.0}};
    mesh.triangles = {{0, 1, 2}};
    const SurfaceSamples samples = sampleSurface(mesh, kGap, 1);
    EXPECT_GT(samples.points.size(), 15000u);
    EXPECT_LT(samples.points.size(), 30000u);
    const SampleSearch search(samples, kGap);
    for (int k = 0; k <= 100000; ++k) {
        const Vec3 point(length * k / 100000.0, 0.0, 0.0);
        ASSERT_LE(search.distanceTo(point, Vec3::UnitZ()), kGap) << k;
    }
}

TEST(SampleSurface, SmallAndEmptyMeshes)
{
    EXPECT_TRUE(sampleSurface(TriangleMesh{}, kGap, 1).points.empty());
    // A whole cube within the gap: one sample per face.
    const TriangleMesh speck = makeBoxMesh(Vec3::Zero(), Vec3::Constant(1e-6));
    EXPECT_EQ(sampleSurface(speck, kGap, 1).points.size(), 6u);
}

std::string refusalOf(const TriangleMesh& mesh, double gap)
{
    try {
        sampleSurface(mesh, gap, 1);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(SampleSurface, RefusesWhatIsTooMuchBeforeItStarts)
{
    const TriangleMesh cube = makeBoxMesh(Vec3::Zero(), Vec3::Ones());
    EXPECT_EQ(refusalOf(cube, 1e-4),
              "A mesh of 6 m2 takes about 4.4e+08 particles to cover at 0.0001 m apart, more than "
              "the 8000000 allowed; make it smaller or the grains larger.");
    EXPECT_EQ(refusalOf(makeBoxMesh(Vec3::Constant(2e6), Vec3::Constant(2e6 + 1.0)), 0.01),
              "A mesh that reaches 2000001 m from the origin cannot be covered with particles 0.01 "
              "m apart; move it closer, to within 1000000 m.");
    TriangleMesh islands;
    islands.points = {Vec3::Zero(),
                      Vec3::UnitX(),
                      Vec3::UnitY(),
                      Vec3::Constant(3e5),
                      Vec3::Constant(3e5) + Vec3::UnitX(),
                      Vec3::Constant(3e5) + Vec3::UnitY()};
    islands.triangles = {{0, 1, 2}, {3, 4, 5}};
    EXPECT_EQ(
        refusalOf(islands, 0.1),
        "A mesh 300001 m wide cannot be covered with particles 0.1 m apart, only one of up to "
        "200000 m; make it smaller or the grains larger.");
    TriangleMesh broken = cube;
    broken.points[3].y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusalOf(broken, 0.01), "accepted");
    broken.points[3].y() = std::numeric_limits<double>::infinity();
    EXPECT_NE(refusalOf(broken, 0.01), "accepted");
    EXPECT_THROW(sampleSurface(cube, 0.0, 1), InternalError);
}

}  // namespace
}  // namespace sandflow
