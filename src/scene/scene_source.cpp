#include "scene/scene_source.h"

#include "core/errors.h"
#include "scene/field_format.h"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

namespace sandflow {
namespace {

constexpr std::size_t kLargestFile = 16 << 20;  // bytes; a scene is kilobytes, /dev/zero is endless

bool holdsNothing(const std::string& text)
{
    bool comment = false;
    for (const char c : std::string_view(text).substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0)) {
        comment = c != '\n' && (comment || c == '#');
        if (!comment && c != ' ' && c != '\t' && c != '\r' && c != '\n') {
            return false;
        }
    }
    return true;
}

toml::table parseToml(const std::string& text, const std::string& path)
{
    if (holdsNothing(text)) {
        throw InputError(fmt::format("{}: is empty, expected a scene", escapeControls(path)));
    }
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}", escapeControls(path), at.line,
                                     at.column, escapeControls(error.description())));
    }
}

/// Where the key, or the nearest table around it that is in the file, begins.
toml::source_position locate(const toml::table& root, std::string key)
{
    while (!key.empty()) {
        const auto view = toml::at_path(root, key);
        if (view.node() != nullptr && view.node()->source().begin) {
            return view.node()->source().begin;
        }
        const auto cut = key.find_last_of(".[");
        key.resize(cut == std::string::npos ? 0 : cut);
    }
    return {1, 1};
}

}  // namespace

SceneSource::SceneSource(const std::string& text, const std::string& path,
                         const std::vector<std::string>& overrides)
    : path_(path), root_(parseToml(text, path))
{
    for (const std::string& override : overrides) {
        overrides_.emplace_back(override).apply(root_);
    }
}

const SceneOverride* SceneSource::findOverride(const std::string& key) const
{
    for (auto it = overrides_.rbegin(); it != overrides_.rend(); ++it) {
        if (it->covers(key)) {
            return &*it;  // the last one wins, as in the value
        }
    }
    return nullptr;
}

void SceneSource::fail(const std::string& key, const toml::source_position& position,
                       const std::string& problem) const
{
    const SceneOverride* override = findOverride(key);
    if (override == nullptr && !position) {
        // Not in the file and not itself on the command line: a table that one of its keys made.
        for (const SceneOverride& candidate : overrides_) {
            if (candidate.isInside(key)) {
                override = &candidate;
            }
        }
    }
    if (override != nullptr) {
        override->fail(override->key() == key ? problem : key + ": " + problem);
    }
    throw InputError(fmt::format("{}:{}:{}: {}: {}", escapeControls(path_), position.line,
                                 position.column, key, problem));
}

void SceneSource::fail(const std::vector<std::string>& keys, const std::string& problem) const
{
    const std::string* named = nullptr;
    for (const std::string& key : keys) {
        if (findOverride(key) != nullptr) {
            named = &key;
            break;
        }
        if (named == nullptr && toml::at_path(root_, key).node() != nullptr) {
            named = &key;
        }
    }
    const std::string& key = named == nullptr ? keys.front() : *named;
    fail(key, locate(root_, key), problem);
}

std::string readSceneText(const std::string& path)
{
    const auto refuse = [&](const std::string& problem) {
        throw InputError(fmt::format("{}: {}", escapeControls(path), problem));
    };
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        refuse(error && error != std::errc::no_such_file_or_directory
                   ? fmt::format("cannot be read ({})", error.message())
                   : "no such file, expected a scene file");
    }
    if (std::filesystem::is_directory(status)) {
        refuse("is a directory, expected a scene file");
    }
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::string text;
    char buffer[1 << 16];
    while (file && text.size() <= kLargestFile) {
        file.read(buffer, sizeof buffer);
        text.append(buffer, static_cast<std::size_t>(file.gcount()));
    }
    if (!file.is_open() || file.bad()) {
        refuse(fmt::format("cannot be read ({})", std::generic_category().message(errno)));
    }
    if (text.size() > kLargestFile) {
        refuse(fmt::format("is larger than {} MiB, expected a scene file", kLargestFile >> 20));
    }
    return text;
}

}  // namespace sandflow
