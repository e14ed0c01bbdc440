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

/// A partner packed into 32 bits: | source:2 | index:30 |.
namespace partner {
inline constexpr std::uint32_t kSourceShift = 30;
inline constexpr std::uint32_t kIndexMask = (1u << kSourceShift) - 1;

constexpr std::uint32_t pack(PartnerSource source, std::uint32_t index)
{
    return static_cast<std::uint32_t>(source) << kSourceShift | index;
}
constexpr std::uint32_t sourceOf(std::uint32_t p) { return p >> kSourceShift; }
constexpr std::uint32_t indexOf(std::uint32_t p) { return p & kIndexMask; }
}  // namespace partner

/// A slot of a chunk times 64: where the grain's record lies in the chunk when records are 64 bytes,
/// so that the kernel finds it without arithmetic.
namespace slot_offset {
inline constexpr std::uint32_t kShift = 6;
static_assert(kChunkSize << kShift == 1u << 16, "an offset takes 16 bits");

constexpr std::uint16_t of(std::uint32_t slot) { return static_cast<std::uint16_t>(slot << kShift); }
constexpr std::uint32_t slotOf(std::uint32_t offset) { return offset >> kShift; }
}  // namespace slot_offset

/// A pair within a chunk packed into 32 bits: | offset of the higher slot:16 | of the lower:16 |.
namespace own_pair {
constexpr std::uint32_t pack(std::uint32_t lower, std::uint32_t higher)
{
    return static_cast<std::uint32_t>(slot_offset::of(higher)) << 16 | slot_offset::of(lower);
}
constexpr std::uint32_t lowerOffset(std::uint32_t p) { return p & 0xFFFFu; }
constexpr std::uint32_t higherOffset(std::uint32_t p) { return p >> 16; }
constexpr std::uint32_t lowerOf(std::uint32_t p) { return slot_offset::slotOf(lowerOffset(p)); }
constexpr std::uint32_t higherOf(std::uint32_t p) { return slot_offset::slotOf(higherOffset(p)); }
}  // namespace own_pair

/// One bit per pair of a list: set if its springs hold something. Springs of pairs that do not touch
/// are never written to.
class LiveBits {
public:
    static constexpr std::size_t kBits = 32;

    void clear() { words_.clear(), count_ = 0; }
    void push_back(bool live)
    {
        if (count_ % kBits == 0) {
            words_.push_back(0);
        }
        words_.back() |= static_cast<std::uint32_t>(live) << count_++ % kBits;
    }
    bool operator[](std::size_t pair) const { return words_[pair / kBits] >> pair % kBits & 1u; }
    std::uint32_t* data() { return words_.data(); }
    std::size_t size() const { return count_; }
    std::size_t bytes() const { return sizeof(std::uint32_t) * words_.capacity(); }

private:
    std::vector<std::uint32_t> words_;
    std::size_t count_ = 0;
};

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
    std::vector<std::uint16_t> foreignSlot; ///< the grain, see slot_offset
    LiveBits ownLive, foreignLive;
    std::vector<PairHistory<Real>> ownHistory, foreignHistory;

    struct Wall {
        std::uint16_t grain;      ///< slot within the chunk
        bool live;
        std::uint32_t primitive;
    };
    std::vector<Wall> walls;
    std::vector<PairHistory<Real>> wallHistory;

    /// Empties the lists and leaves room for about as much as there was: chunks change little from
    /// one rebuild to the next, and room that doubled while a list grew is given back.
    void clearAndFit()
    {
        const auto fit = [](auto& list) {
            const std::size_t room = list.size() + list.size() / 32 + 16;
            list.clear();
            if (list.capacity() < room || list.capacity() > room + room / 24) {
                list.shrink_to_fit();
                list.reserve(room);
            }
        };
        grainCount = 0;
        fit(own), fit(foreign), fit(foreignSlot), fit(ownHistory), fit(foreignHistory);
        ownLive.clear(), foreignLive.clear(), walls.clear(), wallHistory.clear();
    }

    /// Lists that are full grow by a sixteenth, not to twice their size.
    template <class Value>
    static void push(std::vector<Value>& list, const Value& value)
    {
        if (list.size() == list.capacity()) {
            list.reserve(list.size() + list.size() / 16 + 16);
        }
        list.push_back(value);
    }

    void appendOwn(std::uint32_t lower, std::uint32_t higher, bool live,
                   const PairHistory<Real>& springs)
    {
        push(own, own_pair::pack(lower, higher));
        ownLive.push_back(live);
        push(ownHistory, springs);
    }
    void appendForeign(std::uint32_t slot, PartnerSource source, std::uint32_t index, bool live,
                       const PairHistory<Real>& springs)
    {
        push(foreign, partner::pack(source, index));
        push(foreignSlot, slot_offset::of(slot));
        foreignLive.push_back(live);
        push(foreignHistory, springs);
    }

    std::size_t bytes() const
    {
        return ownLive.bytes() + foreignLive.bytes() +
               4 * (own.capacity() + foreign.capacity()) + 2 * foreignSlot.capacity() +
               sizeof(Wall) * walls.capacity() +
               sizeof(PairHistory<Real>) *
                   (ownHistory.capacity() + foreignHistory.capacity() + wallHistory.capacity());
    }
};

}  // namespace sandflow
