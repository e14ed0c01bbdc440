#include "core/errors.h"
#include "grains/sorted_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <omp.h>
#include <random>
#include <tuple>
#include <vector>

namespace sandflow {
namespace {

constexpr double kCellSize = 0.015;
using CellTuple = std::tuple<std::int32_t, std::int32_t, std::int32_t>;  // k, j, i

/// Clusters of points: about the origin on both sides of zero, and 5 km out in three corners.
std::vector<Vec3> makeClusters(std::size_t count, double halfWidth)
{
    const Vec3 centres[] = {Vec3::Zero(), Vec3(5000.0, -5000.0, 3.0),
                            Vec3(-5000.0, 5000.0, -5000.0), Vec3(-5000.0, -5000.0, 5000.0)};
    std::mt19937 random(11);
    std::uniform_real_distribution<double> offset(-halfWidth, halfWidth);
    std::vector<Vec3> points;
    for (std::size_t n = 0; n < count; ++n) {
        const double x = offset(random), y = offset(random), z = offset(random);
        points.push_back(centres[n % 4] + Vec3(x, y, z));
    }
    return points;
}

/// Points of each cell in the order of the input, by std::map and std::floor.
std::map<CellTuple, std::vector<std::uint32_t>> sortBruteForce(const std::vector<Vec3>& points)
{
    std::map<CellTuple, std::vector<std::uint32_t>> cells;
    const auto index = [](double x) {
        return static_cast<std::int32_t>(std::floor(x * (1.0 / kCellSize)));
    };
    for (std::uint32_t n = 0; n < points.size(); ++n) {
        const Vec3& p = points[n];
        cells[{index(p.z()), index(p.y()), index(p.x())}].push_back(n);
    }
    return cells;
}

/// Bits of the three indices, counted from -0x155555 and wrapped at the range of a key, interleaved
/// one by one.
std::uint64_t mortonByBits(const CellIndex& cell)
{
    const std::int64_t index[] = {cell.i, cell.j, cell.k};
    std::uint64_t key = 0;
    for (int bit = 0; bit < kCellIndexBits; ++bit) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto u = static_cast<std::uint64_t>(index[axis] + 0x155555);
            key |= ((u >> bit) & 1u) << (3 * bit + axis);
        }
    }
    return key;
}

TEST(SortedCells, EveryPointIsInItsCellInTheOrderOfTheInput)
{
    const std::vector<Vec3> points = makeClusters(6000, 0.08);
    const auto expected = sortBruteForce(points);
    SortedCells cells(kCellSize);
    cells.build(points);
    ASSERT_EQ(cells.order().size(), points.size());
    ASSERT_EQ(cells.cells().size(), expected.size());
    std::uint32_t next = 0;
    for (const SortedCells::Cell& cell : cells.cells()) {
        EXPECT_EQ(cell.begin, next) << "cells leave no entry out";
        next = cell.end;
        const auto at = expected.find({cell.index.k, cell.index.j, cell.index.i});
        ASSERT_NE(at, expected.end());
        const auto order = cells.order().subspan(cell.begin, cell.end - cell.begin);
        EXPECT_EQ(std::vector<std::uint32_t>(order.begin(), order.end()), at->second);
    }
    EXPECT_EQ(next, points.size());
}

TEST(SortedCells, CellsAreInMortonOrder)
{
    SortedCells cells(kCellSize);
    cells.build(makeClusters(6000, 0.08));
    for (std::size_t c = 1; c < cells.cells().size(); ++c) {
        EXPECT_LT(mortonByBits(cells.cells()[c - 1].index), mortonByBits(cells.cells()[c].index));
    }
}

TEST(SortedCells, FindKnowsEveryCellAndNoOther)
{
    const std::vector<Vec3> points = makeClusters(2000, 0.1);
    const auto expected = sortBruteForce(points);
    SortedCells cells(kCellSize);
    cells.build(points);
    std::size_t empty = 0;
    for (const auto& [at, members] : expected) {
        const auto [k, j, i] = at;
        for (std::int32_t di = -1; di <= 1; ++di) {
            const SortedCells::Cell* found = cells.find(i + di, j, k);
            const auto there = expected.find({k, j, i + di});
            ASSERT_EQ(found != nullptr, there != expected.end());
            if (!found) {
                ++empty;
                continue;
            }
            EXPECT_EQ(found->index, (CellIndex{i + di, j, k}));
            EXPECT_EQ(found->end - found->begin, there->second.size());
        }
        EXPECT_EQ(cells.find(i, j, k + 50), nullptr);
    }
    EXPECT_GT(empty, 100u) << "the cloud must have holes for this to test anything";
}

