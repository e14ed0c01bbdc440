#pragma once

#include "grains/grain_record.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// What is known of a mobile grain besides its record; touched only when lists are rebuilt or
/// grains are judged, never in a step.
struct GrainMemory {
    double anchorX = 0, anchorY = 0, anchorZ = 0;  ///< m, where it was when it last counted as moved
    float stillTime = 0;                           ///< s since then
    std::uint32_t row = 0xFFFFFFFFu;               ///< its row in the contact book, if it has one
};

/// What one observed step says of a mobile grain.
struct GrainLoad {
    float contacts = 0;   ///< partners that push on it
    float netForce = 0;   ///< N, |sum of contact forces + weight|
    float load = 0;       ///< N, sum of normal forces
};

/// The grains that are integrated, in cell order. Two copies of the records, so that one step reads
/// the old and writes the new and needs a single barrier.
template <class Real>
struct MobileGrains {
    std::vector<GrainRecord<Real>> record, next;
    std::vector<GrainMemory> memory;
    std::vector<GrainLoad> load;   ///< filled by observed steps only

    std::size_t size() const { return record.size(); }
};

}  // namespace sandflow
