#pragma once

#include "core/vec3.h"
#include "scene/did_you_mean.h"
#include "scene/field_format.h"
#include "scene/scene_source.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sandflow {

/// A value in the file, with what a message about it needs.
struct ValueSite {
    const SceneSource& source;
    const toml::node& node;
    std::string key;       ///< "emitters[0].rate"
    std::string expected;  ///< "a number above 0 and up to 1e+09 grains/s"

    /// Throws InputError `...: is WHAT, expected EXPECTED`.
    [[noreturn]] void refuse(const std::string& what) const;
    [[noreturn]] void refuseType() const;
};

// Fill a value from the file or throw InputError.
void readValue(const ValueSite& site, double& value, const Range& rule);
void readValue(const ValueSite& site, double& value, const OpenRange& rule);
void readValue(const ValueSite& site, std::optional<double>& value, const AutoRange& rule);
void readValue(const ValueSite& site, double& value, const SolvedRange& rule);
void readValue(const ValueSite& site, std::optional<double>& value, const TargetRange& rule);
void readValue(const ValueSite& site, std::optional<double>& value, const OptionalRange& rule);
void readValue(const ValueSite& site, std::int64_t& value, const IntegerRange& rule);
void readValue(const ValueSite& site, std::uint64_t& value, const IntegerRange& rule);
void readValue(const ValueSite& site, bool& value, const Flag& rule);
void readValue(const ValueSite& site, std::string& value, const Text& rule);
void readValue(const ValueSite& site, Vec2& value, const Range& rule);
void readValue(const ValueSite& site, Vec3& value, const Range& rule);
void readValue(const ValueSite& site, Vec3& value, const OpenRange& rule);
void readValue(const ValueSite& site, Vec3& value, const Direction& rule);
void readValue(const ValueSite& site, std::optional<Vec3>& value, const OptionalRange& rule);

/// A string of the file; another type is refused.
std::string readWord(const ValueSite& site);

template <class Stored, class Value>
void readValue(const ValueSite& site, Stored& value, const Choices<Value>& choices)
{
    const std::string word = readWord(site);
    std::vector<std::string> names;
    for (const auto& choice : choices) {
        if (word == choice.name) {
            value = choice.value;
            return;
        }
        names.emplace_back(choice.name);
    }
    const std::string nearest = findNearest(word, names);
    const std::string quoted = formatValue(word, Text{});
    site.source.fail(site.key, site.node.source().begin,
                     nearest.empty() ? "is " + quoted + ", expected " + site.expected
                                     : "is " + quoted + " (did you mean \"" + nearest + "\"?)");
}

// What a value of this type must be, in words.
template <class Value, class Rule>
std::string describeField(const Value&, const Rule& rule)
{
    return describeRule(rule);
}
inline std::string describeField(const Vec2&, const Range& rule)
{
    return describeVector(rule, 2);
}
inline std::string describeField(const Vec3&, const Range& rule)
{
    return describeVector(rule, 3);
}
inline std::string describeField(const Vec3&, const OpenRange& rule)
{
    return describeVector(rule.range, 3);
}
inline std::string describeField(const std::optional<Vec3>&, const OptionalRange& rule)
{
    return describeVector(rule.range, 3);
}

/// Visitor of the fields that fills them from one table of the file; keys that are absent leave the
/// default.
class FieldReader {
public:
    /// `prefix`: the table's key, "" for the top of the file.
    FieldReader(const SceneSource& source, const toml::table& table, std::string prefix)
        : source_(source), table_(table), prefix_(std::move(prefix))
    {
    }

    template <class Value, class Rule>
    void operator()(const Key& key, Value& value, const Rule& rule)
    {
        const std::string expected = joinUnit(describeField(value, rule), key.unit);
        if (const toml::node* node = table_.get(key.name)) {
            readValue(ValueSite{source_, *node, nameKey(key.name), expected}, value, rule);
        } else if (key.need == Need::required) {
            refuseMissing(key.name, expected);
        }
    }

    /// Throws InputError at the first key of the table (in the file's order) that is not legal. If
    /// `misplaced(name)` says that it would be elsewhere, that is the message.
    template <class Explain>
    void refuseUnknown(const std::vector<std::string>& legal, const Explain& misplaced) const
    {
        const toml::key* first = nullptr;
        for (auto&& [key, node] : table_) {
            const bool known = std::find(legal.begin(), legal.end(), key.str()) != legal.end();
            if (!known && (first == nullptr || isBefore(key, *first))) {
                first = &key;
            }
        }
        if (first != nullptr) {
            refuseKey(*first, legal, misplaced(std::string(first->str())));
        }
    }

    /// The full key, as messages name it.
    std::string nameKey(const std::string& name) const;

private:
    static bool isBefore(const toml::key& a, const toml::key& b);
    [[noreturn]] void refuseMissing(const char* name, const std::string& expected) const;
    [[noreturn]] void refuseKey(const toml::key& key, const std::vector<std::string>& legal,
                                const std::string& misplaced) const;

    const SceneSource& source_;
    const toml::table& table_;
    std::string prefix_;
};

}  // namespace sandflow
