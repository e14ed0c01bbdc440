#pragma once

#include "dem/chunk_pass.h"
#include "dem/contact_pair.h"
#include "dem/record_rows.h"

#include <algorithm>
#include <cstddef>

namespace sandflow {

/// Forces of a chunk's grain contacts, written once for any kind of lanes. Lanes has
///
///   Number, Real, width           one lane, all lanes, how many
///   subtract(a, b, apart, radii)  of records a(l), b(l): positions in double, then rounded; sum of
///                                 radii
///   load(p)                       lane l = p[l]
///   gatherRows(row, k, v)         v[c] lane l = row(l)[k + c],  c < 4
///   scatterRows(v, row, k)        row(l)[k + c] = v[c] lane l
///   storeSums(v, w, p)            p[storedSum(l) + c] = v[c] lane l, p[storedSum(l) + 4 + c] = w[c]
///                                 lane l
///   bitsOf(mask)                  bit l = mask lane l
///   append(mask, apart, packed, p, out, at)
///                                 lanes of the mask to out[at], out[at + 1], ..., with p + l as
///                                 pair; what follows them is overwritten
///   addSum(sum, row)              sum[c] += row[c],  c < 8
///   largest(v)                    over lanes
///
/// The same bits for any width: what lanes compute is one pair's alone, and sums are added up pair
/// by pair in list order. Everything is a template over Lanes, which is another type for every
/// instruction set: code compiled for a newer processor cannot be linked into the path of an older.
template <class Lanes, NormalLaw law, RollingLaw rolling>
class ContactPass {
    using Number = typename Lanes::Number;
    using Real = typename Lanes::Real;
    using Record = GrainRecord<Number>;
    using History = PairHistory<Number>;
    static constexpr std::uint32_t kWidth = Lanes::width;
    static constexpr std::uint32_t kAllLanes = (1u << kWidth) - 1u;

    /// Partners in other chunks lie anywhere: they are asked for so many pairs ahead.
    static constexpr std::uint32_t kAhead = 32;
    /// Partners in the chunk lie a little ahead of the grain, so all records are asked for in
    /// order: so many at first, then as many per block as a block of pairs gets through.
    static constexpr std::uint32_t kAheadFirst = 384, kAheadMore = 128;
    static_assert(kWidth <= kMaxLanes);

    // sx, sy, sz, qx and, overlapping so as to stay inside, sz, qx, qy, qz.
    static constexpr std::size_t kTailRow = offsetof(History, sz) / sizeof(Number);
    static_assert(kTailRow == 2 && sizeof(History) == 6 * sizeof(Number));

public:
    static void run(ContactWork<Number>& work)
    {
        ContactPass pass(work);
        work.wakeCount = 0;
        pass.template sumPairs<false>();
        pass.template sumPairs<true>();
        work.deepest = Lanes::largest(pass.deepest_);
    }

private:
    explicit ContactPass(ContactWork<Number>& work)
        : work_(work), numbers_(*work.law), dt_(work.dt), deepest_(Number(0))
    {
    }

    template <bool foreign>
    [[gnu::flatten]] void sumPairs()
    {
        const std::uint32_t count = foreign ? work_.foreignCount : work_.ownCount;
        std::uint32_t waiting = 0;
        for (std::uint32_t begin = 0; begin < count; begin += kPairBlock) {
            const std::uint32_t end = count - begin < kPairBlock ? count : begin + kPairBlock;
            if constexpr (!foreign) {
                prefetchOwn(begin == 0 ? kAheadFirst : kAheadMore);
            }
            waiting = findTouching<foreign>(begin, end, waiting);
            std::uint32_t done = 0;
            for (; done + kWidth <= waiting; done += kWidth) {
                evaluate<foreign>(done, kWidth);
            }
            for (std::uint32_t k = done; k < waiting; ++k) {
                copyTouching(k, k - done);
            }
            waiting -= done;
        }
        if (waiting > 0) {
            // Idle lanes repeat the last pair and are not added.
            for (std::uint32_t k = waiting; k < kWidth; ++k) {
                copyTouching(waiting - 1, k);
            }
            evaluate<foreign>(0, waiting);
        }
    }

    void prefetchOwn(std::uint32_t more)
    {
        for (; more > 0 && prefetched_ < kChunkSize; --more, ++prefetched_) {
            __builtin_prefetch(work_.grains + prefetched_);
        }
    }

    void copyTouching(std::uint32_t from, std::uint32_t to)
    {
        TouchingPairs<Number>& t = *work_.touching;
        t.x[to] = t.x[from], t.y[to] = t.y[from], t.z[to] = t.z[from];
        t.packed[to] = t.packed[from], t.pair[to] = t.pair[from];
    }

