#include "scene/scene_override.h"

#include "core/errors.h"
#include "scene/field_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace sandflow {
namespace {

std::string trim(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t");
    const auto last = text.find_last_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

bool isBareWord(const std::string& text)
{
    return text.find_first_not_of(std::string(kBareKeyLetters) + "./+:") == std::string::npos;
}

/// True if `inner` names something inside `outer`: "a.b" or "a[0]" inside "a".
bool isWithin(const std::string& inner, const std::string& outer)
{
    return inner.size() > outer.size() && inner.starts_with(outer) &&
           (inner[outer.size()] == '.' || inner[outer.size()] == '[');
}

}  // namespace

std::string nameType(const toml::node& node)
{
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a float";
        case toml::node_type::boolean:
            return "a boolean";
        case toml::node_type::date:
            return "a date";
        case toml::node_type::time:
            return "a time";
        case toml::node_type::date_time:
            return "a date and time";
        default:
            return "nothing";
    }
}

SceneOverride::SceneOverride(const std::string& text) : text_(text)
{
    const auto equals = text.find('=');
    if (equals == std::string::npos) {
        fail("has no \"=\", expected KEY=VALUE such as grains.radius=0.004");
    }
    parseKey(trim(text.substr(0, equals)));
    parseValue(trim(text.substr(equals + 1)));
}

void SceneOverride::fail(const std::string& problem) const
{
    throw InputError(fmt::format("--set {}: {}", escapeControls(text_), problem));
}

void SceneOverride::parseKey(const std::string& key)
{
    const auto refuse = [&] {
        fail("is not a valid key, expected one such as mode, grains.radius or emitters[0].rate");
    };
    std::size_t at = 0;
    while (true) {
        const auto end = std::min(key.find_first_not_of(kBareKeyLetters, at), key.size());
        if (end == at) {
            refuse();
        }
        steps_.emplace_back(key.substr(at, end - at));
        at = end;
        while (at < key.size() && key[at] == '[') {
            std::size_t index = 0;
            const char* last = key.data() + key.size();
            const auto result = std::from_chars(key.data() + at + 1, last, index);
            if (result.ec != std::errc{} || result.ptr == last || *result.ptr != ']') {
                refuse();
            }
            steps_.emplace_back(index);
            at = static_cast<std::size_t>(result.ptr - key.data()) + 1;
        }
        if (at == key.size()) {
            break;
        }
        if (key[at] != '.') {
            refuse();
        }
        ++at;
    }
    for (const Step& step : steps_) {
        if (const auto* index = std::get_if<std::size_t>(&step)) {
            key_ += fmt::format("[{}]", *index);
        } else {
            key_ += (key_.empty() ? "" : ".") + std::get<std::string>(step);
        }
    }
}

void SceneOverride::parseValue(const std::string& value)
{
    if (value.empty()) {
        fail("has no value, expected KEY=VALUE such as grains.radius=0.004");
    }
    try {
        holder_ = toml::parse("v = " + value);
        // A line break would smuggle in a second key.
        if (holder_.size() == 1 && value.find_first_of("\r\n") == std::string::npos) {
            return;
        }
    } catch (const toml::parse_error&) {
        if (isBareWord(value)) {
            holder_.insert_or_assign("v", value);
            return;
        }
    }
    fail("is not a value, expected a number, a word, true, false, \"text\" or [x, y, z]");
}

bool SceneOverride::covers(const std::string& key) const
{
    return key == key_ || isWithin(key, key_);
}

bool SceneOverride::isInside(const std::string& key) const
{
    return isWithin(key_, key);
}

void SceneOverride::apply(toml::table& root) const
{
    toml::node* place = &root;
    std::string way;  // the key of `place`
    const auto nameWay = [&] { return way.empty() ? std::string("the scene") : way; };
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const bool last = i + 1 == steps_.size();
        const toml::node& value = *holder_.get("v");
        if (const auto* index = std::get_if<std::size_t>(&steps_[i])) {
            toml::array* array = place->as_array();
            if (array == nullptr) {
                fail(fmt::format("{} is {}, expected an array", nameWay(), nameType(*place)));
            }
            if (*index >= array->size()) {
                fail(fmt::format("{} has {} element{}, counted from 0", nameWay(), array->size(),
                                 array->size() == 1 ? "" : "s"));
            }
            if (last) {
                value.visit([&](const auto& concrete) {
                    array->replace(array->begin() + static_cast<std::ptrdiff_t>(*index), concrete);
                });
                return;
            }
            way += fmt::format("[{}]", *index);
            place = array->get(*index);
            continue;
        }
        const std::string& name = std::get<std::string>(steps_[i]);
        toml::table* table = place->as_table();
        if (table == nullptr) {
            fail(fmt::format("{} is {}, expected a table", nameWay(), nameType(*place)));
        }
        if (last) {
            value.visit([&](const auto& concrete) { table->insert_or_assign(name, concrete); });
            return;
        }
        way += (way.empty() ? "" : ".") + name;
        if (table->get(name) == nullptr) {
            if (std::holds_alternative<std::size_t>(steps_[i + 1])) {
                fail(fmt::format("the scene file has no {}", way));
            }
            table->insert_or_assign(name, toml::table{});
        }
        place = table->get(name);
    }
}

}  // namespace sandflow
