#include "bcre/evolve.h"

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

using testing::at;
using testing::fill;
using testing::makeBox;
using testing::makeFlatBox;
using testing::totalDepth;

constexpr double kCell = 0.03;

BcreParams makeFreeParams()
{
    BcreParams params;
    params.maxChange = 1e9;
    return params;
}

/// Bumpy sand, deep enough to erode, with patches of bare floor and of no flow.
void fillAtRandom(ColumnGrid& columns, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        columns.h[s] = columns.floor[s] + std::max(0.0, 0.15 * uniform(random) - 0.03);
        columns.R[s] = std::max(0.0, 0.05 * uniform(random) - 0.01);
        columns.H[s] = columns.h[s] + columns.R[s];
    }
}

TEST(Exchange, KeepsTheSumOfBothLayersInEverySpan)
{
    ColumnGrid columns = makeFlatBox(40, 30, kCell);
    fillAtRandom(columns, 1);
    const std::vector<double> H = columns.H;
    const std::vector<double> before = columns.h;
    double eroded = 0.0;
    for (int step = 0; step < 20; ++step) {
        const BcreReport report = evolveBcre(makeFreeParams(), 0.02, columns);
        eroded += report.erodedVolume - report.depositedVolume;
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            ASSERT_NEAR(columns.h[s] + columns.R[s], H[s], 1e-15);
            ASSERT_GE(columns.h[s], columns.floor[s]);
            ASSERT_GE(columns.R[s], 0.0);
        }
    }
    EXPECT_EQ(columns.H, H);
    double lost = 0.0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        lost += (before[s] - columns.h[s]) * kCell * kCell;
    }
    EXPECT_NEAR(eroded, lost, 1e-14);
}

TEST(Exchange, ReportsTheChangeOfTheBedWithinItsLimit)
{
    ColumnGrid columns = makeFlatBox(20, 20, kCell);
    fillAtRandom(columns, 2);
    const std::vector<double> before = columns.h;
    BcreParams params;
    params.maxChange = 0.002;
    const BcreReport report = evolveBcre(params, 0.05, columns);
    EXPECT_GT(report.substeps, 1);
    double largest = 0.0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        ASSERT_NEAR(columns.dh[s], columns.h[s] - before[s], 1e-15);
        largest = std::max(largest, std::abs(columns.dh[s]));
    }
    EXPECT_NEAR(largest, params.maxChange, 1e-12) << "this bed must have met the limit";
}

/// Error of R against R0 exp(gamma delta t) after 0.05 s with the given number of steps, on a ramp
/// whose uphill cells all see the same slope.
double exponentialError(double delta, int steps)
{
    constexpr int count = 64;
    constexpr double flow = 1e-4;
    constexpr double duration = 0.05;
    BcreParams params = makeFreeParams();
    params.slopeForm = SlopeForm::tangent;
    const double slope = std::tan(params.reposeAngle) + delta;
    ColumnGrid columns = makeFlatBox(count, 1, kCell);
    fill(columns, [&](double x, double) { return 1.0 + slope * x; },
         [&](double, double) { return flow; });
    // Cell 0 has no lower neighbour; kept going so that the others see a ramp of uniform slope.
    for (int step = 0; step < steps; ++step) {
        const double fall = columns.h[at(columns, 2)] - columns.h[at(columns, 1)];
        columns.h[at(columns, 0)] = columns.h[at(columns, 1)] - fall;
        EXPECT_EQ(evolveBcre(params, duration / steps, columns).substeps, 1);
    }
    const double exact = flow * std::exp(params.exchangeRate * delta * duration);
    const std::size_t span = at(columns, count - 1);
    EXPECT_NEAR(columns.R[span] - flow, 1.0 + slope * (count - 0.5) * kCell - columns.h[span],
                1e-13);
    return std::abs(columns.R[span] / exact - 1.0);
}

TEST(Exchange, UniformExcessGrowsExponentiallyWithFirstOrder)
{
    for (const double delta : {0.2, -0.2}) {
        const double coarse = exponentialError(delta, 40);
        const double fine = exponentialError(delta, 80);
        EXPECT_LT(fine, 0.01);
        EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.1);
    }
}

