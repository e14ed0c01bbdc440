#pragma once

#include "scene/scene_limits.h"

#include <span>
#include <string>

namespace sandflow {

enum class Need { optional, required };

/// A key of the scene file: its name, its unit ("" if it has none) and one sentence about it.
struct Key {
    const char* name;
    const char* unit;
    const char* meaning;
    Need need = Need::optional;
};

// What the value of a key may be. Range and IntegerRange are rules too (scene_limits.h).

/// A number or the word "auto" (an empty optional).
struct AutoRange {
    Range range;
};

/// A number, or the word "auto" for one that is solved from another key when the scene is read.
struct SolvedRange {
    Range range;
};

/// A number from which others are solved when the scene is read (an empty optional if there is
/// none). They are written, it is not: together they would say the same thing twice.
struct TargetRange {
    Range range;
};

/// A number or vector whose key may be absent (an empty optional).
struct OptionalRange {
    Range range;
};

/// A number or vector whose key is absent while every component is +-`open`.
struct OpenRange {
    Range range;
    double open;
};

struct Flag {};

struct Text {
    bool mayBeEmpty = true;
};

/// A vector of any length but zero; kept as a unit vector.
struct Direction {};

template <class Value>
struct Choice {
    Value value;
    const char* name;
};

/// One of a few words.
template <class Value>
using Choices = std::span<const Choice<Value>>;

// What is allowed, as it stands after "expected": "a number above 0 and up to 1".
std::string describeRule(const Range& rule);
std::string describeRule(const IntegerRange& rule);
std::string describeRule(const AutoRange& rule);
std::string describeRule(const SolvedRange& rule);
std::string describeRule(const TargetRange& rule);
std::string describeRule(const OptionalRange& rule);
std::string describeRule(const OpenRange& rule);
std::string describeRule(const Flag& rule);
std::string describeRule(const Text& rule);
std::string describeRule(const Direction& rule);

/// "one of "jet", "slot"".
template <class Value>
std::string describeRule(const Choices<Value>& choices)
{
    std::string list;
    for (const auto& choice : choices) {
        list += std::string(list.empty() ? "" : ", ") + '"' + choice.name + '"';
    }
    return "one of " + list;
}

/// The same for a vector of that many components, each within the rule.
std::string describeVector(const Range& rule, int components);

/// A rule with its unit: "a number above 0 and up to 1 m".
std::string joinUnit(const std::string& description, const char* unit);

}  // namespace sandflow
