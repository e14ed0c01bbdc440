#include "app/environment.h"

#include "core/errors.h"
#include "dem/kernel_target.h"

#include <omp.h>
#include <unistd.h>

#include <cstdlib>

namespace sandflow {

void prepareEnvironment(char** argv)
{
    if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) {
        return;
    }
    // Long enough to bridge the gap between two steps, short enough not to hinder anybody.
    ::setenv("GOMP_SPINCOUNT", "20000", 1);
    ::execv("/proc/self/exe", argv);
    // Could not start anew (no /proc): go on as we are, only slower beside busy neighbours.
}

void useThreads(int threads)
{
    if (threads < 0 || threads > 1024) {
        throw InputError(fmt::format("--threads {}: expected 1 to 1024, or 0 for all", threads));
    }
    omp_set_num_threads(threads == 0 ? omp_get_num_procs() : threads);
}

void useKernel(const std::string& name)
{
    for (const KernelTarget target : {KernelTarget::scalar, KernelTarget::sse4, KernelTarget::avx2,
                                      KernelTarget::avx512}) {
        if (name == nameOf(target)) {
            preferKernelTarget(target);
            return;
        }
    }
    if (name != "auto") {
        throw InputError(fmt::format(
            "--simd {}: expected auto, scalar, sse4, avx2 or avx512", name));
    }
    preferKernelTarget(KernelTarget::best);
}

std::string describeVersion()
{
    return fmt::format("sandflow {} ({} kernel)", SANDFLOW_VERSION, kernelTargetName());
}

}  // namespace sandflow