TEST(SortedCells, VisitsExactlyTheCellsNearbyInOrder)
{
    const std::vector<Vec3> points = makeClusters(3000, 0.1);
    const auto expected = sortBruteForce(points);
    SortedCells cells(kCellSize);
    cells.build(points);
    for (std::size_t n = 0; n < points.size(); n += 29) {
        for (const std::int32_t radius : {0, 1, 2, 5}) {
            const CellIndex at = cells.cellOf(points[n]);
            std::vector<CellTuple> near, visited;
            for (const auto& [cell, members] : expected) {  // ascending in k, j, i
                const auto [k, j, i] = cell;
                if (std::abs(k - at.k) <= radius && std::abs(j - at.j) <= radius &&
                    std::abs(i - at.i) <= radius) {
                    near.push_back(cell);
                }
            }
            cells.visitNear(at, radius, [&](const SortedCells::Cell& cell) {
                visited.emplace_back(cell.index.k, cell.index.j, cell.index.i);
            });
            ASSERT_EQ(visited, near) << "point " << n << ", radius " << radius;
        }
    }
}

TEST(SortedCells, FindsEveryPointWithinACellSize)
{
    const std::vector<Vec3> points = makeClusters(2000, 0.05);
    SortedCells cells(kCellSize);
    cells.build(points);
    std::size_t pairs = 0;
    for (std::uint32_t a = 0; a < points.size(); a += 7) {
        std::vector<std::uint32_t> near, found;
        for (std::uint32_t b = 0; b < points.size(); ++b) {
            if ((points[a] - points[b]).norm() < kCellSize) {
                near.push_back(b);
            }
        }
        cells.visitNear(cells.cellOf(points[a]), 1, [&](const SortedCells::Cell& cell) {
            for (std::uint32_t e = cell.begin; e < cell.end; ++e) {
                if ((points[a] - points[cells.order()[e]]).norm() < kCellSize) {
                    found.push_back(cells.order()[e]);
                }
            }
        });
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, near);
        pairs += near.size() - 1;
    }
    EXPECT_GT(pairs, 500u);
}

TEST(SortedCells, TheNumberOfThreadsDoesNotMatter)
{
    const std::vector<Vec3> points = makeClusters(20000, 0.3);
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    SortedCells one(kCellSize);
    one.build(points);
    for (const int threads : {2, 3, 4}) {
        omp_set_num_threads(threads);
        SortedCells many(kCellSize);
        many.build(points);
        EXPECT_TRUE(std::equal(one.order().begin(), one.order().end(), many.order().begin(),
                               many.order().end()));
        ASSERT_EQ(one.cells().size(), many.cells().size());
        for (std::size_t c = 0; c < one.cells().size(); ++c) {
            EXPECT_EQ(one.cells()[c].index, many.cells()[c].index);
            EXPECT_EQ(one.cells()[c].end, many.cells()[c].end);
        }
    }
    omp_set_num_threads(before);
}

TEST(SortedCells, BuildingAgainForgetsWhatWasThere)
{
    SortedCells cells(kCellSize);
    cells.build(makeClusters(500, 0.1));
    const std::vector<Vec3> single = {Vec3(1.0, 2.0, 3.0)};
    cells.build(single);
    ASSERT_EQ(cells.cells().size(), 1u);
    EXPECT_EQ(cells.find(0, 0, 0), nullptr);
    const CellIndex at = cells.cellOf(single[0]);
    EXPECT_NE(cells.find(at.i, at.j, at.k), nullptr);

    cells.build({});
    EXPECT_TRUE(cells.cells().empty());
    cells.visitNear(at, 3, [](const SortedCells::Cell&) { ADD_FAILURE() << "nothing is there"; });
    EXPECT_EQ(cells.find(at.i, at.j, at.k), nullptr);
}

TEST(SortedCells, RefusesPointsThatHaveNoCell)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    SortedCells cells(kCellSize);
    for (const Vec3& p : {Vec3(0, nan, 0), Vec3(0, 0, -infinity), Vec3(1e5, 0, 0)}) {
        const std::vector<Vec3> points = {Vec3::Zero(), p};
        EXPECT_THROW(cells.build(points), InternalError);
    }
}

}  // namespace
}  // namespace sandflow
