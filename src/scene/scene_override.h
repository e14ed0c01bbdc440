#pragma once

#include <toml++/toml.h>

#include <string>
#include <variant>
#include <vector>

namespace sandflow {

/// One `--set KEY=VALUE`: a value of the scene file given on the command line.
class SceneOverride {
public:
    /// Reads KEY (`table.key`, `list[0].key`) and VALUE (TOML; a bare word is a string).
    /// Throws InputError.
    explicit SceneOverride(const std::string& text);

    /// Puts the value into the parsed file, making tables that are not there. Throws InputError
    /// when the way is blocked: no such list element, or a value where a table should be.
    void apply(toml::table& root) const;

    /// KEY in the form in which messages name keys.
    const std::string& key() const { return key_; }

    /// True if the key that a message is about is this one, or inside its value.
    bool covers(const std::string& key) const;

    /// True if this one is inside the value of the key that a message is about.
    bool isInside(const std::string& key) const;

    /// Throws InputError `--set KEY=VALUE: problem`.
    [[noreturn]] void fail(const std::string& problem) const;

private:
    using Step = std::variant<std::string, std::size_t>;  // key of a table or index of a list

    void parseKey(const std::string& key);
    void parseValue(const std::string& value);

    std::string text_;
    std::string key_;
    std::vector<Step> steps_;
    toml::table holder_;  // the value, under the key "v"
};

/// "a string", "an integer": a node's type in a message.
std::string nameType(const toml::node& node);

}  // namespace sandflow
