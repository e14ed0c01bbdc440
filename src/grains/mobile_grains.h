#pragma once

#include "core/vec3.h"
#include "grains/grain_record.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// What is known of a mobile grain besides its record, where grains are judged (surface flow);
/// touched only when lists are rebuilt or grains are judged, never in a step.
struct GrainMemory {
    double anchorX = 0, anchorY = 0, anchorZ = 0;  ///< m, where it was when it last counted as moved
    float stillTime = 0;                           ///< s since then; < 0: so long it counts as moving
    float freeTime = 0;                            ///< s since it last touched anything
    Vec3f velocity = Vec3f::Zero();                ///< m/s, when that was last looked at
};

/// What one observed step says of a mobile grain.
struct GrainLoad {
    float contacts = 0;   ///< partners that push on it
    float netForce = 0;   ///< N, |sum of contact forces + weight|
    float load = 0;       ///< N, sum of normal forces
};

/// Of grains that have no row in the contact book.
inline constexpr std::uint32_t kNoRow = 0xFFFFFFFFu;

/// The grains that are integrated, in cell order. Two copies of the records, so that one step reads
/// the old and writes the new and needs a single barrier.
template <class Real>
struct MobileGrains {
    std::vector<GrainRecord<Real>> record, next;
    std::vector<std::uint32_t> row;    ///< in the contact book, or kNoRow
    std::vector<GrainMemory> memory;   ///< empty unless grains are judged
    std::vector<GrainLoad> load;       ///< filled by observed steps only
    bool judged = true;                ///< set before the first grain comes

    std::size_t size() const { return record.size(); }

    /// Room for so many in all, and no more.
    void reserve(std::size_t count)
    {
        record.reserve(count), next.reserve(count), row.reserve(count);
        memory.reserve(judged ? count : 0);
    }

    void add(const GrainRecord<Real>& grain)
    {
        record.push_back(grain);
        row.push_back(kNoRow);
        if (judged) {
            GrainMemory& latest = memory.emplace_back();
            latest.anchorX = grain.x, latest.anchorY = grain.y, latest.anchorZ = grain.z;
        }
    }

    /// Keeps those for which keep(index) is true, in their order.
    template <class Keep>
    void removeUnless(Keep keep)
    {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < record.size(); ++k) {
            if (!keep(k)) {
                continue;
            }
            record[kept] = record[k];
            row[kept] = row[k];
            if (judged) {
                memory[kept] = memory[k];
            }
            ++kept;
        }
        record.resize(kept);
        row.resize(kept);
        memory.resize(judged ? kept : 0);
    }
};

}  // namespace sandflow
