#include "bcre/surface_height.h"

#include "core/errors.h"
#include "test_fields.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace sandflow {
namespace {

using Intervals = std::vector<ColumnGrid::FreeInterval>;

constexpr double kRadius = 0.005;
constexpr double kDiameter = 2.0 * kRadius;
constexpr double kCell = 3.0 * kDiameter;

ColumnGrid makeGround()
{
    return ColumnGrid(
        kCell, [](double, double, Intervals& out) { out.push_back({0.0, 1e30}); }, {});
}

/// Sum of H over all spans times the area of a column, m3.
double volumeUnderSurface(const ColumnGrid& columns)
{
    double sum = 0.0;
    for (const double top : columns.H) {
        sum += top;
    }
    return sum * columns.cellSize() * columns.cellSize();
}

double heightOver(const ColumnGrid& columns, double x, double y)
{
    return columns.H[columns.spanAt(x, y, 0.0)];
}

std::vector<AccumulatedGrain> scatterGrains(int count, double extent, double height)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> side(-extent, extent);
    std::uniform_real_distribution<double> up(kRadius, height);
    std::uniform_real_distribution<double> size(0.92 * kRadius, 1.08 * kRadius);
    std::vector<AccumulatedGrain> grains;
    for (int k = 0; k < count; ++k) {
        const double x = side(random);
        const double y = side(random);
        const double z = up(random);
        grains.push_back({Vec3(x, y, z), size(random)});
    }
    return grains;
}

TEST(SurfaceHeight, OneSphereOnSixBySixRays)
{
    ColumnGrid columns = makeGround();
    // Over the centre of column (0, 0); rays lie at odd multiples of 2.5 mm around it.
    const std::vector<AccumulatedGrain> grains{{Vec3(0.5 * kCell, 0.5 * kCell, kRadius), kRadius}};
    measureSurfaceHeight(grains, kDiameter, 0.0, columns);
    // Four rays at a distance r/sqrt(2) meet the cap; the next ones, at 7.5 mm, do not.
    const double cap = kRadius + kRadius * std::sqrt(0.5);
    EXPECT_NEAR(heightOver(columns, 0.5 * kCell, 0.5 * kCell), 4.0 * cap / 36.0, 1e-15);
    EXPECT_EQ(heightOver(columns, 1.5 * kCell, 0.5 * kCell), 0.0);
}

TEST(SurfaceHeight, OneSphereHasTheVolumeOfItsShadow)
{
    // Fine rays: the shadow of a sphere that lies on the floor is pi r^2 r + half its volume, also
    // where it lies over the corner of four columns.
    const double radius = 0.4 * kCell;
    const double exact = kPi * radius * radius * radius * (1.0 + 2.0 / 3.0);
    for (const Vec2& centre : {Vec2(0.5 * kCell, 0.5 * kCell), Vec2(0.0, 0.0), Vec2(0.9 * kCell,
                                                                                   0.2 * kCell)}) {
        ColumnGrid columns = makeGround();
        const std::vector<AccumulatedGrain> grains{{Vec3(centre.x(), centre.y(), radius), radius}};
        measureSurfaceHeight(grains, 0.02 * kCell, 0.0, columns);
        EXPECT_NEAR(volumeUnderSurface(columns), exact, 2e-3 * exact);
    }
}

TEST(SurfaceHeight, ASphereLargerThanAColumnReachesFurther)
{
    ColumnGrid columns = makeGround();
    const double radius = 1.7 * kCell;
    const std::vector<AccumulatedGrain> grains{{Vec3(0.1 * kCell, 0.2 * kCell, radius), radius}};
    measureSurfaceHeight(grains, 0.04 * kCell, 0.0, columns);
    const double exact = kPi * radius * radius * radius * (1.0 + 2.0 / 3.0);
    EXPECT_NEAR(volumeUnderSurface(columns), exact, 2e-3 * exact);
}

