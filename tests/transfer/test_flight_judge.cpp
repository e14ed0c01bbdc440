#include "transfer/flight_judge.h"

#include <gtest/gtest.h>

namespace sandflow {
namespace {

constexpr double kInterval = 0.02;  // s

/// One mobile grain in a scene of its own; tests set its velocity by hand.
struct OneGrain {
    OneGrain() : dem(DemSetup{})
    {
        dem.addMobile(Vec3(0.0, 0.0, 1.0), Vec3(0.3, 0.0, -1.0), Vec3::Zero(), 0.005, 0);
    }

    /// As if it had flown for `interval` [s], with `push` [m/s] besides.
    double flyOn(const Vec3& push = Vec3::Zero())
    {
        GrainRecord<float>& g = dem.mobile().record[0];
        const Vec3 gained = kInterval * dem.setup().gravity + push;
        g.vx += static_cast<float>(gained.x());
        g.vy += static_cast<float>(gained.y());
        g.vz += static_cast<float>(gained.z());
        return endFlights(kInterval, dem);
    }

    double momentum() const
    {
        const GrainRecord<float>& g = dem.mobile().record[0];
        return Vec3(g.vx, g.vy, g.vz).norm() / static_cast<double>(g.inverseMass);
    }

    Dem<float> dem;
};

TEST(Flights, EndOnceAtTheFirstContact)
{
    OneGrain grain;
    startFlight(0.0, grain.dem);
    for (int n = 0; n < 10; ++n) {
        EXPECT_EQ(grain.flyOn(), 0.0);
    }
    const double brought = grain.momentum();
    EXPECT_NEAR(grain.flyOn(Vec3(0.0, 0.0, 2.0)), brought, 1e-9 * brought);
    EXPECT_EQ(grain.flyOn(Vec3(0.1, 0.0, 0.3)), 0.0) << "it had landed already";
}

TEST(Flights, AGrainEmittedBetweenTwoLooksIsInFlight)
{
    OneGrain grain;
    const double elapsed = 0.015;
    startFlight(elapsed, grain.dem);
    GrainRecord<float>& g = grain.dem.mobile().record[0];
    g.vz += static_cast<float>((kInterval - elapsed) * grain.dem.setup().gravity.z());
    EXPECT_EQ(endFlights(kInterval, grain.dem), 0.0);
    // One that touches something before the first look brought what it came with, nearly.
    OneGrain hasty;
    startFlight(elapsed, hasty.dem);
    const double brought = hasty.momentum();
    hasty.dem.mobile().record[0].vz = 0.0f;
    EXPECT_NEAR(endFlights(kInterval, hasty.dem), brought, 0.2 * brought);
}

TEST(Flights, GrainsOnTheHeapAreNotInFlight)
{
    OneGrain grain;  // not emitted: set free, or it lies
    EXPECT_EQ(grain.flyOn(Vec3(0.0, 0.0, 0.196)), 0.0);
    EXPECT_EQ(grain.flyOn(Vec3(0.0, 0.0, 0.196)), 0.0);
    // A hop of a window or two is part of rolling down.
    EXPECT_EQ(grain.flyOn(), 0.0);
    EXPECT_EQ(grain.flyOn(), 0.0);
    EXPECT_EQ(grain.flyOn(Vec3(0.0, 0.0, 0.5)), 0.0);
}

TEST(Flights, BeginAgainWithAFallThroughMoreThanADiameter)
{
    OneGrain grain;
    grain.flyOn(Vec3(0.0, 0.0, 0.5));
    const int windows = static_cast<int>(std::ceil(kFlightTime / kInterval));
    for (int n = 0; n < windows; ++n) {
        EXPECT_EQ(grain.flyOn(), 0.0);
    }
    EXPECT_GT(0.5 * kGravity * kFlightTime * kFlightTime, 0.01);
    const double brought = grain.momentum();
    EXPECT_NEAR(grain.flyOn(Vec3(0.5, 0.0, 0.0)), brought, 1e-9 * brought);
}

TEST(Flights, AGrazingContactCounts)
{
    OneGrain grain;
    startFlight(0.0, grain.dem);
    grain.flyOn();
    const double brought = grain.momentum();
    const double share = 0.1 * kGravity * kInterval;  // a tenth of what gravity does in a window
    EXPECT_NEAR(grain.flyOn(Vec3(share, 0.0, 0.0)), brought, 1e-9 * brought);
}

}  // namespace
}  // namespace sandflow
