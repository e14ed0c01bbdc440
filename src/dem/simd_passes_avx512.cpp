#include "dem/simd_passes.h"

#include <hwy/highway.h>

#if HWY_TARGET == HWY_AVX3
#include "dem/find_passes.h"
#include "dem/simd_lanes-inl.h"
#endif

namespace sandflow {

FindPasses avx512Passes()
{
#if HWY_TARGET == HWY_AVX3
    return &findPasses<HWY_NAMESPACE::SimdLanes>;
#else
    return nullptr;
#endif
}

}  // namespace sandflow
