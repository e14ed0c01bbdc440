#include "measure/packing.h"
#include "synthetic_heaps.h"

#include <gtest/gtest.h>
#include <omp.h>

namespace sandflow {
namespace {

using namespace testing;

Snapshot makeCubicLattice(int edge, double spacing)
{
    Snapshot snapshot = emptySnapshot();
    for (int k = 0; k < edge; ++k) {
        for (int j = 0; j < edge; ++j) {
            for (int i = 0; i < edge; ++i) {
                addGrain(snapshot, Vec3(i, j, k) * spacing);
            }
        }
    }
    return snapshot;
}

TEST(Packing, CubicLatticeHasItsContactsAndOverlap)
{
    const int edge = 9;
    const PackingFigures figures = measurePacking(makeCubicLattice(edge, 0.98 * kDiameter));
    const std::size_t contacts = 3 * edge * edge * (edge - 1);
    EXPECT_EQ(figures.grains, std::size_t{edge * edge * edge});
    EXPECT_EQ(figures.contacts, contacts);
    EXPECT_NEAR(figures.meanCoordination, 2.0 * static_cast<double>(contacts) / 729.0, 1e-12);
    EXPECT_NEAR(figures.meanOverlap, 0.04, 1e-6);
    EXPECT_NEAR(figures.maxOverlap, 0.04, 1e-6);
}

TEST(Packing, LatticeThatDoesNotTouchHasNone)
{
    const PackingFigures figures = measurePacking(makeCubicLattice(5, 1.001 * kDiameter));
    EXPECT_EQ(figures.contacts, 0u);
    EXPECT_EQ(figures.meanOverlap, 0.0);
    EXPECT_EQ(figures.floatingSlow, 0u) << "neighbours within 2 % of a diameter";
}

TEST(Packing, AgreesWithTryingEveryPair)
{
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> place(-0.05, 0.05);
    std::uniform_real_distribution<double> size(0.4, 2.0);
    Snapshot snapshot = emptySnapshot();
    for (int n = 0; n < 1500; ++n) {
        addGrain(snapshot, {place(random), place(random), place(random)}, kRadius * size(random));
    }
    std::size_t contacts = 0;
    double sum = 0.0;
    double most = 0.0;
    for (std::size_t a = 0; a < snapshot.size(); ++a) {
        for (std::size_t b = a + 1; b < snapshot.size(); ++b) {
            const double ra = snapshot.radius[a];
            const double rb = snapshot.radius[b];
            const double overlap = ra + rb - (snapshot.position[a] - snapshot.position[b]).norm();
            if (overlap > 0.0) {
                ++contacts;
                sum += overlap / std::min(ra, rb);
                most = std::max(most, overlap / std::min(ra, rb));
            }
        }
    }
    ASSERT_GT(contacts, 1000u);
    const PackingFigures figures = measurePacking(snapshot);
    EXPECT_EQ(figures.contacts, contacts);
    EXPECT_NEAR(figures.meanOverlap, sum / static_cast<double>(contacts), 1e-12);
    EXPECT_NEAR(figures.maxOverlap, most, 1e-12);
}

TEST(Packing, SameBitsForAnyNumberOfThreads)
{
    const Snapshot heap = makeRandomCone(0.5, 0.12, 1);
    ASSERT_GT(heap.size(), 2048u) << "several chunks";
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const PackingFigures serial = measurePacking(heap);
    omp_set_num_threads(4);
    const PackingFigures parallel = measurePacking(heap);
    omp_set_num_threads(threads);
    EXPECT_EQ(serial.contacts, parallel.contacts);
    EXPECT_EQ(serial.meanOverlap, parallel.meanOverlap);
    EXPECT_EQ(serial.maxOverlap, parallel.maxOverlap);
}

TEST(Packing, CountsFrozenGrainsThatHangInTheAir)
{
    Snapshot snapshot = emptySnapshot();
    addGrain(snapshot, {0, 0, 0.2}, kRadius, GrainState::interface);
    addGrain(snapshot, {1, 0, 0.2}, kRadius, GrainState::buried);
    addGrain(snapshot, {2, 0, kRadius}, kRadius, GrainState::buried);           // on the floor
    addGrain(snapshot, {3, 0, 1.9 * kRadius}, kRadius, GrainState::interface);  // on its cover
    EXPECT_EQ(measurePacking(snapshot).floatingFrozen, 2u);
    addGrain(snapshot, {0, 0, 0.2 - 2.03 * kRadius}, kRadius, GrainState::interface);
    EXPECT_EQ(measurePacking(snapshot).floatingFrozen, 1u)
        << "1.5 % of a diameter from touching is touching, for both";
    snapshot.position.back().z() = 0.2 - 2.05 * kRadius;
    EXPECT_EQ(measurePacking(snapshot).floatingFrozen, 3u) << "2.5 % is not";
}

TEST(Packing, FlyingGrainsDoNotFloatButRestingOnesDo)
{
    Snapshot snapshot = emptySnapshot();
    addGrain(snapshot, {0, 0, 0.2}, kRadius, GrainState::mobile, Vec3f(0, 0, -1.0f));
    addGrain(snapshot, {1, 0, 0.2}, kRadius, GrainState::mobile);
    addGrain(snapshot, {2, 0, 0.2}, kRadius, GrainState::asleep);
    const PackingFigures figures = measurePacking(snapshot);
    EXPECT_EQ(figures.floatingSlow, 2u);
    EXPECT_EQ(figures.floatingFrozen, 0u);
}

TEST(Packing, EmptySnapshotHasNothing)
{
    const PackingFigures figures = measurePacking(emptySnapshot());
    EXPECT_EQ(figures.grains, 0u);
    EXPECT_EQ(figures.contacts, 0u);
    EXPECT_EQ(figures.meanCoordination, 0.0);
}

}  // namespace
}  // namespace sandflow
