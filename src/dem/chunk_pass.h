#pragma once

#include "dem/chunk_contacts.h"
#include "dem/law_coefficients.h"

#include <cstdint>

/// The loops that take the time, the two passes of a step over one chunk and the search for
/// partners, as plain pointers, so that they can be compiled once for every instruction set without
/// dragging the rest of the program along.
namespace sandflow {

/// Contact sums of one grain.
template <class Real>
struct alignas(8 * sizeof(Real)) ContactSum {
    Real fx, fy, fz;  ///< N
    Real load;        ///< N, sum of normal forces
    Real tx, ty, tz;  ///< N m
    Real partners;    ///< that push
};

/// So many pairs are tested for overlap before those that do are evaluated: what lies between the
/// two stays in the first-level cache. Fewer than kMaxLanes wait for the next block.
inline constexpr std::uint32_t kPairBlock = 256;
inline constexpr std::uint32_t kMaxLanes = 16;

/// Pairs found to overlap. Lanes are appended whole, so there is room for idle ones at the end.
template <class Real>
struct TouchingPairs {
    static constexpr std::uint32_t kRoom = kPairBlock + 2 * kMaxLanes;
    alignas(64) Real x[kRoom], y[kRoom], z[kRoom];   ///< m, grain minus partner
    alignas(64) std::uint32_t packed[kRoom];         ///< as listed
    alignas(64) std::uint32_t pair[kRoom];           ///< where in the list
};

template <class Real>
struct ContactWork {
    const ContactCoefficients* law;
    Real dt;                                            ///< s
    const GrainRecord<Real>* grains;                    ///< of the chunk
    const GrainRecord<Real>* source[kPartnerSources];   ///< by PartnerSource
    std::uint32_t ownCount, foreignCount;
    const std::uint32_t *own, *foreign;
    const std::uint16_t* foreignSlot;
    std::uint32_t *ownLive, *foreignLive;               ///< bit per pair, see LiveBits
    PairHistory<Real> *ownHistory, *foreignHistory;
    TouchingPairs<Real>* touching;
    ContactSum<Real>* sums;     ///< added to
    Real deepest;               ///< m, out
    std::uint32_t* wake;        ///< out: frozen partners pushed too hard; room for foreignCount
    std::uint32_t wakeCount;    ///< out
};

template <class Real>
struct MotionWork {
    double dt;                            ///< s
    double gravity[3];                    ///< m/s2
    double origin[3];                     ///< m, of the balls
    const GrainRecord<Real>* record;      ///< of the chunk
    GrainRecord<Real>* next;
    const float* ball;                    ///< x, y, z, reach [m] per grain
    const ContactSum<Real>* sums;
    std::uint32_t count;
    float fastestSquared;        ///< m2/s2, out
    std::uint16_t* left;         ///< out: slots of grains that left their balls; room for count
    std::uint32_t leftCount;     ///< out
    bool broke;                  ///< out
    std::uint32_t brokenGrain;   ///< slot within the chunk, out
};

/// Neighbouring slots [begin, end).
struct SlotRange {
    std::uint32_t begin, end;
};

struct NearWork {
    const float *x, *y, *z, *reach;  ///< m, columns of balls; see BallColumns
    const SlotRange* ranges;
    std::uint32_t rangeCount;
    float at[3], ownReach;           ///< m, the ball
    std::uint32_t* found;            ///< out: slots in order; room for all of the ranges and kMaxLanes
    std::uint32_t foundCount;        ///< out
};
using FindNear = void (*)(NearWork& work);

/// The passes compiled for one instruction set. All leave the same bits whatever the set.
template <class Real>
struct ChunkPasses {
    void (*sumContacts)(ContactWork<Real>& work);  ///< own pairs, then foreign, in list order
    void (*moveGrains)(MotionWork<Real>& work);
    FindNear findNear;
};

}  // namespace sandflow
