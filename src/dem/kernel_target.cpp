#include "dem/kernel_target.h"

#include "core/errors.h"
#include "dem/simd_passes.h"

#include <algorithm>
#include <hwy/targets.h>

namespace sandflow {
namespace {

KernelTarget preferred = KernelTarget::best;

}  // namespace

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

KernelTarget bestKernelTarget()
{
    return preferred == KernelTarget::best ? availableKernelTargets().back() : preferred;
}

void preferKernelTarget(KernelTarget target)
{
    const std::vector<KernelTarget> available = availableKernelTargets();
    if (target != KernelTarget::best &&
        std::find(available.begin(), available.end(), target) == available.end()) {
        throw InputError(fmt::format("this processor or build has no {} kernel (best: {})",
                                     nameOf(target), nameOf(available.back())));
    }
    preferred = target;
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
    return nameOf(bestKernelTarget());
}

}  // namespace sandflow
