#pragma once

#include "grains/grain_record.h"

#include <cstdint>
#include <vector>

namespace sandflow {

/// Mobile grains are worked on in chunks of this many neighbouring slots. Fixed, so that sums are
/// formed in the same order for any number of threads; small, so that a chunk's grains and force
/// sums (1024 x 88 B) stay in a core's own cache.
inline constexpr std::uint32_t kChunkSize = 1024;

/// Where the partner of a one-sided contact lives.
enum class PartnerSource : std::uint32_t { mobile = 0, frozen = 1, boundary = 2 };
inline constexpr std::uint32_t kPartnerSources = 3;

/// A partner packed into 32 bits: | live:1 | source:2 | index:29 |. `live` says that the springs of
/// the pair hold something; pairs that do not touch are never written to.
namespace partner {
inline constexpr std::uint32_t kLive = 0x80000000u;
inline constexpr std::uint32_t kSourceShift = 29;
inline constexpr std::uint32_t kIndexMask = (1u << kSourceShift) - 1;

constexpr std::uint32_t pack(PartnerSource source, std::uint32_t index)
{
    return static_cast<std::uint32_t>(source) << kSourceShift | index;
}
constexpr std::uint32_t sourceOf(std::uint32_t p) { return p >> kSourceShift & 3u; }
constexpr std::uint32_t indexOf(std::uint32_t p) { return p & kIndexMask; }
}  // namespace partner

/// A pair within a chunk packed into 32 bits: | live:1 | .. | lower slot:10 | higher slot:10 |.
namespace own_pair {
inline constexpr std::uint32_t kLive = partner::kLive;
inline constexpr std::uint32_t kSlotBits = 10;
inline constexpr std::uint32_t kSlotMask = (1u << kSlotBits) - 1;
static_assert(kChunkSize == 1u << kSlotBits);

constexpr std::uint32_t pack(std::uint32_t lower, std::uint32_t higher)
{
    return lower << kSlotBits | higher;
}
constexpr std::uint32_t lowerOf(std::uint32_t p) { return p >> kSlotBits & kSlotMask; }
constexpr std::uint32_t higherOf(std::uint32_t p) { return p & kSlotMask; }
}  // namespace own_pair

/// Contacts of the grains of one chunk, in order of the grain's slot. Every pair names its grain,
/// so that lists are run through without a loop per grain: those are short and end unpredictably.
///
///   own      both grains in this chunk: listed once, under the lower slot; the force is computed
///            once and given to both
///   foreign  partner in another chunk, frozen, or part of a rough solid: one-sided. A pair across
///            chunks is computed by both, from the same numbers with the sign turned, so action
///            equals reaction to the last bit without any exchange
///   wall     analytic primitives
template <class Real>
struct ChunkContacts {
    std::uint32_t grainCount = 0;
    std::vector<std::uint32_t> own;         ///< see own_pair
    std::vector<std::uint32_t> foreign;     ///< the partner, see partner
    std::vector<std::uint16_t> foreignSlot; ///< the grain, as slot within the chunk
    std::vector<PairHistory<Real>> ownHistory, foreignHistory;

    struct Wall {
        std::uint32_t grain;      ///< slot within the chunk | live
        std::uint32_t primitive;
    };
    std::vector<Wall> walls;
    std::vector<PairHistory<Real>> wallHistory;

    void clear()
    {
        grainCount = 0;
        own.clear(), foreign.clear(), foreignSlot.clear();
        ownHistory.clear(), foreignHistory.clear(), walls.clear(), wallHistory.clear();
    }

    std::size_t bytes() const
    {
        return 4 * (own.capacity() + foreign.capacity()) + 2 * foreignSlot.capacity() +
               sizeof(Wall) * walls.capacity() +
               sizeof(PairHistory<Real>) *
                   (ownHistory.capacity() + foreignHistory.capacity() + wallHistory.capacity());
    }
};

}  // namespace sandflow
