#pragma once

#include <string>

namespace sandflow {

/// Sets what must stand in the environment before the OpenMP runtime starts, by starting the
/// program anew once: waiting threads sleep after a short spin instead of burning the processor
/// time that a neighbour needs (a busy neighbour otherwise costs up to 13x). Anything the user set
/// himself is kept.
void prepareEnvironment(char** argv);

/// Uses that many threads from now on; 0 means all processors. Throws InputError beyond 1024.
void useThreads(int threads);

/// Takes the kernel of that name: "auto", "scalar", "sse4", "avx2" or "avx512". Throws InputError for
/// another name and for one that cannot run here.
void useKernel(const std::string& name);

/// "sandflow 0.1.0 (avx2 kernel)" and the like.
std::string describeVersion();

}  // namespace sandflow
