// Included by one source file per instruction set, which its compiler flags choose.
#pragma once

#include "core/small_vec.h"
#include "dem/chunk_pass.h"
#include "dem/lane_math.h"

#include <hwy/highway.h>

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace sandflow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes32 = hn::CappedTag<float, 16>;
using Lanes64 = hn::Repartition<double, Lanes32>;
inline constexpr std::uint32_t kLaneCount = HWY_MIN(16, HWY_LANES(float));

/// Which lanes: what a comparison of LaneFloat gives.
struct LaneMask {
    hn::Mask<Lanes32> m;
    friend HWY_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
    friend HWY_INLINE LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
};

/// As many floats as the instruction set works on at once; every operation is IEEE's, lane by lane,
/// and nothing is fused.
struct LaneFloat {
    using Number = float;
    hn::Vec<Lanes32> v;

    HWY_INLINE LaneFloat() : v(hn::Zero(Lanes32())) {}
    HWY_INLINE LaneFloat(hn::Vec<Lanes32> lanes) : v(lanes) {}
    template <class T>
        requires std::integral<T> || std::floating_point<T>
    explicit HWY_INLINE LaneFloat(T number) : v(hn::Set(Lanes32(), static_cast<float>(number)))
    {
    }

    HWY_INLINE LaneFloat& operator+=(LaneFloat b) { return v = hn::Add(v, b.v), *this; }
    HWY_INLINE LaneFloat& operator-=(LaneFloat b) { return v = hn::Sub(v, b.v), *this; }
    HWY_INLINE LaneFloat& operator*=(LaneFloat b) { return v = hn::Mul(v, b.v), *this; }
    friend HWY_INLINE LaneFloat operator-(LaneFloat a) { return hn::Neg(a.v); }
    friend HWY_INLINE LaneFloat operator+(LaneFloat a, LaneFloat b) { return hn::Add(a.v, b.v); }
    friend HWY_INLINE LaneFloat operator-(LaneFloat a, LaneFloat b) { return hn::Sub(a.v, b.v); }
    friend HWY_INLINE LaneFloat operator*(LaneFloat a, LaneFloat b) { return hn::Mul(a.v, b.v); }
    friend HWY_INLINE LaneFloat operator/(LaneFloat a, LaneFloat b) { return hn::Div(a.v, b.v); }
    friend HWY_INLINE LaneMask operator<(LaneFloat a, LaneFloat b) { return {hn::Lt(a.v, b.v)}; }
    friend HWY_INLINE LaneMask operator>(LaneFloat a, LaneFloat b) { return {hn::Gt(a.v, b.v)}; }
    friend HWY_INLINE LaneMask operator>=(LaneFloat a, LaneFloat b) { return {hn::Ge(a.v, b.v)}; }
    friend HWY_INLINE LaneMask operator!=(LaneFloat a, LaneFloat b) { return {hn::Ne(a.v, b.v)}; }
    friend HWY_INLINE LaneFloat sqrt(LaneFloat a) { return hn::Sqrt(a.v); }
    friend HWY_INLINE LaneFloat inverseRoot(LaneFloat x)
    {
        const hn::RebindToUnsigned<Lanes32> d;
        const auto half = hn::ShiftRight<1>(hn::BitCast(d, x.v));
        const LaneFloat estimate =
            hn::BitCast(Lanes32(), hn::Sub(hn::Set(d, root_estimate::kBits), half));
        return root_estimate::refine(estimate, x);
    }
    friend HWY_INLINE LaneFloat root(LaneFloat x) { return x * inverseRoot(x); }
    friend HWY_INLINE LaneFloat select(LaneMask c, LaneFloat yes, LaneFloat no)
    {
        return hn::IfThenElse(c.m, yes.v, no.v);
    }
    /// b if b > a, else a: as std::max also for zeros of either sign and what is not a number.
    friend HWY_INLINE LaneFloat max(LaneFloat a, LaneFloat b) { return hn::Max(b.v, a.v); }
};

