#pragma once

#include "scene/scene_override.h"

#include <string>
#include <vector>

namespace sandflow {

/// A parsed scene file with the command line's values in it; knows where every key came from, so
/// that messages can say so.
class SceneSource {
public:
    /// Throws InputError for a text that is empty or no TOML, and for a bad override.
    SceneSource(const std::string& text, const std::string& path,
                const std::vector<std::string>& overrides);

    const toml::table& root() const { return root_; }
    const std::string& path() const { return path_; }

    /// Throws InputError `path:line:column: key: problem`, or `--set KEY=VALUE: problem` when the
    /// value was given on the command line.
    [[noreturn]] void fail(const std::string& key, const toml::source_position& position,
                           const std::string& problem) const;

    /// The same for a problem between several keys: the first that was given on the command line is
    /// named, otherwise the first that is in the file, otherwise the table that should hold it.
    [[noreturn]] void fail(const std::vector<std::string>& keys, const std::string& problem) const;

private:
    const SceneOverride* findOverride(const std::string& key) const;

    std::string path_;
    toml::table root_;
    std::vector<SceneOverride> overrides_;
};

/// Whole text of a scene file. Throws InputError when it is not there, is a directory or cannot be
/// read.
std::string readSceneText(const std::string& path);

}  // namespace sandflow
