#include "bcre/evolve.h"
#include "mesh/shapes.h"
#include "mesh_spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace sandflow::testing {
namespace {

constexpr double kCell = 3.0 * kGrainDiameter;
constexpr double kTop = 0.4;         ///< m, height of the table
constexpr double kHalf = 0.3;        ///< m, half the width of the square that carries the roof
constexpr double kSource = 0.001;    ///< m/s, of sand falling on all of it
constexpr double kDuration = 250.0;  ///< s; the volume of the roof has fallen after 73

BcreParams makeParams()
{
    BcreParams params;  // repose angle, exchange rate and speed as scenes have them
    params.transport = true;
    return params;
}

/// A table of the given half width, m, in the void: columns beside it have no floor.
ColumnGrid makeTableField(const Vec2& middle, double halfWidth)
{
    const Vec3 below(middle.x(), middle.y(), kTop - 0.05);
    const Vec3 above(middle.x(), middle.y(), kTop);
    const Vec3 reach(halfWidth, halfWidth, 0.0);
    return makeMeshField(kCell, 0.47, makeBoxMesh(below - reach, above + reach), std::nullopt);
}

void pourOnTable(ColumnGrid& columns)
{
    const BcreParams params = makeParams();
    const double dt = 0.02;
    const int steps = static_cast<int>(kDuration / dt);
    for (int step = 0; step < steps; ++step) {
        for (std::size_t s = 0; s < columns.spanCount(); ++s) {
            columns.R[s] += columns.floor[s] == kTop ? kSource * dt : 0.0;
        }
        evolveBcre(params, dt, columns);
    }
}

struct RoofErrors {
    double bed = 0.0;    ///< m, mean of |h - roof|
    double worst = 0.0;  ///< m
    double flow = 0.0;   ///< m, mean of |R - exact| away from the ridges and the rim
};

/// Against the distance-function roof of Hadeler and Kuttler (1999) over a square of half width a:
/// u = tan(theta0) (a - max(|x|, |y|)), v = f ||x| - |y|| / v_d.
RoofErrors compareWithRoof(const ColumnGrid& columns, const Vec2& middle, double a)
{
    const BcreParams params = makeParams();
    RoofErrors errors;
    int count = 0;
    int flowCount = 0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const Vec2 offset = (centreOf(columns, s) - middle).cwiseAbs();
        if (columns.floor[s] != kTop) {
            continue;
        }
        const double roof = kTop + std::tan(params.reposeAngle) * (a - offset.maxCoeff());
        const double error = std::abs(columns.h[s] - roof);
        errors.bed += error;
        errors.worst = std::max(errors.worst, error);
        ++count;
        const double across = std::abs(offset.x() - offset.y());
        if (across > 2.5 * kCell && offset.maxCoeff() < a - 0.5 * kCell) {
            errors.flow += std::abs(columns.R[s] - kSource * across / params.transportSpeed);
            ++flowCount;
        }
    }
    errors.bed /= count;
    errors.flow /= flowCount;
    return errors;
}

void expectSmall(const RoofErrors& errors)
{
    const BcreParams params = makeParams();
    EXPECT_LT(errors.bed, 0.1 * kGrainDiameter);
    // Columns on the ridges see a drop along both axes and stay lower than the roof.
    EXPECT_LT(errors.worst, kCell * std::tan(params.reposeAngle));
    EXPECT_LT(errors.flow, 0.1 * kSource * kHalf / params.transportSpeed);
    ::testing::Test::RecordProperty("mean_bed_error_mm", std::to_string(1000.0 * errors.bed));
    ::testing::Test::RecordProperty("worst_bed_error_mm", std::to_string(1000.0 * errors.worst));
    ::testing::Test::RecordProperty("mean_flow_error_mm", std::to_string(1000.0 * errors.flow));
}

/// The rim is a ring of columns of its own, open: their centres are the edge of the roof.
TEST(TableHeap, EndsAsTheRoofOverItsOpenRim)
{
    const Vec2 middle(0.5 * kCell, 0.5 * kCell);  // the centre of column (0, 0)
    ColumnGrid columns = makeTableField(middle, kHalf + 0.5 * kCell);
    int rims = 0;
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const int ring = std::max(std::abs(columns.columnI[s]), std::abs(columns.columnJ[s]));
        if (columns.floor[s] == kTop && ring == 10) {
            columns.sink[s] = 1;
            ++rims;
        }
    }
    ASSERT_EQ(rims, 80);
    pourOnTable(columns);
    const RoofErrors errors = compareWithRoof(columns, middle, kHalf);
    expectSmall(errors);
}

/// Nothing is marked; what goes over the edge falls. The outermost columns of the table see a drop
/// and stay bare, so the roof begins at their centres: half a column, which is up to 11 mm of
/// height, within the outline of the table.
TEST(TableHeap, InTheVoidEndsAsTheRoofOverItsOutermostColumns)
{
    ColumnGrid columns = makeTableField(Vec2::Zero(), kHalf);
    pourOnTable(columns);
    const RoofErrors errors = compareWithRoof(columns, Vec2::Zero(), kHalf - 0.5 * kCell);
    expectSmall(errors);
    const RoofErrors toOutline = compareWithRoof(columns, Vec2::Zero(), kHalf);
    EXPECT_NEAR(toOutline.bed, 0.5 * kCell * std::tan(makeParams().reposeAngle),
                0.1 * kGrainDiameter);
}

}  // namespace
}  // namespace sandflow::testing
