#include "core/cell_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace sandflow {
namespace {

TEST(CellKey, RoundTripsTheWholeRange)
{
    const std::int32_t values[] = {-kCellIndexLimit,   -kCellIndexLimit + 1, -1000, -1, 0, 1, 77,
                                   kCellIndexLimit - 1};
    std::set<std::uint64_t> keys;
    for (const std::int32_t i : values) {
        for (const std::int32_t j : values) {
            for (const std::int32_t k : values) {
                const std::uint64_t key = packCellKey(i, j, k);
                EXPECT_EQ(unpackCellKey(key), (CellIndex{i, j, k}));
                EXPECT_TRUE(keys.insert(key).second) << "two cells share a key";
            }
        }
    }
}

TEST(CellKey, RefusesWhatCannotBeKeyed)
{
    EXPECT_THROW(packCellKey(kCellIndexLimit, 0, 0), InternalError);
    EXPECT_THROW(packCellKey(0, -kCellIndexLimit - 1, 0), InternalError);
    EXPECT_THROW(packCellKey(0, 0, std::numeric_limits<std::int32_t>::max()), InternalError);
    EXPECT_THROW(packCellKey(std::numeric_limits<std::int32_t>::min(), 0, 0), InternalError);
    EXPECT_THROW(cellCoordinate(std::numeric_limits<double>::quiet_NaN(), 1.0), InternalError);
    EXPECT_THROW(cellCoordinate(1e300, 1.0), InternalError);
    EXPECT_THROW(cellCoordinate(-1e8, 100.0), InternalError);
}

TEST(CellKey, CoordinateRoundsDownOnBothSidesOfZero)
{
    EXPECT_EQ(cellCoordinate(0.0, 10.0), 0);
    EXPECT_EQ(cellCoordinate(0.05, 10.0), 0);
    EXPECT_EQ(cellCoordinate(-0.05, 10.0), -1);
    EXPECT_EQ(cellCoordinate(-0.25, 10.0), -3);
    EXPECT_EQ(cellCoordinate(0.25, 10.0), 2);
}

// A change of one bit of the key must flip about half of the low 20 bits, which address the table.
TEST(CellKey, EveryBitReachesTheTableAddress)
{
    std::mt19937_64 random(7);
    for (int bit = 0; bit < 3 * kCellIndexBits; ++bit) {
        int flipped = 0;
        const int trials = 500;
        for (int t = 0; t < trials; ++t) {
            const std::uint64_t key = random() >> 1;
            const std::uint64_t difference =
                mixCellKey(key) ^ mixCellKey(key ^ (std::uint64_t{1} << bit));
            flipped += std::popcount(difference & 0xFFFFFu);
        }
        const double share = flipped / (20.0 * trials);
        EXPECT_GT(share, 0.40) << "key bit " << bit;
        EXPECT_LT(share, 0.60) << "key bit " << bit;
    }
}

// Neighbouring cells, the keys we really have, must spread like random ones: n keys thrown into m
// slots leave m exp(-n/m) of them empty.
TEST(CellKey, BlockOfCellsSpreadsLikeRandomKeys)
{
    const std::size_t slots = 1u << 17;
    std::vector<bool> hit(slots, false);
    const int edge = 40;
    for (int i = 0; i < edge; ++i) {
        for (int j = 0; j < edge; ++j) {
            for (int k = 0; k < edge; ++k) {
                hit[mixCellKey(packCellKey(i - 20, j - 20, k)) & (slots - 1)] = true;
            }
        }
    }
    const double n = edge * edge * edge;
    const double m = static_cast<double>(slots);
    const double empty = static_cast<double>(std::count(hit.begin(), hit.end(), false));
    EXPECT_NEAR(empty / m, std::exp(-n / m), 0.02);
}

TEST(CellMap, EmptyMapFindsNothing)
{
    CellMap map;
    EXPECT_EQ(map.find(0), nullptr);
    EXPECT_EQ(map.size(), 0u);
    map.clear();
    EXPECT_EQ(map.find(0), nullptr);
}

TEST(CellMap, InsertKeepsTheFirstValueAndSaysSo)
{
    CellMap map;
    const auto [first, added] = map.insert(42, 7);
    EXPECT_TRUE(added);
    EXPECT_EQ(*first, 7u);
    const auto [second, addedAgain] = map.insert(42, 8);
    EXPECT_FALSE(addedAgain);
    EXPECT_EQ(*second, 7u);
    ++*second;
    EXPECT_EQ(*map.find(42), 8u);
    EXPECT_EQ(map.size(), 1u);
}

TEST(CellMap, AllowsEveryKey)
{
    CellMap map;
    const std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(map.find(last), nullptr);
    map.insert(last, 1);
    map.insert(0, 2);
    EXPECT_EQ(*map.find(last), 1u);
    EXPECT_EQ(*map.find(0), 2u);
}

TEST(CellMap, AgreesWithAnOrderedMapUnderRandomUse)
{
    std::mt19937_64 random(1);
    CellMap map;
    for (int round = 0; round < 5; ++round) {
        std::map<std::uint64_t, std::uint32_t> expected;
        map.clear();
        for (std::uint32_t n = 0; n < 20000; ++n) {
            const std::uint64_t key = random() % 15000;  // so that many are asked for twice
            const auto [value, added] = map.insert(key, n);
            const auto [place, addedHere] = expected.emplace(key, n);
            ASSERT_EQ(added, addedHere);
            ASSERT_EQ(*value, place->second);
        }
        EXPECT_EQ(map.size(), expected.size());
        for (std::uint64_t key = 0; key < 16000; ++key) {
            const auto place = expected.find(key);
            const std::uint32_t* value = map.find(key);
            ASSERT_EQ(value != nullptr, place != expected.end()) << key;
            if (value != nullptr) {
                ASSERT_EQ(*value, place->second);
            }
        }
    }
}

TEST(CellMap, ClearForgetsKeysButKeepsMemory)
{
    CellMap map;
    for (std::uint64_t key = 0; key < 1000; ++key) {
        map.insert(key, 1);
    }
    const std::size_t capacity = map.capacity();
    map.clear();
    EXPECT_EQ(map.size(), 0u);
    EXPECT_EQ(map.capacity(), capacity);
    for (std::uint64_t key = 0; key < 1000; ++key) {
        ASSERT_EQ(map.find(key), nullptr);
    }
    EXPECT_TRUE(map.insert(5, 9).second);
    EXPECT_EQ(*map.find(5), 9u);
}

TEST(CellMap, ReserveIsEnoughAndKeepsWhatIsThere)
{
    CellMap map(3);
    map.insert(1, 10);
    map.reserve(1000);
    EXPECT_EQ(*map.find(1), 10u);
    const std::size_t capacity = map.capacity();
    const std::uint32_t* place = map.find(1);
    for (std::uint64_t key = 2; key <= 1000; ++key) {
        map.insert(key, 0);
    }
    EXPECT_EQ(map.capacity(), capacity);
    EXPECT_EQ(map.find(1), place) << "the table moved although room was reserved";
}

}  // namespace
}  // namespace sandflow
