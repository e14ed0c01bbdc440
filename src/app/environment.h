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

/// "0.1.0, AVX2, OpenMP" and the like.
std::string describeVersion();

}  // namespace sandflow
