#pragma once

#include "dem/contact_pass.h"
#include "dem/motion_pass.h"
#include "dem/near_pass.h"

#include <type_traits>

namespace sandflow {

/// The passes for a law, compiled without what the law does not have. Lanes of double have no
/// findNear.
template <class Lanes>
ChunkPasses<typename Lanes::Number> findPasses(NormalLaw law, RollingLaw rolling)
{
    using Number = typename Lanes::Number;
    FindNear findNear = nullptr;
    if constexpr (std::is_same_v<Number, float>) {
        findNear = &NearPass<Lanes>::run;
    }
    return chooseLaw(law, rolling, [&]<NormalLaw knownLaw, RollingLaw knownRolling>() {
        return ChunkPasses<Number>{&ContactPass<Lanes, knownLaw, knownRolling>::run,
                                   &MotionPass<Lanes>::run, findNear};
    });
}

}  // namespace sandflow