TEST(SurfaceHeight, FlatLayerStandsAtItsMeanCap)
{
    // A square lattice of touching spheres at z: the mean cap is z + V/2 / d^2 over the discs, the
    // floor over the rest of the area.
    // The rays do not repeat with the spheres, so their errors average out.
    ColumnGrid columns = makeGround();
    const double z = 0.05;
    std::vector<AccumulatedGrain> grains;
    for (int j = -9; j < 12; ++j) {
        for (int i = -9; i < 12; ++i) {
            grains.push_back({Vec3((i + 0.5) * kDiameter, (j + 0.5) * kDiameter, z), kRadius});
        }
    }
    measureSurfaceHeight(grains, 0.037 * kDiameter, 0.0, columns);
    const double exact = z * kPi / 4.0 + kPi / 12.0 * kDiameter;
    EXPECT_NEAR(heightOver(columns, 0.01, 0.01), exact, 2e-3 * exact);
    // Smoothing changes nothing where the surface is flat.
    const double before = heightOver(columns, 0.01, 0.01);
    measureSurfaceHeight(grains, 0.037 * kDiameter, 0.3, columns);
    EXPECT_NEAR(heightOver(columns, 0.01, 0.01), before, 1e-12);
}

TEST(SurfaceHeight, ConeOfSpheresHasTheSlopeOfTheCone)
{
    // Spheres closer than the rays, with their tops on a cone of 30 degrees: H of a column is the
    // cone's height at its centre, shifted by the same small amount everywhere on the flank.
    const double slope = std::tan(kPi / 6.0);
    const double apex = 0.2;
    std::vector<AccumulatedGrain> grains;
    for (int j = -160; j <= 160; ++j) {
        for (int i = -160; i <= 160; ++i) {
            const double x = 0.0025 * i;
            const double y = 0.0025 * j;
            const double z = apex - slope * std::hypot(x, y);
            if (z > 0.0) {
                grains.push_back({Vec3(x, y, z), kRadius});
            }
        }
    }
    ColumnGrid columns = makeGround();
    measureSurfaceHeight(grains, kDiameter, 0.0, columns);
    double least = 1e30;
    double most = -1e30;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const double x = (columns.columnI[s] + 0.5) * kCell;
        const double y = (columns.columnJ[s] + 0.5) * kCell;
        const double radius = std::hypot(x, y);
        if (radius > 2.0 * kCell && radius < 0.28) {
            const double above = columns.H[s] - (apex - slope * radius);
            least = std::min(least, above);
            most = std::max(most, above);
        }
    }
    // Spheres on a plane of that slope would stand r / cos(30) = 5.77 mm above their centres.
    EXPECT_GT(least, 0.8 * kRadius);
    EXPECT_LT(most, kRadius / std::cos(kPi / 6.0));
    EXPECT_LT(most - least, 0.15 * kDiameter);
}

TEST(SurfaceHeight, SmoothingMixesInTheMeanOfTheNeighbours)
{
    ColumnGrid columns = makeGround();
    const std::vector<AccumulatedGrain> grains{{Vec3(0.5 * kCell, 0.5 * kCell, kRadius), kRadius}};
    measureSurfaceHeight(grains, kDiameter, 0.0, columns);
    const double raw = heightOver(columns, 0.5 * kCell, 0.5 * kCell);
    measureSurfaceHeight(grains, kDiameter, 0.3, columns);
    EXPECT_NEAR(heightOver(columns, 0.5 * kCell, 0.5 * kCell), 0.7 * raw, 1e-15);
    EXPECT_NEAR(heightOver(columns, 1.5 * kCell, 0.5 * kCell), 0.3 / 4.0 * raw, 1e-15);
    EXPECT_EQ(heightOver(columns, 1.5 * kCell, 1.5 * kCell), 0.0);
}

TEST(SurfaceHeight, SmoothingDoesNotReachOverALedge)
{
    // A terrace 0.2 m high with sand on it beside bare ground.
    ColumnGrid columns(
        kCell,
        [](double x, double, Intervals& out) { out.push_back({x < 0.0 ? 0.2 : 0.0, 1e30}); }, {});
    std::vector<AccumulatedGrain> grains;
    for (int j = 0; j < 24; ++j) {
        for (int i = -24; i < 0; ++i) {
            grains.push_back({Vec3((i + 0.5) * kDiameter, (j + 0.5) * kDiameter, 0.2 + kRadius),
                              kRadius});
        }
    }
    measureSurfaceHeight(grains, kDiameter, 0.3, columns);
    EXPECT_EQ(heightOver(columns, 0.5 * kCell, 0.12), 0.0) << "no sand lies on the ground";
    EXPECT_NEAR(heightOver(columns, -0.5 * kCell, 0.12), heightOver(columns, -1.5 * kCell, 0.12),
                1e-12)
        << "and the terrace is not drained by the view down";
}

