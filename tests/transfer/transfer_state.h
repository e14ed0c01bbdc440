#pragma once

#include "bcre/test_fields.h"
#include "grain_states.h"
#include "transfer/matter_transfer.h"

#include <gtest/gtest.h>

#include <map>

/// A height field set by hand, and the sand that has to agree with it.
namespace sandflow::testing {

inline constexpr double kCell = 0.03;
inline constexpr int kEdge = 8;  // columns
inline constexpr double kWidth = kEdge * kCell;
/// Half a unit of the 16-bit fractions in which buried grains are kept.
inline constexpr double kHalfUnit = 0.5 * kCell / 65536.0 + 1e-12;

/// Everything a transfer works on: columns over a flat floor at z = 0, with h by hand.
struct State {
    ColumnGrid columns = makeFlatBox(kEdge, kEdge, kCell);
    Dem<float> dem{makeSetup()};
    BuriedGrains buried{kCell};
    TransferParams params;
    MatterTransfer<float> transfer{params};

    State() { dem.recordContacts(); }
    explicit State(const TransferParams& p) : params(p), transfer(p) { dem.recordContacts(); }

    void setBed(double h)
    {
        fill(
            columns, [h](double, double) { return h; }, [](double, double) { return 0.02; });
    }

    /// Calls every mobile grain whose id is even rested and supported, the others not.
    void judgeEvenAtRest()
    {
        for (std::size_t k = 0; k < dem.mobile().size(); ++k) {
            const bool rests = dem.mobile().record[k].id % 2 == 0;
            dem.mobile().memory[k].stillTime = rests ? 1.0f : 0.0f;
        }
    }

    TransferReport run()
    {
        dem.rebuild(0.0, kStep);
        judgeEvenAtRest();
        transfer.plan(columns, dem);
        dem.recordContacts();
        return transfer.apply(columns, dem, buried);
    }

    GrainState stateOf(std::uint32_t id) const
    {
        if (mobileIndex(dem, id) >= 0) {
            return GrainState::mobile;
        }
        const std::ptrdiff_t k = frozenIndex(dem, id);
        return k >= 0 ? dem.frozen().info(static_cast<std::size_t>(k)).state : GrainState::buried;
    }
};

struct Known {
    Vec3 position;
    float radius;
};

/// Every grain by id, whatever its state; fails if one is there twice.
inline std::map<std::uint32_t, Known> collectAll(const State& state)
{
    std::map<std::uint32_t, Known> out;
    const auto put = [&](std::uint32_t id, const Vec3& p, float radius) {
        EXPECT_TRUE(out.emplace(id, Known{p, radius}).second) << "grain " << id << " twice";
    };
    for (const GrainRecord<float>& g : state.dem.mobile().record) {
        put(g.id, positionOf(g), g.radius);
    }
    for (const GrainRecord<float>& g : state.dem.frozen().records()) {
        put(g.id, positionOf(g), g.radius);
    }
    state.buried.forEach([&](const Vec3& p, double radius, std::uint32_t id) {
        put(id, p, static_cast<float>(radius));
    });
    return out;
}

inline Vec3 overColumn(int i, int j, double z)
{
    return {(i + 0.4) * kCell, (j + 0.6) * kCell, z};
}

}  // namespace sandflow::testing
