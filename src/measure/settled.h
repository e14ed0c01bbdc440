#pragma once

#include "grains/snapshot.h"
#include "measure/floor.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// Which grains belong to the accumulated sand, and which are on their way through the air.
struct SettledRule {
    /// m/s. Grains that flow down a heap of centimetre grains stay below it; one that falls freely
    /// has passed it after 18 mm, and every grain of a jet is faster.
    double fastest = 0.6;
    /// Widest gap to what carries the grain, in its radii. The cover of a rough floor has its
    /// centres on the floor, so a grain lies up to one radius above it; in a creeping layer grains
    /// part for an instant. A grain that jumps no higher than this errs by about half a diameter
    /// in one place only.
    double widestGap = 1.2;
};

/// One byte per grain: 1 if it is part of the accumulated sand. That is every grain that the
/// solver holds still (asleep, interface, buried), and a mobile one that is slow and has the floor,
/// or another grain that is not fast and whose centre is lower, within the gap. Grains below the
/// floor count as lying on it.
std::vector<std::uint8_t> findSettled(const Snapshot& snapshot, const FloorHeight& floor,
                                      const SettledRule& rule = {});

}  // namespace sandflow
