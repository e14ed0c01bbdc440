#pragma once

#include "dem/contact_pass.h"
#include "dem/motion_pass.h"

namespace sandflow {

/// The passes for a law, compiled without what the law does not have.
template <class Lanes>
ChunkPasses<typename Lanes::Number> findPasses(NormalLaw law, bool rolls)
{
    const auto choose = [&]<NormalLaw known>() -> ChunkPasses<typename Lanes::Number> {
        return {rolls ? &ContactPass<Lanes, known, true>::run
                      : &ContactPass<Lanes, known, false>::run,
                &MotionPass<Lanes>::run};
    };
    switch (law) {
    case NormalLaw::linear: return choose.template operator()<NormalLaw::linear>();
    case NormalLaw::hertz: return choose.template operator()<NormalLaw::hertz>();
    case NormalLaw::bellYuMucha: break;
    }
    return choose.template operator()<NormalLaw::bellYuMucha>();
}

}  // namespace sandflow
