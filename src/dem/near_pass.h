#pragma once

#include "core/small_vec.h"
#include "dem/chunk_pass.h"

#include <cstdint>

namespace sandflow {

/// Which balls of some ranges may meet one ball: the first sieve of the search for contacts. Floats,
/// and a reach that is a little wide: who passes is judged exactly afterwards. Lanes as in
/// ContactPass; besides
///
///   firstLanes(n)                 mask of the first n lanes, of all if there are no more
///   appendSlots(mask, slot, out)  slot + l of the lanes of the mask to out[0], out[1], ...; what
///                                 follows them is overwritten
template <class Lanes>
struct NearPass {
    using Real = typename Lanes::Real;

    static void run(NearWork& work)
    {
        const Vec<Real> at{Real(work.at[0]), Real(work.at[1]), Real(work.at[2])};
        const Real ownReach(work.ownReach);
        std::uint32_t found = 0;
        for (std::uint32_t r = 0; r < work.rangeCount; ++r) {
            const std::uint32_t end = work.ranges[r].end;
            for (std::uint32_t j = work.ranges[r].begin; j < end; j += Lanes::width) {
                const Vec<Real> apart = Vec<Real>{Lanes::load(work.x + j), Lanes::load(work.y + j),
                                                  Lanes::load(work.z + j)} - at;
                const Real limit = Lanes::load(work.reach + j) + ownReach;
                const auto near =
                    (dot(apart, apart) < limit * limit) & Lanes::firstLanes(end - j);
                Lanes::appendSlots(near, j, work.found + found);
                found += static_cast<std::uint32_t>(__builtin_popcount(Lanes::bitsOf(near)));
            }
        }
        work.foundCount = found;
    }
};

}  // namespace sandflow
