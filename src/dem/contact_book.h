#pragma once

#include "dem/chunk_contacts.h"
#include "grains/mobile_grains.h"

#include <span>
#include <vector>

namespace sandflow {

/// Springs of all live contacts, by row (one per mobile grain of the old lists) and partner id:
/// what outlives a rebuild of the lists. A contact of two mobile grains stands in the row of one of
/// them, a contact with anything fixed in that of the mobile grain.
template <class Real>
class ContactBook {
public:
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

    /// Springs as grain a sees them, of the contact of two grains with these rows and ids; zero and
    /// false if they did not touch.
    bool recall(std::uint32_t rowA, std::uint32_t idA, std::uint32_t rowB, std::uint32_t idB,
                PairHistory<Real>& springs) const
    {
        if (const PairHistory<Real>* h = find(rowA, idB)) {
            springs = *h;
            return true;
        }
        if (const PairHistory<Real>* h = find(rowB, idA)) {
            springs = {-h->sx, -h->sy, -h->sz, -h->qx, -h->qy, -h->qz};
            return true;
        }
        springs = {};
        return false;
    }

    std::size_t bytes() const
    {
        return sizeof(std::uint32_t) * (end_.capacity() + partner_.capacity()) +
               sizeof(PairHistory<Real>) * history_.capacity();
    }

    std::size_t size() const { return partner_.size(); }

private:
    std::vector<std::uint32_t> end_;
    std::vector<std::uint32_t> partner_;
    std::vector<PairHistory<Real>> history_;
    std::vector<std::uint32_t> chunkBegin_;
};

}  // namespace sandflow
