#include "dem/kernel_target.h"

#include "dem/simd_passes.h"

#include <hwy/targets.h>

namespace sandflow {

std::vector<KernelTarget> availableKernelTargets()
{
    std::vector<KernelTarget> targets = {KernelTarget::scalar};
    const auto offer = [&](KernelTarget target, FindPasses passes, auto bit) {
        if (passes && (hwy::SupportedTargets() & bit)) {
            targets.push_back(target);
        }
    };
    offer(KernelTarget::sse4, sse4Passes(), HWY_SSE4);
    offer(KernelTarget::avx2, avx2Passes(), HWY_AVX2);
    offer(KernelTarget::avx512, avx512Passes(), HWY_AVX3);
    return targets;
}

const char* nameOf(KernelTarget target)
{
    switch (target) {
    case KernelTarget::scalar: return "scalar";
    case KernelTarget::sse4: return "sse4";
    case KernelTarget::avx2: return "avx2";
    case KernelTarget::avx512: return "avx512";
    case KernelTarget::best: break;
    }
    return nameOf(availableKernelTargets().back());
}

}  // namespace sandflow