    const Record* recordAt(std::uint32_t offset) const
    {
        return reinterpret_cast<const Record*>(reinterpret_cast<const char*>(work_.grains) +
                                               offset * (sizeof(Record) >> slot_offset::kShift));
    }

    ContactSum<Number>& sumAt(std::uint32_t offset) const
    {
        constexpr std::size_t kUnit = std::size_t{1} << slot_offset::kShift;
        return *reinterpret_cast<ContactSum<Number>*>(reinterpret_cast<char*>(work_.sums) +
                                                      offset / (kUnit / sizeof(ContactSum<Number>)));
    }

    /// Of a listed pair; slot[k] is read for foreign pairs only.
    template <bool foreign>
    static std::uint32_t grainOffset(std::uint32_t packed, const std::uint16_t* slot,
                                     std::uint32_t k)
    {
        return foreign ? slot[k] : own_pair::lowerOffset(packed);
    }

    template <bool foreign>
    const Record* partnerOf(std::uint32_t packed) const
    {
        return foreign ? work_.source[partner::sourceOf(packed)] + partner::indexOf(packed)
                       : recordAt(own_pair::higherOffset(packed));
    }

    /// Appends the pairs of [begin, end) that overlap to the `waiting` ones, without a branch on
    /// whether they do. Springs of a contact start from zero; the live bits are written only when
    /// they change.
    template <bool foreign>
    std::uint32_t findTouching(std::uint32_t begin, std::uint32_t end, std::uint32_t waiting)
    {
        const std::uint32_t* const list = foreign ? work_.foreign : work_.own;
        TouchingPairs<Number>& out = *work_.touching;
        for (std::uint32_t p = begin; p < end; p += kWidth) {
            const std::uint32_t* packed = list + p;
            const std::uint16_t* slot = foreign ? work_.foreignSlot + p : nullptr;
            std::uint32_t packedTail[kWidth];
            std::uint16_t slotTail[kWidth];
            if (kWidth > 1 && end - p < kWidth) [[unlikely]] {
                for (std::uint32_t l = 0; l < kWidth; ++l) {
                    const std::uint32_t k = p + l < end ? l : end - 1 - p;
                    packedTail[l] = packed[k];
                    slotTail[l] = foreign ? slot[k] : std::uint16_t(0);
                }
                packed = packedTail;
                slot = slotTail;
            }
            prefetchSprings<foreign>(p);
            if (foreign && p + kAhead + kWidth <= end) {
                for (std::uint32_t l = 0; l < kWidth; ++l) {
                    __builtin_prefetch(partnerOf<foreign>(list[p + kAhead + l]));
                }
            }
            Vec<Real> apart;
            Real radii;
            const auto lane = [](std::size_t l) { return static_cast<std::uint32_t>(l); };
            Lanes::subtract(
                [&](std::size_t l) {
                    return recordAt(grainOffset<foreign>(packed[l], slot, lane(l)));
                },
                [&](std::size_t l) { return partnerOf<foreign>(packed[l]); }, apart, radii);
            const Real squared = dot(apart, apart);
            // A position that is no number counts as touching, so that it spreads and is noticed.
            const auto touches = (!(squared >= radii * radii)) & (squared != Real(0));
            const std::uint32_t inside = end - p < kWidth ? (1u << (end - p)) - 1u : kAllLanes;
            const std::uint32_t touching = Lanes::bitsOf(touches) & inside;

            Lanes::append(touches, apart, packed, p, out, waiting);
            waiting += static_cast<std::uint32_t>(__builtin_popcount(touching));
            static_assert(LiveBits::kBits % kWidth == 0, "bits of all lanes stand in one word");
            std::uint32_t& live =
                (foreign ? work_.foreignLive : work_.ownLive)[p / LiveBits::kBits];
            const std::uint32_t changed =
                (touching ^ live >> p % LiveBits::kBits) & inside;
            if (changed != 0) [[unlikely]] {
                live ^= changed << p % LiveBits::kBits;
                clearSprings<foreign>(p, changed);
            }
        }
        return waiting;
    }

    /// Springs are gone through in order, but with gaps, which hardware prefetch dislikes.
    template <bool foreign>
    void prefetchSprings(std::uint32_t p)
    {
        constexpr std::uintptr_t kLine = 64, kBytesAhead = 4096;
        const auto from = reinterpret_cast<std::uintptr_t>(
                              (foreign ? work_.foreignHistory : work_.ownHistory) + p)
                          + kBytesAhead;
        for (std::uintptr_t b = 0; b < kWidth * sizeof(History); b += kLine) {
            __builtin_prefetch(reinterpret_cast<const void*>(from + b), 1);
        }
    }

