#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace sandflow {

/// Reads a scene file (TOML; every key is described in scenes/README.md), strictly: what it returns
/// is complete and each value is in its range, with unit vectors normalised.
///
/// `overrides` are KEY=VALUE strings of the command line (`emitters[0].rate=5000`), laid over the
/// file in their order and checked like it; VALUE is TOML, or a bare word as a string.
///
/// Throws InputError, one sentence: `path:line:column: key: what is wrong, what was expected`, or
/// `--set KEY=VALUE: ...` for an override, or `path: ...` for a file that cannot be read.
Scene readScene(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from the text of a scene file; `path` is what messages and Scene::sourcePath say.
Scene parseScene(const std::string& text, const std::string& path,
                 const std::vector<std::string>& overrides = {});

}  // namespace sandflow