HWY_INLINE std::uint32_t bitsOf(LaneMask mask)
{
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Lanes32(), mask.m, bytes);
    return bytes[0] | std::uint32_t(bytes[1]) << 8;
}

/// For every mask of four or eight lanes, which lanes come first. (Highway packs lanes too, but
/// from a table that it copies to the stack every time.)
template <std::size_t lanes>
struct PackTable {
    alignas(64) std::uint32_t lane[1u << lanes][lanes] = {};  ///< of the lane wanted at this place
    alignas(64) std::uint8_t byte[1u << lanes][4 * lanes] = {};

    constexpr PackTable()
    {
        for (std::uint32_t mask = 0; mask < 1u << lanes; ++mask) {
            std::uint32_t place = 0;
            for (std::uint32_t l = 0; l < lanes; ++l) {
                if (mask >> l & 1u) {
                    lane[mask][place++] = l;
                }
            }
            for (std::uint32_t b = 0; b < 4 * lanes; ++b) {
                byte[mask][b] = static_cast<std::uint8_t>(4 * lane[mask][b / 4] + b % 4);
            }
        }
    }
};

/// Puts the lanes of a mask side by side.
class LanePacker {
public:
#if HWY_TARGET == HWY_AVX3
    explicit HWY_INLINE LanePacker(LaneMask mask) : mask_(mask) {}
    HWY_INLINE hn::Vec<Lanes32> operator()(hn::Vec<Lanes32> v) const
    {
        return hn::Compress(v, mask_.m);
    }

private:
    LaneMask mask_;
#elif HWY_TARGET == HWY_AVX2
    explicit HWY_INLINE LanePacker(LaneMask mask)
        : order_(hn::Load(hn::RebindToUnsigned<Lanes32>(), kTable.lane[bitsOf(mask)]))
    {
    }
    HWY_INLINE hn::Vec<Lanes32> operator()(hn::Vec<Lanes32> v) const
    {
        return hn::TableLookupLanes(v, hn::IndicesFromVec(Lanes32(), order_));
    }

private:
    static constexpr PackTable<8> kTable{};
    hn::Vec<hn::RebindToUnsigned<Lanes32>> order_;
#else
    explicit HWY_INLINE LanePacker(LaneMask mask)
        : order_(hn::Load(hn::Repartition<std::uint8_t, Lanes32>(), kTable.byte[bitsOf(mask)]))
    {
    }
    HWY_INLINE hn::Vec<Lanes32> operator()(hn::Vec<Lanes32> v) const
    {
        const hn::Repartition<std::uint8_t, Lanes32> bytes;
        return hn::BitCast(Lanes32(), hn::TableLookupBytes(hn::BitCast(bytes, v), order_));
    }

private:
    static constexpr PackTable<4> kTable{};
    hn::Vec<hn::Repartition<std::uint8_t, Lanes32>> order_;
#endif
};

/// Lanes of ContactPass.
struct SimdLanes {
    using Number = float;
    using Real = LaneFloat;
    static constexpr std::uint32_t width = kLaneCount;

    struct Row {
        LaneFloat v[4];
    };