TEST(SurfaceHeight, AGrainCountsForTheSpanThatHoldsItsCentre)
{
    // A shelf 0.1 m above the ground, 0.01 m thick.
    ColumnGrid columns(
        kCell,
        [](double, double, Intervals& out) {
            out.push_back({0.0, 0.1});
            out.push_back({0.11, 1e30});
        },
        {});
    const double middle = 0.5 * kCell;
    const std::vector<AccumulatedGrain> grains{{Vec3(middle, middle, kRadius), kRadius},
                                               {Vec3(middle, middle, 0.098), kRadius}};
    measureSurfaceHeight(grains, kDiameter, 0.0, columns);
    const auto below = columns.spansOf(0, 0).first;
    // The second grain presses into the shelf; its cap is cut at the shelf's lower side.
    EXPECT_NEAR(columns.H[below], 4.0 * 0.1 / 36.0, 1e-15);
    EXPECT_DOUBLE_EQ(columns.H[below + 1], 0.11);
}

TEST(SurfaceHeight, ColumnsWithoutAFloorStayEmpty)
{
    ColumnGrid columns(
        kCell,
        [](double x, double, Intervals& out) { out.push_back({x < 0.0 ? 0.0 : -1e30, 1e30}); }, {});
    const std::vector<AccumulatedGrain> grains{{Vec3(-0.001, 0.5 * kCell, kRadius), kRadius}};
    measureSurfaceHeight(grains, kDiameter, 0.3, columns);
    EXPECT_GT(heightOver(columns, -0.5 * kCell, 0.5 * kCell), 0.0);
    EXPECT_EQ(columns.H[columns.spansOf(0, 0).first], -1e30);
}

TEST(SurfaceHeight, GrainsThatAreGoneLeaveNoTrace)
{
    ColumnGrid columns = makeGround();
    SurfaceHeightMeter meter;
    meter.measure(scatterGrains(5000, 0.3, 0.1), kDiameter, 0.3, columns);
    EXPECT_GT(volumeUnderSurface(columns), 0.0);
    meter.measure({}, kDiameter, 0.3, columns);
    EXPECT_EQ(volumeUnderSurface(columns), 0.0);
}

TEST(SurfaceHeight, MakesAMarginAroundEveryGrain)
{
    ColumnGrid columns = makeGround();
    const std::vector<AccumulatedGrain> grains{{Vec3(0.5 * kCell, 5.5 * kCell, kRadius), kRadius}};
    measureSurfaceHeight(grains, kDiameter, 0.3, columns);
    const auto span = columns.spansOf(0, 5).first;
    ASSERT_NE(span, ColumnGrid::kNone);
    for (const std::int32_t other : columns.link[span]) {
        EXPECT_NE(other, ColumnGrid::kNone);
    }
}

TEST(SurfaceHeight, OrderOfGrainsAndThreadsDoNotMatter)
{
    std::vector<AccumulatedGrain> grains = scatterGrains(20000, 0.8, 0.15);
    const int threads = omp_get_max_threads();
    ColumnGrid first = makeGround();
    omp_set_num_threads(1);
    measureSurfaceHeight(grains, kDiameter, 0.3, first);
    std::shuffle(grains.begin(), grains.end(), std::mt19937(3));
    ColumnGrid second = makeGround();
    omp_set_num_threads(4);
    measureSurfaceHeight(grains, kDiameter, 0.3, second);
    omp_set_num_threads(threads);
    EXPECT_EQ(first.columnI, second.columnI);
    EXPECT_EQ(first.columnJ, second.columnJ);
    EXPECT_EQ(first.H, second.H);
    EXPECT_GT(*std::max_element(first.H.begin(), first.H.end()), 0.05);
}

TEST(SurfaceHeight, RefusesGrainsThatAreNowhere)
{
    ColumnGrid columns = makeGround();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<AccumulatedGrain> lost{{Vec3(0.0, nan, 0.0), kRadius}};
    EXPECT_THROW(measureSurfaceHeight(lost, kDiameter, 0.0, columns), PhysicsError);
    const std::vector<AccumulatedGrain> far{{Vec3(1e12, 0.0, 0.0), kRadius}};
    EXPECT_THROW(measureSurfaceHeight(far, kDiameter, 0.0, columns), PhysicsError);
}

}  // namespace
}  // namespace sandflow