TEST(Exchange, BothFormsOfTheSlopeLawRestAtTheReposeAngle)
{
    for (const SlopeForm form : {SlopeForm::angle, SlopeForm::tangent}) {
        BcreParams params = makeFreeParams();
        params.slopeForm = form;
        const double dt = 1e-4;
        for (const double angle : {params.reposeAngle + 0.1, params.reposeAngle - 0.1}) {
            ColumnGrid columns = makeFlatBox(4, 1, kCell);
            fill(columns, [&](double x, double) { return 1.0 + std::tan(angle) * x; },
                 [](double, double) { return 0.01; });
            evolveBcre(params, dt, columns);
            const double excess = form == SlopeForm::angle
                                      ? angle - params.reposeAngle
                                      : std::tan(angle) - std::tan(params.reposeAngle);
            EXPECT_NEAR(columns.dh[at(columns, 2)], -params.exchangeRate * 0.01 * excess * dt,
                        1e-12);
        }
    }
}

TEST(Exchange, ASlopeTooSteepRelaxesToTheReposeAngle)
{
    // A bank of 50 degrees on a floor; the flowing layer is renewed as running grains would.
    for (const bool diagonal : {false, true}) {
        constexpr int count = 40;
        ColumnGrid columns = makeFlatBox(count, diagonal ? count : 1, kCell);
        const double steep = std::tan(50.0 * kPi / 180.0);
        fill(columns,
             [&](double x, double y) {
                 return steep * (diagonal ? (x + y) / std::sqrt(2.0) : x);
             },
             [](double, double) { return 0.0; });
        const std::size_t foot = at(columns, 0);
        columns.h[foot] = 0.0;
        const BcreParams params = makeFreeParams();
        for (int step = 0; step < 200; ++step) {
            std::fill(columns.R.begin(), columns.R.end(), 0.02);
            columns.R[foot] = 0.0;
            evolveBcre(params, 0.02, columns);
        }
        std::vector<double> theta;
        upwindSlope(columns, theta);
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            if (s != foot) {
                ASSERT_NEAR(theta[s] * 180.0 / kPi, 36.0, 0.5);
            }
        }
        EXPECT_LT(columns.h[at(columns, count - 1)], 0.7 * steep * count * kCell);
    }
}

TEST(Exchange, NeverTakesMoreThanIsThere)
{
    ColumnGrid columns = makeBox(32, 32, kCell, [](double x, double y) {
        return 0.3 * std::sin(20.0 * x) + 0.2 * std::cos(17.0 * y);
    });
    fillAtRandom(columns, 3);
    BcreParams params = makeFreeParams();
    for (const bool transport : {false, true}) {
        params.transport = transport;
        for (int step = 0; step < 40; ++step) {
            evolveBcre(params, 0.1, columns);
            for (std::size_t s = 0; s < columns.spanCount(); ++s) {
                ASSERT_GE(columns.R[s], 0.0);
                ASSERT_GE(columns.h[s], columns.floor[s]);
            }
        }
    }
}

