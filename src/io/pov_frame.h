#pragma once

#include "grains/snapshot.h"

#include <cstdint>
#include <functional>
#include <string>

namespace sandflow {

/// Number of colour families; GrainTexture(K) in povray/materials.inc has a tone for each.
inline constexpr int kColourFamilies = 24;

enum class GrainColour {
    family,  ///< a sand tone by the grain's id, the same in every frame
    state    ///< StateTexture(K), K = 0 mobile, 1 asleep, 2 interface, 3 buried; to look for faults
};

struct PovFrameOptions {
    bool allGrains = false;  ///< the buried ones too; they cannot be seen
    /// Buried ones for which this is true are written all the same: they are seen through glass.
    std::function<bool(const Vec3&)> isSeen;
    GrainColour colourBy = GrainColour::family;
};

/// Colour family of a grain, 0 to kColourFamilies - 1. A function of the id alone, so that colours
/// stay with their grains.
int chooseColourFamily(std::uint32_t id);

/// POV-Ray text of one frame: a union of spheres per colour, lengths in mean grain radii with three
/// decimals, axes (x, z, y) because POV-Ray is left-handed with y up. `exported`, if given, gets
/// the number of spheres. Throws InternalError for a coordinate that is not finite or a mean radius
/// that is not positive.
std::string formatPovFrame(const Snapshot& snapshot, const PovFrameOptions& options,
                           std::uint64_t* exported = nullptr);

/// Writes formatPovFrame under the path, whole or not at all, and returns the number of spheres.
/// Throws SystemError if the disk refuses it.
std::uint64_t writePovFrame(const std::string& path, const Snapshot& snapshot,
                            const PovFrameOptions& options);

}  // namespace sandflow
