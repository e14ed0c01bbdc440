#include "transfer/impact_zones.h"

#include "transfer/flight_judge.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

constexpr double kRadius = 0.005;
constexpr double kInterval = 0.02;  // s
constexpr double kSurface = 0.1;    // m
constexpr double kWeight = 0.6 * 2600.0 * kGravity;  // N/m3, of the sand
const double kMass = 2600.0 * 4.0 / 3.0 * kPi * std::pow(kRadius, 3);

/// Level sand with its surface at kSurface, and grains in flight over it.
struct Bed {
    Bed()
        : columns(0.03,
                  [](double, double, std::vector<ColumnGrid::FreeInterval>& out) {
                      out.assign(1, {0.0, 1e30});
                  },
                  {}),
          dem(DemSetup{})
    {
        columns.ensureColumn(0, 0);
        columns.H.assign(columns.spanCount(), kSurface);
    }

    void shoot(const Vec3& position, const Vec3& velocity, double radius = kRadius)
    {
        dem.addMobile(position, velocity, Vec3::Zero(), radius, next++);
        startFlight(0.0, dem);
    }

    std::vector<ImpactZone> foresee() { return watch.foresee(kInterval, columns, dem); }

    ColumnGrid columns;
    Dem<float> dem;
    ImpactWatch watch;
    std::uint32_t next = 0;
};

TEST(ImpactZones, AreWhereAFlightWillEndAndAsWideAsItsEnergy)
{
    Bed bed;
    bed.shoot(Vec3(0.1, 0.1, kSurface + 0.04), Vec3(1.0, 0.0, -3.0));
    const std::vector<ImpactZone> zones = bed.foresee();
    ASSERT_EQ(zones.size(), 1u);
    EXPECT_NEAR(zones[0].centre.z(), kSurface, 1e-12);
    EXPECT_NEAR(zones[0].centre.x(), 0.1 + 0.015 / 3.0, 0.005);
    // A single grain adds a force, its momentum over the interval, which reaches farther here than
    // its energy.
    const double force = kMass * std::sqrt(10.0) / kInterval, reach = zones[0].radius - kRadius;
    EXPECT_NEAR(3.0 * force / (2.0 * kPi * reach * reach), 0.2 * kWeight * reach, 1e-3 * force);
    EXPECT_GT(std::pow(reach, 4), 0.5 * kMass * 10.0 / (2.0 / 3.0 * kPi * kWeight));
}

TEST(ImpactZones, GrainsThatStrikeTheSamePlaceAddTheirEnergies)
{
    Bed one, many;
    one.shoot(Vec3(0.1, 0.1, kSurface + 0.03), Vec3(0.0, 0.0, -3.0));
    for (int n = 0; n < 16; ++n) {
        many.shoot(Vec3(0.095 + 0.001 * n, 0.1, kSurface + 0.03), Vec3(0.0, 0.0, -3.0));
    }
    const std::vector<ImpactZone> single = one.foresee(), burst = many.foresee();
    ASSERT_EQ(single.size(), 1u);
    ASSERT_EQ(burst.size(), 1u);
    EXPECT_NEAR(burst[0].radius - kRadius, std::cbrt(16.0) * (single[0].radius - kRadius), 1e-6);
}

TEST(ImpactZones, UnderASteadyJetOnlyItsEnergyCounts)
{
    Bed bed;
    for (int n = 0; n < 16; ++n) {
        bed.shoot(Vec3(0.095 + 0.001 * n, 0.1, kSurface + 0.03), Vec3(0.0, 0.0, -3.0));
    }
    const double first = bed.foresee()[0].radius - kRadius;
    double last = first;
    for (int n = 0; n < 200; ++n) {
        last = bed.foresee()[0].radius - kRadius;
    }
    EXPECT_LT(last, 0.7 * first);
    const double energy = 16.0 * 0.5 * kMass * 9.0;
    EXPECT_NEAR(2.0 / 3.0 * kPi * kWeight * std::pow(last, 4), energy, 1e-3 * energy);
}

TEST(ImpactZones, WhereNothingStrikesAnyMoreNothingIsWoken)
{
    Bed bed;
    bed.shoot(Vec3(0.1, 0.1, kSurface + 0.03), Vec3(0.0, 0.0, -3.0));
    const double first = bed.foresee()[0].radius;
    bed.dem.mobile().memory[0].freeTime = 0.0f;
    for (int n = 0; n < 100; ++n) {
        EXPECT_TRUE(bed.foresee().empty());
    }
    bed.dem.mobile().memory[0].freeTime = 1.0f;
    EXPECT_NEAR(bed.foresee()[0].radius, first, 1e-9) << "the old strike is forgotten";
}

TEST(ImpactZones, NoneForWhatDoesNotArriveLandsGentlyOrLies)
{
    Bed bed;
    bed.shoot(Vec3(0.1, 0.1, kSurface + 0.2), Vec3(0.0, 0.0, -3.0));   // too high
    bed.shoot(Vec3(0.2, 0.1, kSurface + 0.03), Vec3(0.0, 0.0, 3.0));   // rises
    bed.shoot(Vec3(0.3, 0.1, kSurface + 0.01), Vec3(0.0, 0.0, -0.3));  // gently
    EXPECT_TRUE(bed.foresee().empty());
    // Fast, but part of what flows.
    bed.dem.addMobile(Vec3(0.4, 0.1, kSurface), Vec3(0.0, 0.0, -3.0), Vec3::Zero(), kRadius, 99);
    EXPECT_TRUE(bed.foresee().empty());
}

TEST(ImpactZones, AHeavyGrainsZoneHoldsItself)
{
    Bed bed;
    const double radius = 4.0 * kRadius;
    bed.shoot(Vec3(0.1, 0.1, kSurface + radius + 0.03), Vec3(0.0, 0.0, -3.0), radius);
    const auto zones = bed.foresee();
    ASSERT_EQ(zones.size(), 1u);
    EXPECT_GT(zones[0].radius, radius + 10.0 * kRadius);
}

}  // namespace
}  // namespace sandflow
