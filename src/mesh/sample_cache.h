#pragma once

#include "mesh/sample_surface.h"

#include <cstdint>
#include <filesystem>

namespace sandflow {

/// sampleSurface, with the result kept in a file of `folder` for the next time: the very same bits,
/// whether computed or read. The file is known by the content of the mesh, the gap and the seed.
///
/// The cache never fails: a file that is damaged, cut off or foreign is made anew, and where
/// nothing can be written (or `folder` is empty) nothing is kept. Several processes may share a
/// folder. Old files are never removed; all of the folder may be deleted at any time.
SurfaceSamples sampleSurfaceCached(const TriangleMesh& mesh, double gap, std::uint64_t seed,
                                   const std::filesystem::path& folder);

/// $SANDFLOW_CACHE_DIR, else $XDG_CACHE_HOME/sandflow, else $HOME/.cache/sandflow, else a folder of
/// this user in the system's temporary folder; empty if there is not even that. Variables that are
/// empty count as not set, so do the last two if they are not absolute. Nothing is created.
std::filesystem::path defaultSampleCacheFolder();

/// Where in `folder` the samples are kept.
std::filesystem::path sampleCacheFile(const TriangleMesh& mesh, double gap, std::uint64_t seed,
                                      const std::filesystem::path& folder);

}  // namespace sandflow
