#include "core/hash.h"
#include "mesh/flat_piece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sandflow {
namespace {

double areaOf(const FlatPiece& piece)
{
    Vec3 doubled = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < piece.count(); ++k) {
        doubled += (piece.corner(k) - piece.corner(0)).cross(piece.corner(k + 1) - piece.corner(0));
    }
    return 0.5 * doubled.norm();
}

Vec3 drawPoint(std::uint64_t key)
{
    Vec3 point;
    for (double& component : point) {
        key = extendHash(key, 1);
        component = unitFromBits(key);
    }
    return point;
}

TEST(FlatPiece, SidesAreTheLongestEdgeAndItsPerpendicular)
{
    for (std::uint64_t k = 0; k < 1000; ++k) {
        const Vec3 a = drawPoint(3 * k);
        const Vec3 b = drawPoint(3 * k + 1);
        const Vec3 c = drawPoint(3 * k + 2);
        const auto [along, across] = sidesOf(a, b, c);
        EXPECT_NEAR(along.norm(), 1.0, 1e-12);
        EXPECT_NEAR(across.norm(), 1.0, 1e-12);
        EXPECT_NEAR(along.dot(across), 0.0, 1e-8);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const FlatPiece piece(a, b, c);
        EXPECT_NEAR(piece.extentAlong(along).size(), longest, 1e-12);
        EXPECT_NEAR(piece.extentAlong(across).size(), 2.0 * areaOf(piece) / longest, 1e-12);
    }
}

TEST(FlatPiece, SidesOfLinesAndPoints)
{
    const auto [along, across] = sidesOf(Vec3::Zero(), Vec3::UnitX(), 3.0 * Vec3::UnitX());
    EXPECT_EQ(along.cwiseAbs(), Vec3(Vec3::UnitX()));
    EXPECT_EQ(across, Vec3(Vec3::Zero()));
    EXPECT_EQ(sidesOf(Vec3::Ones(), Vec3::Ones(), Vec3::Ones()).first, Vec3(Vec3::Zero()));
}

/// Cut after cut across the longer side, the parts make up the whole and each lies on its side.
TEST(FlatPiece, PartsMakeUpTheWhole)
{
    std::size_t mostCorners = 0;
    for (std::uint64_t k = 0; k < 300; ++k) {
        const Vec3 a = drawPoint(3 * k);
        const Vec3 b = drawPoint(3 * k + 1);
        // From round to needle-like.
        const Vec3 c = a + std::pow(0.5, static_cast<double>(k % 30)) * (drawPoint(3 * k + 2) - a);
        const auto [along, across] = sidesOf(a, b, c);
        std::vector<FlatPiece> pieces = {FlatPiece(a, b, c)};
        const double whole = areaOf(pieces[0]);
        for (int round = 0; round < 8; ++round) {
            std::vector<FlatPiece> parts;
            double sum = 0.0;
            for (const FlatPiece& piece : pieces) {
                const bool isLong =
                    piece.extentAlong(along).size() >= piece.extentAlong(across).size();
                const Vec3& side = isLong ? along : across;
                const Extent extent = piece.extentAlong(side);
                const auto [lower, upper] = piece.cutAt(side, extent.middle());
                EXPECT_NEAR(lower.extentAlong(side).from, extent.from, 1e-14);
                EXPECT_NEAR(lower.extentAlong(side).to, extent.middle(), 1e-14);
                EXPECT_NEAR(upper.extentAlong(side).from, extent.middle(), 1e-14);
                EXPECT_NEAR(upper.extentAlong(side).to, extent.to, 1e-14);
                parts.insert(parts.end(), {lower, upper});
                sum += areaOf(lower) + areaOf(upper);
                mostCorners = std::max({mostCorners, lower.count(), upper.count()});
            }
            pieces = std::move(parts);
            EXPECT_NEAR(sum, whole, 1e-12);
        }
    }
    EXPECT_LE(mostCorners, 7u);
}

}  // namespace
}  // namespace sandflow
