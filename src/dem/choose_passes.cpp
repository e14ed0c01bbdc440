#include "dem/choose_passes.h"

#include "core/errors.h"
#include "dem/find_passes.h"
#include "dem/scalar_lanes.h"
#include "dem/simd_passes.h"

#include <algorithm>

namespace sandflow {

template <>
ChunkPasses<float> choosePasses<float>(KernelTarget target, NormalLaw law, RollingLaw rolling)
{
    if (target == KernelTarget::best) {
        target = bestKernelTarget();
    }
    const std::vector<KernelTarget> available = availableKernelTargets();
    if (std::find(available.begin(), available.end(), target) == available.end()) {
        throw InputError(fmt::format("this processor or build has no {} kernel (best: {})",
                                     nameOf(target), nameOf(available.back())));
    }
    switch (target) {
    case KernelTarget::sse4: return sse4Passes()(law, rolling);
    case KernelTarget::avx2: return avx2Passes()(law, rolling);
    case KernelTarget::avx512: return avx512Passes()(law, rolling);
    case KernelTarget::scalar:
    case KernelTarget::best: break;
    }
    return findPasses<ScalarLanes<float>>(law, rolling);
}

template <>
ChunkPasses<double> choosePasses<double>(KernelTarget target, NormalLaw law, RollingLaw rolling)
{
    ChunkPasses<double> passes = findPasses<ScalarLanes<double>>(law, rolling);
    passes.findNear = choosePasses<float>(target, law, rolling).findNear;
    return passes;
}

}  // namespace sandflow
