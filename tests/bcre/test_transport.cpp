#include "bcre/evolve.h"
#include "test_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandflow {
namespace {

using testing::at;
using testing::fill;
using testing::makeBox;
using testing::makeFlatBox;
using testing::totalDepth;

/// Tangent law, no limit on dh. The exact solutions themselves are in tests/verification.
BcreParams makeExactParams(double exchangeRate, double neutralSlope, double speed)
{
    BcreParams params;
    params.exchangeRate = exchangeRate;
    params.reposeAngle = std::atan(neutralSlope);
    params.slopeForm = SlopeForm::tangent;
    params.maxChange = 1e9;
    params.transport = true;
    params.transportSpeed = speed;
    return params;
}

TEST(Transport, KeepsAllSandInAClosedBox)
{
    ColumnGrid columns = makeBox(48, 40, 0.03, [](double x, double y) {
        return 0.2 * std::sin(9.0 * x) * std::cos(7.0 * y);
    });
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        columns.h[s] = columns.floor[s] + 0.1 * uniform(random);
        columns.R[s] = 0.05 * uniform(random);
    }
    BcreParams params;
    params.transport = true;
    params.maxChange = 1e9;
    const double before = totalDepth(columns);
    for (int step = 0; step < 100; ++step) {
        evolveBcre(params, 0.02, columns);
    }
    EXPECT_NEAR(totalDepth(columns), before, 1e-12 * before);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        ASSERT_EQ(columns.H[s], columns.h[s] + columns.R[s]);
    }
}

TEST(Transport, NothingEntersASpanFullToItsCeiling)
{
    ColumnGrid columns(
        0.03,
        [](double x, double, std::vector<ColumnGrid::FreeInterval>& out) {
            out.push_back({0.0, x < 0.24 ? 0.05 : 1e30});
        },
        {});
    columns.ensureColumn(0, 0);
    BcreParams params;
    params.transport = true;
    params.exchangeRate = 0.0;
    fill(columns, [](double x, double) { return x < 0.24 ? 0.04 : 0.2; },
         [](double x, double) { return x < 0.24 ? 0.01 : 0.03; });
    const std::vector<double> before = columns.R;
    evolveBcre(params, 0.1, columns);
    EXPECT_EQ(columns.R, before);
}

TEST(Transport, RollsDownASlopeAtItsSpeed)
{
    // A hump of flowing sand on a neutral slope: its centre moves at v_d, downhill.
    const BcreParams params = makeExactParams(1.0, 0.7, 0.3);
    ColumnGrid columns = makeFlatBox(200, 1, 0.01);
    fill(columns, [](double x, double) { return 0.7 * x; },
         [](double x, double) { return std::abs(x - 1.5) < 0.1 ? 1e-6 : 0.0; });
    const auto centre = [&] {
        double sum = 0.0;
        double moment = 0.0;
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            sum += columns.R[s];
            moment += columns.R[s] * (columns.columnI[s] + 0.5) * 0.01;
        }
        return moment / sum;
    };
    const double before = centre();
    for (int step = 0; step < 100; ++step) {
        evolveBcre(params, 0.02, columns);
    }
    EXPECT_NEAR(before - centre(), 0.3 * 2.0, 1e-3);
}

TEST(Transport, AHeapFedAtItsCentreIsRound)
{
    constexpr int count = 63;
    constexpr double cell = 0.03;
    BcreParams params;
    params.exchangeRate = 30.0;
    params.transport = true;
    params.maxChange = 1e9;
    ColumnGrid columns = makeFlatBox(count, count, cell);
    const int middle = count / 2;
    // A jet 0.3 m wide, for 40 s.
    const double dt = 0.02;
    const double poured = 0.2;   // m3
    const int steps = 2000;
    std::vector<std::size_t> jet;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        if (std::hypot(columns.columnI[s] - middle, columns.columnJ[s] - middle) * cell < 0.15) {
            jet.push_back(s);
        }
    }
    for (int step = 0; step < steps; ++step) {
        for (const std::size_t s : jet) {
            columns.R[s] += poured / steps / (cell * cell * static_cast<double>(jet.size()));
        }
        evolveBcre(params, dt, columns);
    }
    EXPECT_NEAR(totalDepth(columns) * cell * cell, poured, 1e-12);

    // Where the surface falls below one tenth of the apex, along a ray from the centre.
    const double apex = columns.h[at(columns, middle, middle)];
    const auto footAlong = [&](int stepI, int stepJ) {
        for (int k = 1; k <= middle; ++k) {
            const double inner = columns.h[at(columns, middle + stepI * (k - 1),
                                              middle + stepJ * (k - 1))];
            const double outer = columns.h[at(columns, middle + stepI * k, middle + stepJ * k)];
            if (outer < 0.1 * apex) {
                const double share = (inner - 0.1 * apex) / (inner - outer);
                return (k - 1 + share) * cell * std::hypot(stepI, stepJ);
            }
        }
        return 1e30;
    };
    const double east = footAlong(1, 0);
    const double northEast = footAlong(1, 1);
    EXPECT_GT(east, 15 * cell) << "too small a heap to tell";
    EXPECT_LT(east, 28 * cell) << "the box must not hold it";
    EXPECT_NEAR(northEast, east, cell);
    EXPECT_NEAR(footAlong(-1, 0), east, 1e-9);
    EXPECT_NEAR(footAlong(0, 1), east, 1e-9);
    EXPECT_NEAR(footAlong(-1, 1), northEast, 1e-9);

    // The flank stands near the repose angle, a little below while sand is being laid down.
    const double rise = columns.h[at(columns, middle + 6, middle)] -
                        columns.h[at(columns, middle + 14, middle)];
    const double angle = std::atan(rise / (8 * cell));
    EXPECT_LT(angle, params.reposeAngle);
    EXPECT_GT(angle, params.reposeAngle - 0.1);
}

}  // namespace
}  // namespace sandflow
