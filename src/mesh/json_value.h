#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// One value of a JSON text with all inside it.
struct JsonValue {
    enum class Kind { null, boolean, number, string, array, object };

    Kind kind = Kind::null;
    double number = 0.0;            ///< number; boolean: 0 or 1
    std::string text;               ///< string, decoded
    std::vector<JsonValue> items;   ///< array; object: the values
    std::vector<std::string> keys;  ///< object: of the items, each once

    /// The value of an object's key; null if there is none or this is no object.
    const JsonValue* find(std::string_view key) const;
    /// The number if it is a whole one from 0 to 2^53.
    std::optional<std::size_t> asIndex() const;
};

/// What makes a text no JSON, and where.
class JsonError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Strict. Throws JsonError, also for more than a million values, more than 64 levels, and objects
/// with more than 256 keys or one key twice: readers differ in which of the two they believe.
JsonValue parseJson(std::string_view text);

}  // namespace sandflow
