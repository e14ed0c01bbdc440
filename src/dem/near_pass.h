#pragma once

#include "core/small_vec.h"
#include "dem/chunk_pass.h"

#include <cstdint>

namespace sandflow {

/// Which balls of some ranges may meet one ball: the first sieve of the search for contacts. Floats,
/// and a reach that is a little wide: who passes is judged exactly afterwards. Lanes as in
/// ContactPass.
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
                std::uint32_t near = Lanes::bitsOf(dot(apart, apart) < limit * limit);
                if (end - j < Lanes::width) {
                    near &= (1u << (end - j)) - 1u;
                }
                for (; near != 0; near &= near - 1) {
                    work.found[found++] = j + static_cast<std::uint32_t>(__builtin_ctz(near));
                }
            }
        }
        work.foundCount = found;
    }
};

}  // namespace sandflow
