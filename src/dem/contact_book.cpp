#include "dem/contact_book.h"

#include <array>

namespace sandflow {
namespace {

/// Calls visit(grain, partnerId, springs as the grain sees them) for every live contact of a chunk. Of
/// two grains in different chunks the one with the lower id has it.
template <class Real, class Visit>
void visitLive(const ChunkContacts<Real>& chunk, const GrainRecord<Real>* grains,
               const std::array<const GrainRecord<Real>*, kPartnerSources>& source, Visit visit)
{
    for (std::size_t p = 0; p < chunk.own.size(); ++p) {
        if (chunk.ownLive[p]) {
            const std::uint32_t i = own_pair::lowerOf(chunk.own[p]);
            const std::uint32_t j = own_pair::higherOf(chunk.own[p]);
            visit(i, grains[j].id, chunk.ownHistory[p]);
        }
    }
    for (std::size_t q = 0; q < chunk.foreign.size(); ++q) {
        if (chunk.foreignLive[q]) {
            const std::uint32_t f = chunk.foreign[q];
            const std::uint32_t slot = slot_offset::slotOf(chunk.foreignSlot[q]);
            const std::uint32_t id = source[partner::sourceOf(f)][partner::indexOf(f)].id;
            if (partner::sourceOf(f) != static_cast<std::uint32_t>(PartnerSource::mobile) ||
                grains[slot].id < id) {
                visit(slot, id, chunk.foreignHistory[q]);
            }
        }
    }
    for (std::size_t w = 0; w < chunk.walls.size(); ++w) {
        if (chunk.walls[w].live) {
            visit(chunk.walls[w].grain, kFirstWallId + chunk.walls[w].primitive,
                  chunk.wallHistory[w]);
        }
    }
}

}  // namespace

template <class Real>
void ContactBook<Real>::record(std::span<const ChunkContacts<Real>> chunks,
                               std::span<const GrainRecord<Real>> mobile,
                               std::span<const GrainRecord<Real>> frozen,
                               std::span<const GrainRecord<Real>> boundary)
{
    const std::array<const GrainRecord<Real>*, kPartnerSources> source = {
        mobile.data(), frozen.data(), boundary.data()};
    const auto chunkCount = static_cast<std::int64_t>(chunks.size());
    end_.assign(mobile.size(), 0);
    chunkBegin_.assign(chunks.size() + 1, 0);

    // Count per grain and per chunk, then every chunk fills its own stretch.
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t c = 0; c < chunkCount; ++c) {
        const std::uint32_t first = static_cast<std::uint32_t>(c) * kChunkSize;
        std::uint32_t total = 0;
        visitLive(chunks[c], mobile.data() + first, source,
                  [&](std::uint32_t i, std::uint32_t, const PairHistory<Real>&) {
                      ++end_[first + i];
                      ++total;
                  });
        chunkBegin_[c + 1] = total;
    }
    for (std::int64_t c = 0; c < chunkCount; ++c) {
        chunkBegin_[c + 1] += chunkBegin_[c];
    }
    if (const std::size_t count = chunkBegin_.back(); count > history_.capacity()) {
        partner_.clear(), history_.clear();  // nothing to be copied
        partner_.reserve(count + count / 32);
        history_.reserve(count + count / 32);
    }
    partner_.resize(chunkBegin_.back());
    history_.resize(chunkBegin_.back());
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t c = 0; c < chunkCount; ++c) {
        const std::uint32_t first = static_cast<std::uint32_t>(c) * kChunkSize;
        const std::uint32_t n = chunks[c].grainCount;
        std::uint32_t sum = chunkBegin_[c];
        for (std::uint32_t i = 0; i < n; ++i) {  // counts become where each row is filled next
            const std::uint32_t here = end_[first + i];
            end_[first + i] = sum;
            sum += here;
        }
        visitLive(chunks[c], mobile.data() + first, source,
                  [&](std::uint32_t i, std::uint32_t id, const PairHistory<Real>& springs) {
                      const std::uint32_t e = end_[first + i]++;
                      partner_[e] = id;
                      history_[e] = springs;
                  });
    }
}

template class ContactBook<float>;
template class ContactBook<double>;

}  // namespace sandflow