    template <bool foreign>
    [[gnu::noinline]] void clearSprings(std::uint32_t first, std::uint32_t pairs)
    {
        for (; pairs != 0; pairs &= pairs - 1) {
            const std::uint32_t p = first + static_cast<std::uint32_t>(__builtin_ctz(pairs));
            (foreign ? work_.foreignHistory : work_.ownHistory)[p] = {};
        }
    }

    /// Evaluates kWidth touching pairs and adds the first `count`.
    template <bool foreign>
    void evaluate(std::uint32_t first, std::uint32_t count)
    {
        const TouchingPairs<Number>& touching = *work_.touching;
        History* const history = foreign ? work_.foreignHistory : work_.ownHistory;
        const auto grainAt = [&](std::size_t l) {
            return grainOffset<foreign>(touching.packed[first + l], work_.foreignSlot,
                                        touching.pair[first + l]);
        };
        const auto grain = [&](std::size_t l) { return recordAt(grainAt(l)); };
        const auto partner = [&](std::size_t l) {
            return partnerOf<foreign>(touching.packed[first + l]);
        };
        const auto springRow = [&](std::size_t l) {
            return reinterpret_cast<Number*>(history + touching.pair[first + l]);
        };
        const Vec<Real> apart = {Lanes::load(touching.x + first), Lanes::load(touching.y + first),
                                 Lanes::load(touching.z + first)};
        const ContactSide<Real> a = RecordRows<Lanes>::gather(grain);
        const ContactSide<Real> b = RecordRows<Lanes>::gather(partner);
        ContactSprings<Real> springs;
        Real v[4];
        Lanes::gatherRows(springRow, 0, v);
        springs.tangential = {v[0], v[1], v[2]};
        if constexpr (rolling != RollingLaw::none) {
            springs.rolling.x = v[3];
            Lanes::gatherRows(springRow, kTailRow, v);
            springs.rolling.y = v[2], springs.rolling.z = v[3];
        }

        const ContactGeometry<Real> at = measureContact(apart, a.radius, b.radius);
        const ContactForce<Real> f = evaluateContact<law, rolling>(numbers_, at, a, b, dt_, springs);
        using std::max;
        deepest_ = max(deepest_, at.overlap);

        const Vec<Real>& s = springs.tangential;
        const Vec<Real>& q = springs.rolling;
        Lanes::scatterRows({s.x, s.y, s.z, q.x}, springRow, 0);
        if constexpr (rolling != RollingLaw::none) {
            Lanes::scatterRows({s.z, q.x, q.y, q.z}, springRow, kTailRow);
        }

        // As they stand in ContactSum.
        alignas(64) Number own[8 * kWidth], given[8 * kWidth];
        const Real pushes = select(f.normal > Real(0), Real(1), Real(0));
        Lanes::storeSums({f.force.x, f.force.y, f.force.z, f.normal},
                         {f.torque.x, f.torque.y, f.torque.z, pushes}, own);
        if constexpr (!foreign) {
            const Vec<Real>& t = f.partnerTorque;
            Lanes::storeSums({-f.force.x, -f.force.y, -f.force.z, f.normal},
                             {t.x, t.y, t.z, pushes}, given);
        }
        const auto add = [&](std::uint32_t l) {
            const std::uint32_t row = Lanes::storedSum(l);
            Lanes::addSum(&sumAt(grainAt(l)).fx, own + row);
            if constexpr (foreign) {
                noteWake(touching.packed[first + l], *partner(l), own[row + 3]);
            } else {
                Lanes::addSum(&sumAt(own_pair::higherOffset(touching.packed[first + l])).fx,
                              given + row);
            }
        };
        if (count == kWidth) [[likely]] {
#pragma GCC unroll 16
            for (std::uint32_t l = 0; l < kWidth; ++l) {
                add(l);
            }
        } else {
            for (std::uint32_t l = 0; l < count; ++l) {
                add(l);
            }
        }
    }

    void noteWake(std::uint32_t packed, const Record& pushed, Number push)
    {
        if (partner::sourceOf(packed) == static_cast<std::uint32_t>(PartnerSource::frozen) &&
            static_cast<float>(push) > pushed.wakeForce) {
            work_.wake[work_.wakeCount++] = partner::indexOf(packed);
        }
    }

    ContactWork<Number>& work_;
    const LawNumbers<Real> numbers_;
    const Real dt_;
    Real deepest_;
    std::uint32_t prefetched_ = 0;  ///< records of the chunk
};

}  // namespace sandflow
