#pragma once

#include <string>

#include "core/errors.h"
#include "scene/scene.h"

namespace sandflow {

/// "scenes/x.toml: emitters[2] ("jet"): ", what every complaint about an emitter starts with.
inline std::string emitterLabel(const Scene& scene, std::size_t index)
{
    const std::string& file = scene.sourcePath.empty() ? scene.name : scene.sourcePath;
    const std::string& name = scene.emitters.at(index).name;
    return fmt::format("{}{}emitters[{}]{}: ", file, file.empty() ? "" : ": ", index,
                       name.empty() ? "" : fmt::format(" (\"{}\")", name));
}

/// Throws InputError with the scene file and the emitter in front of the sentence.
[[noreturn]] inline void refuseEmitter(const Scene& scene, std::size_t index,
                                       const std::string& sentence)
{
    throw InputError(emitterLabel(scene, index) + sentence);
}

}  // namespace sandflow