TEST(Exchange, ManySubstepsWhereTheLayerIsDeep)
{
    ColumnGrid columns = makeFlatBox(8, 1, kCell);
    fill(columns, [](double x, double) { return x; }, [](double, double) { return 0.3; });
    BcreParams params;
    const BcreReport report = evolveBcre(params, 0.02, columns);
    // gamma R dt / dx = 100 * 0.3 * 0.02 / 0.03 = 20 at the least, and 0.45 is allowed.
    EXPECT_GE(report.substeps, 45);
    EXPECT_LE(report.substeps, 50);
    columns.R[0] = 1e12;
    EXPECT_THROW(evolveBcre(params, 0.02, columns), PhysicsError);
    columns.R[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(evolveBcre(params, 0.02, columns), PhysicsError);
}

TEST(Exchange, NothingHappensInNoTimeOrOnNoColumns)
{
    ColumnGrid columns = makeFlatBox(8, 8, kCell);
    fillAtRandom(columns, 4);
    const std::vector<double> before = columns.h;
    EXPECT_EQ(evolveBcre(makeFreeParams(), 0.0, columns).substeps, 0);
    EXPECT_EQ(columns.h, before);
    ColumnGrid none(kCell, [](double, double, std::vector<ColumnGrid::FreeInterval>&) {}, {});
    EXPECT_EQ(evolveBcre(makeFreeParams(), 0.02, none).substeps, 0);
}

TEST(Exchange, SameBitsForAnyNumberOfThreads)
{
    const int threads = omp_get_max_threads();
    BcreParams params;
    params.transport = true;
    std::vector<double> h[2], R[2];
    BcreReport report[2];
    for (const int k : {0, 1}) {
        omp_set_num_threads(k == 0 ? 1 : 4);
        ColumnGrid columns = makeFlatBox(96, 80, kCell);
        ASSERT_GT(columns.spanCount(), 4096u) << "must be enough to run in parallel";
        fillAtRandom(columns, 5);
        for (int step = 0; step < 10; ++step) {
            report[k] = evolveBcre(params, 0.02, columns);
        }
        h[k] = columns.h;
        R[k] = columns.R;
    }
    omp_set_num_threads(threads);
    EXPECT_EQ(h[0], h[1]);
    EXPECT_EQ(R[0], R[1]);
    EXPECT_EQ(report[0].erodedVolume, report[1].erodedVolume);
    EXPECT_EQ(report[0].depositedVolume, report[1].depositedVolume);
    EXPECT_GT(report[0].erodedVolume, 0.0);
}

TEST(UpwindSlope, SeesTheLowerNeighbourAndIsTheSameInAllDirections)
{
    const double slope = std::tan(0.6);
    ColumnGrid columns = makeFlatBox(40, 40, kCell);
    const double middle = 20.5 * kCell;
    fill(columns,
         [&](double x, double y) { return 2.0 - slope * std::hypot(x - middle, y - middle); },
         [](double, double) { return 0.0; });
    std::vector<double> theta;
    upwindSlope(columns, theta);
    EXPECT_NEAR(theta[at(columns, 30, 20)], 0.6, 0.02);
    EXPECT_NEAR(theta[at(columns, 28, 28)], 0.6, 0.02);
    EXPECT_NEAR(theta[at(columns, 20, 8)], 0.6, 0.02);
    // A pit is flat: nothing lies below it.
    columns.h[at(columns, 30, 20)] = -1.0;
    upwindSlope(columns, theta);
    EXPECT_EQ(theta[at(columns, 30, 20)], 0.0);
}

TEST(FlowDepth, FollowsTheSurface)
{
    ColumnGrid columns = makeFlatBox(3, 1, kCell);
    const double surface[3] = {0.5, 0.2, 0.0};
    for (int i = 0; i < 3; ++i) {
        columns.h[at(columns, i)] = 0.3;
        columns.H[at(columns, i)] = surface[i];
    }
    followSurface(columns);
    EXPECT_DOUBLE_EQ(columns.h[at(columns, 0)], 0.3);
    EXPECT_DOUBLE_EQ(columns.R[at(columns, 0)], 0.2);
    EXPECT_DOUBLE_EQ(columns.h[at(columns, 1)], 0.2);
    EXPECT_DOUBLE_EQ(columns.R[at(columns, 1)], 0.0);
    EXPECT_DOUBLE_EQ(columns.h[at(columns, 2)], 0.0);
    EXPECT_DOUBLE_EQ(columns.R[at(columns, 2)], 0.0);
}

TEST(FlowDepth, IsNeverLessThanItsMinimumWhereTheSandIsThatDeep)
{
    ColumnGrid columns = makeBox(3, 1, kCell, [](double, double) { return 0.1; });
    BcreParams params;
    params.minFlowDepth = 0.02;
    const double surface[3] = {0.5, 0.5, 0.11};
    const double bed[3] = {0.3, 0.49, 0.105};
    for (int i = 0; i < 3; ++i) {
        columns.H[at(columns, i)] = surface[i];
        columns.h[at(columns, i)] = bed[i];
    }
    followSurface(columns);
    enforceMinFlowDepth(params, columns);
    EXPECT_DOUBLE_EQ(columns.R[at(columns, 0)], 0.2) << "deeper already";
    EXPECT_DOUBLE_EQ(columns.R[at(columns, 1)], 0.02);
    EXPECT_DOUBLE_EQ(columns.h[at(columns, 1)], 0.48);
    EXPECT_NEAR(columns.R[at(columns, 2)], 0.01, 1e-15) << "the foot is mobile down to the floor";
    EXPECT_DOUBLE_EQ(columns.h[at(columns, 2)], 0.1);
}

}  // namespace
}  // namespace sandflow
