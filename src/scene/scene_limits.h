#pragma once

#include <cstdint>

namespace sandflow {

/// Values a number may take. Ends belong to the range unless they are open.
struct Range {
    double low;
    double high;
    bool lowOpen = false;
    bool highOpen = false;

    bool contains(double value) const
    {
        return (lowOpen ? value > low : value >= low) && (highOpen ? value < high : value <= high);
    }
};

/// Whole numbers a count may take, ends included.
struct IntegerRange {
    std::int64_t low;
    std::int64_t high;
};

/// What a scene file may say, all in one place, each with its reason. The limits keep nonsense and
/// slips of the unit (millimetres for metres) out; whether a scene is physically sound (stiffness,
/// step, a jet that is too dense) is judged where those numbers are made.
namespace limits {

// A coordinate this large stands for "no end"; see DomainSpec and SolidSpec::until.
inline constexpr double kOpenEnd = 1e30;

// Cells are keyed by 32-bit integers: 10 km holds at the smallest grain, with room to spare.
inline constexpr Range kCoordinate{-1e4, 1e4};
inline constexpr Range kLength{0.0, 1e4, true};
// A scan may be in micrometres or in kilometres.
inline constexpr Range kMeshScale{0.0, 1e6, true};
inline constexpr Range kTurn{-360.0, 360.0};
inline constexpr Range kDomainCoordinate{-kOpenEnd, kOpenEnd};

// From silt to boulders; below, cohesion and air rule what a grain does.
inline constexpr Range kGrainRadius{1e-5, 1.0};
// The radii span (1 + s) / (1 - s) <= 5: beyond, one cell size no longer serves all grains.
inline constexpr Range kSizeSpread{0.0, 0.67, false, true};
inline constexpr double kLargestSizeRatio = 1.67 / 0.33;
// From aerogel to twice the densest metal.
inline constexpr Range kDensity{1.0, 5e4};

// 0 would need an infinite dashpot; above 1 a collision makes energy.
inline constexpr Range kRestitution{0.0, 1.0, true};
// Sand has 0.3 to 1; 10 is as good as "never slides".
inline constexpr Range kFriction{0.0, 10.0};
// Elasticity gives 2/3 to 1 (Mindlin), solvers use 2/7 and more; 2 is stiff beyond any material.
// To have no friction, friction = 0 says so.
inline constexpr Range kTangentialRatio{0.0, 2.0, true};
inline constexpr Range kTangentialDamping{0.0, 10.0};
inline constexpr Range kStiffness{0.0, 1e12, true};
// Above diamond (1.2e12 Pa) there is nothing.
inline constexpr Range kYoungModulus{0.0, 2e12, true};
// 0.5 is incompressible. Negative (auxetic) materials are no sand.
inline constexpr Range kPoissonRatio{0.0, 0.5};
// A rough cover holds grains up to an overlap of 0.8 r; beyond it they leak through.
inline constexpr Range kMaxOverlap{0.0, 0.8, true};

inline constexpr Range kFrameRate{0.0, 1e5, true};
inline constexpr Range kTime{0.0, 1e6};
inline constexpr Range kDuration{0.0, 1e6, true};
// A solid may last for ever.
inline constexpr Range kUntil{0.0, kOpenEnd, true};
// No grain bigger than gravel collides slowly enough for more than 0.1 s.
inline constexpr Range kStep{0.0, 0.1, true};
// 1 is the stability bound itself.
inline constexpr Range kStepSafety{0.0, 1.0, true};

inline constexpr Range kInterval{0.0, 10.0, true};
// Below one diameter a column holds no whole grain; above 20 a heap has no shape left.
inline constexpr Range kCellSize{1.0, 20.0};
inline constexpr Range kExchangeRate{0.0, 1e5};
inline constexpr Range kSlope{0.0, 90.0, true, true};
inline constexpr Range kDepth{0.0, 100.0};
// Thinner than one grain the interface would let mobile grains through to the buried ones.
inline constexpr Range kInterfaceThickness{1.0, 100.0};
inline constexpr Range kShare{0.0, 1.0};
inline constexpr Range kSaturationDepth{0.0, 1000.0, true};
inline constexpr Range kMaxChange{0.0, 10.0, true};
inline constexpr Range kTransportSpeed{0.0, 100.0};
inline constexpr Range kFreezeSpeed{0.0, 1.0};
inline constexpr Range kFreezeTime{0.0, 100.0};

// Ids of grains are 32-bit.
inline constexpr std::int64_t kMostGrains = 4'000'000'000;
inline constexpr IntegerRange kCount{1, kMostGrains};
inline constexpr IntegerRange kCountOrFull{0, kMostGrains};
inline constexpr Range kRate{0.0, 1e9, true};
// Sand at 1 km/s is ballistics, not flow.
inline constexpr Range kSpeed{0.0, 1e3, true};
inline constexpr Range kVelocity{-1e3, 1e3};
inline constexpr Range kSpin{-1e6, 1e6};

// About 100 g either way.
inline constexpr Range kGravity{-1e3, 1e3};
// A TOML integer is a signed 64-bit number.
inline constexpr IntegerRange kSeed{0, INT64_MAX};
// Wider than 170 degrees a perspective picture is all rim.
inline constexpr Range kViewAngle{1.0, 170.0};

}  // namespace limits
}  // namespace sandflow