    template <class RowOf>
    static HWY_INLINE void gatherRows(RowOf row, std::size_t k, LaneFloat (&v)[4])
    {
        // Block b of part m is the row of lane 4b + m; blocks are then turned four by four.
        transpose(collect<0>(Lanes32(), row, k), collect<1>(Lanes32(), row, k),
                  collect<2>(Lanes32(), row, k), collect<3>(Lanes32(), row, k), v);
    }
    template <class RowOf>
    static HWY_INLINE void scatterRows(const Row& r, RowOf row, std::size_t k)
    {
        LaneFloat part[4];
        transpose(r.v[0].v, r.v[1].v, r.v[2].v, r.v[3].v, part);
        spread<0>(Lanes32(), part[0].v, row, k);
        spread<1>(Lanes32(), part[1].v, row, k);
        spread<2>(Lanes32(), part[2].v, row, k);
        spread<3>(Lanes32(), part[3].v, row, k);
    }
    template <class RecordOf, class PartnerOf>
    static HWY_INLINE void subtract(RecordOf a, PartnerOf b, Vec<LaneFloat>& apart,
                                    LaneFloat& radii)
    {
        const auto low = subtractHalf<0>(a, b);
        const auto high = subtractHalf<kLaneCount / 2>(a, b);
        apart = {narrow(high.x, low.x), narrow(high.y, low.y), narrow(high.z, low.z)};
        radii = hn::ConcatEven(Lanes32(), high.radiiAndMasses, low.radiiAndMasses);
    }
    template <class RecordOf, class NextOf>
    static HWY_INLINE Vec<LaneFloat> advance(RecordOf record, NextOf next, double dt,
                                             const Vec<LaneFloat>& v, const double (&origin)[3])
    {
        const hn::Rebind<float, Lanes64> half;
        const auto low =
            advanceHalf<0>(record, next, dt, hn::LowerHalf(half, v.x.v),
                           hn::LowerHalf(half, v.y.v), hn::LowerHalf(half, v.z.v), origin);
        const auto high = advanceHalf<kLaneCount / 2>(
            record, next, dt, hn::UpperHalf(half, v.x.v), hn::UpperHalf(half, v.y.v),
            hn::UpperHalf(half, v.z.v), origin);
        return {narrow(high.x, low.x), narrow(high.y, low.y), narrow(high.z, low.z)};
    }
    static HWY_INLINE LaneFloat load(const float* p) { return hn::LoadU(Lanes32(), p); }
    static HWY_INLINE std::uint32_t bitsOf(LaneMask mask)
    {
        return HWY_NAMESPACE::bitsOf(mask);
    }
    static HWY_INLINE LaneMask firstLanes(std::uint32_t n)
    {
        return {hn::FirstN(Lanes32(), n)};
    }
    static HWY_INLINE void appendSlots(LaneMask mask, std::uint32_t slot, std::uint32_t* out)
    {
        const Lanes32 d;
        const hn::RebindToUnsigned<Lanes32> du;
        const LanePacker pack(mask);
        hn::StoreU(hn::BitCast(du, pack(hn::BitCast(d, hn::Iota(du, slot)))), du, out);
    }
    static HWY_INLINE void append(LaneMask mask, const Vec<LaneFloat>& apart,
                                  const std::uint32_t* packed, std::uint32_t p,
                                  TouchingPairs<float>& out, std::uint32_t at)
    {
        const Lanes32 d;
        const hn::RebindToUnsigned<Lanes32> du;
        const LanePacker pack(mask);
        hn::StoreU(pack(apart.x.v), d, out.x + at);
        hn::StoreU(pack(apart.y.v), d, out.y + at);
        hn::StoreU(pack(apart.z.v), d, out.z + at);
        hn::StoreU(hn::BitCast(du, pack(hn::BitCast(d, hn::LoadU(du, packed)))), du,
                   out.packed + at);
        hn::StoreU(hn::BitCast(du, pack(hn::BitCast(d, hn::Iota(du, p)))), du, out.pair + at);
    }
    static HWY_INLINE void storeSums(const Row& r, const Row& q, float* p)
    {
        const Lanes32 d;
        LaneFloat first[4], second[4];
        transpose(r.v[0].v, r.v[1].v, r.v[2].v, r.v[3].v, first);
        transpose(q.v[0].v, q.v[1].v, q.v[2].v, q.v[3].v, second);
        for (std::size_t m = 0; m < 4; ++m) {
            float* const at = p + 2 * m * kLaneCount;
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2
            // Blocks of even lanes with theirs, then those of odd ones.
            hn::Store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(second[m].v), first[m].v), d, at);
            hn::Store(hn::OddEvenBlocks(second[m].v, hn::SwapAdjacentBlocks(first[m].v)), d,
                      at + kLaneCount);
#else
            hn::Store(first[m].v, d, at);
            hn::Store(second[m].v, d, at + kLaneCount);
#endif
        }
    }
    static HWY_INLINE std::uint32_t storedSum(std::uint32_t lane)
    {
        const std::uint32_t block = lane / 4;
        return lane % 4 * 2 * kLaneCount + block % 2 * kLaneCount + block / 2 * 8;
    }
    static HWY_INLINE void addSum(float* sum, const float* row)
    {
        constexpr std::uint32_t step = HWY_MIN(8, kLaneCount);
        const hn::FixedTag<float, step> d;
        for (std::uint32_t c = 0; c < 8; c += step) {
            hn::Store(hn::Add(hn::Load(d, sum + c), hn::Load(d, row + c)), d, sum + c);
        }
    }
    static HWY_INLINE float largest(LaneFloat a)
    {
        return hn::GetLane(hn::MaxOfLanes(Lanes32(), a.v));
    }

