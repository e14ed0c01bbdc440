#pragma once

#include "dem/dem.h"
#include "dem/restitution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <omp.h>

/// Sand set up by hand.
namespace sandflow::testing {

inline constexpr double kRadius = 0.005;
inline constexpr double kStep = 1e-4;

/// A handful of grains is not worth waking other threads for.
struct OneThread : ::testing::Environment {
    void SetUp() override { omp_set_num_threads(1); }
};
inline const ::testing::Environment* const kOneThread =
    ::testing::AddGlobalTestEnvironment(new OneThread);

inline DemSetup makeSetup(NormalLaw law = NormalLaw::linear)
{
    DemSetup setup;
    setup.law.law = law;
    setup.law.stiffness = law == NormalLaw::linear ? 3000.0 : 2e6;
    setup.law.damping = law == NormalLaw::bellYuMucha ? 1e-4 : solveDamping(law, true, 0.3);
    setup.law.friction = 0.5;
    setup.law.tangentialRatio = 2.0 / 7.0;
    setup.law.tangentialDamping = 0.2;
    return setup;
}

inline void addFrozen(Dem<float>& dem, const Vec3& position, std::uint32_t id,
                      GrainState state = GrainState::interface, double radius = kRadius)
{
    FrozenInfo info;
    info.state = state;
    dem.frozen().add(dem.makeRecord(position, radius, id), info);
}

inline void addMobile(Dem<float>& dem, const Vec3& position, std::uint32_t id,
                      const Vec3& velocity = Vec3::Zero(), double radius = kRadius)
{
    dem.addMobile(position, velocity, Vec3::Zero(), radius, id);
}

/// Four frozen grains 2.2 r apart, ids 100 to 103, about (0, 0, 0): a grain rests in the hollow.
inline void addHollow(Dem<float>& dem)
{
    std::uint32_t id = 100;
    for (const double x : {-1.1, 1.1}) {
        for (const double y : {-1.1, 1.1}) {
            addFrozen(dem, kRadius * Vec3(x, y, 0.0), id++);
        }
    }
}

/// Height at which a grain just touches the four of addHollow(), 1.257 r.
inline double hollowHeight()
{
    return kRadius * std::sqrt(4.0 - 2.0 * 1.1 * 1.1);
}

/// Steps for `seconds`; the last step is observed. Lists are made anew as needed.
inline void advance(Dem<float>& dem, double seconds)
{
    const int steps = static_cast<int>(std::lround(seconds / kStep));
    for (int n = 1; n <= steps; ++n) {
        if (!dem.listsHold()) {
            dem.recordContacts();
            dem.rebuild(0.0, kStep);
        }
        dem.step(kStep, n == steps);
    }
}

/// Index of a mobile grain by its id, -1 if it is not mobile.
inline std::ptrdiff_t mobileIndex(const Dem<float>& dem, std::uint32_t id)
{
    for (std::size_t k = 0; k < dem.mobile().size(); ++k) {
        if (dem.mobile().record[k].id == id) {
            return static_cast<std::ptrdiff_t>(k);
        }
    }
    return -1;
}

/// Index of a frozen grain by its id, -1 if it is not frozen.
inline std::ptrdiff_t frozenIndex(const Dem<float>& dem, std::uint32_t id)
{
    for (std::size_t k = 0; k < dem.frozen().size(); ++k) {
        if (dem.frozen().record(k).id == id) {
            return static_cast<std::ptrdiff_t>(k);
        }
    }
    return -1;
}

inline Vec3 positionOf(const GrainRecord<float>& g)
{
    return {g.x, g.y, g.z};
}

}  // namespace sandflow::testing
