#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace sandflow {

/// One way to run the scene of an error study: what `sandflow run SCENE --set ...` would do.
struct ErrorSetting {
    std::string approximation;           ///< "R_min", "time step", ...; see the two names below
    std::string value;                   ///< with its unit, as people read it: "3 d"
    std::vector<std::string> overrides;  ///< KEY=VALUE of the scene file
};

/// Approximations of the two settings that are no sweep.
inline constexpr const char* kDefaultSetting = "default";
inline constexpr const char* kReferenceSetting = "reference";

/// How much finer than the scene the reference is. It is dem, so of the approximations only these
/// two are left (and float, whose effect the sweep shows).
struct ErrorReference {
    double stiffness = 10.0;   ///< times the scene's
    double stepSafety = 0.4;   ///< step over the stability bound
};

/// Every setting of a study, the scene itself (kDefaultSetting) first. Each other differs from it
/// in one approximation; values that the scene has already are left out. `stiffness` is what the
/// scene comes to: N/m for the linear law, Pa (4/3 E*) for the others. `quick` keeps the two ends
/// of each sweep. Throws InputError for a scene that leaves nothing to study: mode dem, or a step
/// that is given.
std::vector<ErrorSetting> listErrorSettings(const Scene& scene, double stiffness, bool quick);

/// The setting that all others are measured against.
ErrorSetting makeReferenceSetting(const Scene& scene, double stiffness,
                                  const ErrorReference& reference);

}  // namespace sandflow
