#pragma once

#include "dem/chunk_pass.h"

namespace sandflow {

/// The passes for a law, of one instruction set.
using FindPasses = ChunkPasses<float> (*)(NormalLaw law, RollingLaw rolling);

/// Null where the compiler was not given the flags that the set needs (CMakeLists.txt).
FindPasses sse4Passes();
FindPasses avx2Passes();
FindPasses avx512Passes();

}  // namespace sandflow
