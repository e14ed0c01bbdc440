#include "dem/simd_passes.h"

#include <hwy/highway.h>

#if HWY_TARGET == HWY_AVX2
#include "dem/find_passes.h"
#include "dem/simd_lanes-inl.h"
#endif

namespace sandflow {

FindPasses avx2Passes()
{
#if HWY_TARGET == HWY_AVX2
    return &findPasses<HWY_NAMESPACE::SimdLanes>;
#else
    return nullptr;
#endif
}

}  // namespace sandflow