private:
    /// Half as many lanes, in double: differences of positions. Sums of radius and 1/m in turn.
    struct HalfApart {
        hn::Vec<Lanes64> x, y, z;
        hn::Vec<Lanes32> radiiAndMasses;
    };

    template <std::size_t first, class RecordOf, class PartnerOf>
    static HWY_INLINE HalfApart subtractHalf(RecordOf a, PartnerOf b)
    {
        const Lanes64 d2;
        const Lanes32 d;
        const auto xyEven = hn::Sub(collectEven<first>(d2, a, 0), collectEven<first>(d2, b, 0));
        const auto xyOdd =
            hn::Sub(collectEven<first + 1>(d2, a, 0), collectEven<first + 1>(d2, b, 0));
        // z and, in the upper half, two floats.
        const auto aEven = collectEven<first>(d2, a, 2), aOdd = collectEven<first + 1>(d2, a, 2);
        const auto bEven = collectEven<first>(d2, b, 2), bOdd = collectEven<first + 1>(d2, b, 2);
        return {hn::InterleaveLower(d2, xyEven, xyOdd), hn::InterleaveUpper(d2, xyEven, xyOdd),
                hn::Sub(hn::InterleaveLower(d2, aEven, aOdd), hn::InterleaveLower(d2, bEven, bOdd)),
                hn::Add(hn::BitCast(d, hn::InterleaveUpper(d2, aEven, aOdd)),
                        hn::BitCast(d, hn::InterleaveUpper(d2, bEven, bOdd)))};
    }

    struct HalfPlace {
        hn::Vec<Lanes64> x, y, z;
    };

    template <std::size_t first, class RecordOf, class NextOf, class HalfFloat>
    static HWY_INLINE HalfPlace advanceHalf(RecordOf record, NextOf next, double dt, HalfFloat vx,
                                            HalfFloat vy, HalfFloat vz, const double (&origin)[3])
    {
        const Lanes64 d2;
        const auto step = hn::Set(d2, dt);
        const auto xyEven = collectEven<first>(d2, record, 0);
        const auto xyOdd = collectEven<first + 1>(d2, record, 0);
        const auto zEven = collectEven<first>(d2, record, 2);
        const auto zOdd = collectEven<first + 1>(d2, record, 2);
        const auto moved = [&](auto at, HalfFloat v) HWY_ATTR {
            return hn::Add(at, hn::Mul(step, hn::PromoteTo(d2, v)));
        };
        const auto x = moved(hn::InterleaveLower(d2, xyEven, xyOdd), vx);
        const auto y = moved(hn::InterleaveUpper(d2, xyEven, xyOdd), vy);
        const auto z = moved(hn::InterleaveLower(d2, zEven, zOdd), vz);
        // Beside z lie radius and 1/m: they are passed on.
        const auto rest = hn::InterleaveUpper(d2, zEven, zOdd);
        spreadEven<first>(d2, hn::InterleaveLower(d2, x, y), next, 0);
        spreadEven<first + 1>(d2, hn::InterleaveUpper(d2, x, y), next, 0);
        spreadEven<first>(d2, hn::InterleaveLower(d2, z, rest), next, 2);
        spreadEven<first + 1>(d2, hn::InterleaveUpper(d2, z, rest), next, 2);
        return {hn::Sub(x, hn::Set(d2, origin[0])), hn::Sub(y, hn::Set(d2, origin[1])),
                hn::Sub(z, hn::Set(d2, origin[2]))};
    }

    template <std::size_t first, class Tag, class RecordOf>
    static HWY_INLINE void spreadEven(Tag d, hn::Vec<Tag> part, RecordOf record, std::size_t k)
    {
        constexpr std::size_t lanes = HWY_MIN(8, hn::MaxLanes(Tag()));
        if constexpr (lanes == 2) {
            hn::StoreU(part, d, &record(first)->x + k);
        } else {
            const hn::Half<Tag> half;
            spreadEven<first>(half, hn::LowerHalf(half, part), record, k);
            spreadEven<first + lanes / 2>(half, hn::UpperHalf(half, part), record, k);
        }
    }

    /// Two doubles from the k-th on of the records of lanes first, first + 2, ... side by side.
    template <std::size_t first, class Tag, class RecordOf>
    static HWY_INLINE hn::Vec<Tag> collectEven(Tag d, RecordOf record, std::size_t k)
    {
        constexpr std::size_t lanes = HWY_MIN(8, hn::MaxLanes(Tag()));
        if constexpr (lanes == 2) {
            return hn::LoadU(d, &record(first)->x + k);
        } else {
            const hn::Half<Tag> half;
            return hn::Combine(d, collectEven<first + lanes / 2>(half, record, k),
                               collectEven<first>(half, record, k));
        }
    }

    static HWY_INLINE LaneFloat narrow(hn::Vec<Lanes64> high, hn::Vec<Lanes64> low)
    {
        const hn::Rebind<float, Lanes64> half;
        return hn::Combine(Lanes32(), hn::DemoteTo(half, high), hn::DemoteTo(half, low));
    }

    /// Rows of lanes m, m + 4, m + 8, ... side by side.
    template <std::size_t m, class Tag, class RowOf>
    static HWY_INLINE hn::Vec<Tag> collect(Tag d, RowOf row, std::size_t k)
    {
        constexpr std::size_t lanes = HWY_MIN(16, hn::MaxLanes(Tag()));
        if constexpr (lanes == 4) {
            return hn::LoadU(d, row(m) + k);
        } else {
            const hn::Half<Tag> half;
            return hn::Combine(d, collect<m + lanes / 2>(half, row, k), collect<m>(half, row, k));
        }
    }

    template <std::size_t m, class Tag, class RowOf>
    static HWY_INLINE void spread(Tag d, hn::Vec<Tag> part, RowOf row, std::size_t k)
    {
        constexpr std::size_t lanes = HWY_MIN(16, hn::MaxLanes(Tag()));
        if constexpr (lanes == 4) {
            hn::StoreU(part, d, row(m) + k);
        } else {
            const hn::Half<Tag> half;
            spread<m>(half, hn::LowerHalf(half, part), row, k);
            spread<m + lanes / 2>(half, hn::UpperHalf(half, part), row, k);
        }
    }

    static HWY_INLINE void transpose(hn::Vec<Lanes32> a, hn::Vec<Lanes32> b, hn::Vec<Lanes32> c,
                                     hn::Vec<Lanes32> e, LaneFloat (&v)[4])
    {
        const Lanes32 d;
        const Lanes64 d2;
        const auto ab0 = hn::BitCast(d2, hn::InterleaveLower(d, a, b));
        const auto ab2 = hn::BitCast(d2, hn::InterleaveUpper(d, a, b));
        const auto ce0 = hn::BitCast(d2, hn::InterleaveLower(d, c, e));
        const auto ce2 = hn::BitCast(d2, hn::InterleaveUpper(d, c, e));
        v[0].v = hn::BitCast(d, hn::InterleaveLower(d2, ab0, ce0));
        v[1].v = hn::BitCast(d, hn::InterleaveUpper(d2, ab0, ce0));
        v[2].v = hn::BitCast(d, hn::InterleaveLower(d2, ab2, ce2));
        v[3].v = hn::BitCast(d, hn::InterleaveUpper(d2, ab2, ce2));
    }
};

}  // namespace sandflow::HWY_NAMESPACE
