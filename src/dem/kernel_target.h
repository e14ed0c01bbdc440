#pragma once

#include <vector>

namespace sandflow {

/// Which instructions the force kernel uses. Results do not depend on it, to the last bit.
enum class KernelTarget { scalar, sse4, avx2, avx512, best };

/// Those that this build has and this processor can run, slowest first; scalar always.
std::vector<KernelTarget> availableKernelTargets();

/// What KernelTarget::best stands for: the fastest of them, unless another was preferred.
KernelTarget bestKernelTarget();

/// Makes `best` stand for this one from now on, in the whole program: to try what an older processor
/// would do, or to look for a fault. Throws InputError if it cannot run here.
void preferKernelTarget(KernelTarget target);

/// "scalar", "sse4", "avx2" or "avx512"; best goes by the name of what it stands for.
const char* nameOf(KernelTarget target);

/// What KernelTarget::best stands for, for reports.
inline const char* kernelTargetName()
{
    return nameOf(KernelTarget::best);
}

}  // namespace sandflow
