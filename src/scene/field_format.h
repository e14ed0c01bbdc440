#pragma once

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/field_rules.h"

#include <optional>
#include <string>
#include <string_view>

namespace sandflow {

/// Shortest decimal text that reads back to the same double, whatever the locale: "0.1", "1e+30".
std::string formatShortest(double value);

/// Control characters as \uXXXX, so that a message stays one line.
std::string escapeControls(std::string_view text);

/// True if TOML takes it as a key without quotes.
bool isBareKey(std::string_view text);

/// Letters of such a key.
inline constexpr std::string_view kBareKeyLetters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

// Values as TOML. Numbers that are floats in the scene always look like floats ("3.0").
// An empty string means that the key is left out.
std::string formatValue(double value, const Range& rule);
std::string formatValue(double value, const OpenRange& rule);
std::string formatValue(const std::optional<double>& value, const AutoRange& rule);
std::string formatValue(double value, const SolvedRange& rule);
std::string formatValue(const std::optional<double>& value, const TargetRange& rule);
std::string formatValue(const std::optional<double>& value, const OptionalRange& rule);
std::string formatValue(std::int64_t value, const IntegerRange& rule);
std::string formatValue(std::uint64_t value, const IntegerRange& rule);
std::string formatValue(bool value, const Flag& rule);
std::string formatValue(const std::string& value, const Text& rule);
std::string formatValue(const Vec2& value, const Range& rule);
std::string formatValue(const Vec3& value, const Range& rule);
std::string formatValue(const Vec3& value, const OpenRange& rule);
std::string formatValue(const Vec3& value, const Direction& rule);
std::string formatValue(const std::optional<Vec3>& value, const OptionalRange& rule);

template <class Stored, class Value>
std::string formatValue(const Stored& value, const Choices<Value>& choices)
{
    for (const auto& choice : choices) {
        if (value == choice.value) {
            return std::string("\"") + choice.name + '"';
        }
    }
    throw InternalError("a scene holds a choice that has no word in a scene file");
}

}  // namespace sandflow
