#pragma once

#include "dem/chunk_contacts.h"

#include <span>
#include <vector>

namespace sandflow {

/// Springs of all live contacts, by row (one per mobile grain of the old lists) and partner id:
/// what outlives a rebuild of the lists. Every contact of two mobile grains stands in both rows.
template <class Real>
class ContactBook {
public:
    static constexpr std::uint32_t kNoRow = 0xFFFFFFFFu;

    /// Copies the live contacts of the lists as they stand.
    void record(std::span<const ChunkContacts<Real>> chunks,
                std::span<const GrainRecord<Real>> mobile,
                std::span<const GrainRecord<Real>> frozen,
                std::span<const GrainRecord<Real>> boundary);

    /// Springs of the contact of row `row` with partner `id`, or null.
    const PairHistory<Real>* find(std::uint32_t row, std::uint32_t id) const
    {
        if (row == kNoRow) {
            return nullptr;
        }
        for (std::uint32_t e = row == 0 ? 0 : end_[row - 1]; e < end_[row]; ++e) {
            if (partner_[e] == id) {
                return &history_[e];
            }
        }
        return nullptr;
    }

    std::size_t size() const { return partner_.size(); }

private:
    std::vector<std::uint32_t> end_;
    std::vector<std::uint32_t> partner_;
    std::vector<PairHistory<Real>> history_;
    std::vector<std::uint32_t> chunkBegin_;
};

}  // namespace sandflow
