#pragma once

#include "dem/chunk_pass.h"
#include "dem/kernel_target.h"

namespace sandflow {

/// The passes for this law, compiled for `target`. In double every target is the scalar one, but for
/// findNear, which is float always. Throws InputError for a target that this processor cannot run.
template <class Real>
ChunkPasses<Real> choosePasses(KernelTarget target, NormalLaw law, RollingLaw rolling);
template <>
ChunkPasses<float> choosePasses<float>(KernelTarget target, NormalLaw law, RollingLaw rolling);
template <>
ChunkPasses<double> choosePasses<double>(KernelTarget target, NormalLaw law, RollingLaw rolling);

}  // namespace sandflow
