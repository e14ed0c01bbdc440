#include "scene/field_reader.h"

#include "core/errors.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <tuple>

namespace sandflow {
namespace {

/// A key as it would be written in TOML: bare if it can be.
std::string quoteKey(const std::string& name)
{
    return isBareKey(name) ? name : formatValue(name, Text{});
}

/// True for the word "auto"; any other string is refused.
bool saysAuto(const ValueSite& site)
{
    const auto* word = site.node.as_string();
    if (word != nullptr && word->get() != "auto") {
        site.refuse(formatValue(word->get(), Text{}));
    }
    return word != nullptr;
}

template <class Vector>
void readVector(const ValueSite& site, Vector& value, const Range& rule)
{
    const toml::array* array = site.node.as_array();
    if (array == nullptr) {
        site.refuseType();
    }
    if (array->size() != static_cast<std::size_t>(value.size())) {
        site.refuse(fmt::format("an array of {}", array->size()));
    }
    Vector filled;
    for (std::size_t i = 0; i < array->size(); ++i) {
        readValue(ValueSite{site.source, *array->get(i), fmt::format("{}[{}]", site.key, i),
                            describeRule(rule)},
                  filled[static_cast<Eigen::Index>(i)], rule);
    }
    value = filled;
}

/// Unit vector along a vector that is not zero. One that is unit already, as far as doubles can
/// tell, keeps its bits, so that what was written out reads back the same.
Vec3 makeUnit(const Vec3& vector)
{
    constexpr double tolerance = 8.0 * std::numeric_limits<double>::epsilon();
    if (std::abs(vector.squaredNorm() - 1.0) <= tolerance) {
        return vector;
    }
    // Scaled first: the squares of large or small components leave the range of a double.
    const Vec3 scaled = vector / vector.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

}  // namespace

void ValueSite::refuse(const std::string& what) const
{
    source.fail(key, node.source().begin, "is " + what + ", expected " + expected);
}

void ValueSite::refuseType() const
{
    refuse(nameType(node));
}

void readValue(const ValueSite& site, double& value, const Range& rule)
{
    double number = 0.0;
    if (const auto* floating = site.node.as_floating_point()) {
        number = floating->get();
    } else if (const auto* integer = site.node.as_integer()) {
        number = static_cast<double>(integer->get());
    } else {
        site.refuseType();
    }
    if (!std::isfinite(number)) {
        site.refuse(std::isnan(number) ? "not a number (nan)" : "infinite");
    }
    if (!rule.contains(number)) {
        site.refuse(formatShortest(number));
    }
    value = number;
}

void readValue(const ValueSite& site, double& value, const OpenRange& rule)
{
    readValue(site, value, rule.range);
}

void readValue(const ValueSite& site, std::optional<double>& value, const AutoRange& rule)
{
    if (saysAuto(site)) {
        value.reset();
    } else {
        readValue(site, value.emplace(), rule.range);
    }
}

void readValue(const ValueSite& site, double& value, const SolvedRange& rule)
{
    if (!saysAuto(site)) {
        readValue(site, value, rule.range);
    }
}

void readValue(const ValueSite& site, std::optional<double>& value, const TargetRange& rule)
{
    readValue(site, value.emplace(), rule.range);
}

void readValue(const ValueSite& site, std::optional<double>& value, const OptionalRange& rule)
{
    readValue(site, value.emplace(), rule.range);
}

void readValue(const ValueSite& site, std::int64_t& value, const IntegerRange& rule)
{
    const auto* integer = site.node.as_integer();
    if (integer == nullptr) {
        site.refuseType();
    }
    if (integer->get() < rule.low || integer->get() > rule.high) {
        site.refuse(fmt::format("{}", integer->get()));
    }
    value = integer->get();
}

void readValue(const ValueSite& site, std::uint64_t& value, const IntegerRange& rule)
{
    SAND_CHECK(rule.low >= 0, "an unsigned key allows {}", rule.low);
    std::int64_t integer = 0;
    readValue(site, integer, rule);
    value = static_cast<std::uint64_t>(integer);
}

void readValue(const ValueSite& site, bool& value, const Flag&)
{
    const auto* boolean = site.node.as_boolean();
    if (boolean == nullptr) {
        site.refuseType();
    }
    value = boolean->get();
}

std::string readWord(const ValueSite& site)
{
    const auto* text = site.node.as_string();
    if (text == nullptr) {
        site.refuseType();
    }
    return text->get();
}

void readValue(const ValueSite& site, std::string& value, const Text& rule)
{
    const std::string text = readWord(site);
    if (text.empty() && !rule.mayBeEmpty) {
        site.refuse("empty");
    }
    // Names end up in messages, in pictures and as paths: one line, no surprises.
    if (escapeControls(text) != text) {
        site.refuse("text with control characters");
    }
    value = text;
}

void readValue(const ValueSite& site, Vec2& value, const Range& rule)
{
    readVector(site, value, rule);
}

void readValue(const ValueSite& site, Vec3& value, const Range& rule)
{
    readVector(site, value, rule);
}

void readValue(const ValueSite& site, Vec3& value, const OpenRange& rule)
{
    readVector(site, value, rule.range);
}

void readValue(const ValueSite& site, Vec3& value, const Direction&)
{
    constexpr double largest = std::numeric_limits<double>::max();
    Vec3 direction;
    readVector(site, direction, Range{-largest, largest});
    if (direction.isZero(0.0)) {
        site.refuse("the zero vector");
    }
    value = makeUnit(direction);
}

void readValue(const ValueSite& site, std::optional<Vec3>& value, const OptionalRange& rule)
{
    readVector(site, value.emplace(), rule.range);
}

std::string FieldReader::nameKey(const std::string& name) const
{
    return prefix_.empty() ? quoteKey(name) : prefix_ + '.' + quoteKey(name);
}

bool FieldReader::isBefore(const toml::key& a, const toml::key& b)
{
    const auto first = a.source().begin;
    const auto second = b.source().begin;
    return std::tie(first.line, first.column) < std::tie(second.line, second.column);
}

void FieldReader::refuseMissing(const char* name, const std::string& expected) const
{
    const auto begin = table_.source().begin;
    source_.fail(nameKey(name), prefix_.empty() ? toml::source_position{1, 1} : begin,
                 "is missing, expected " + expected);
}

void FieldReader::refuseKey(const toml::key& key, const std::vector<std::string>& legal,
                            const std::string& misplaced) const
{
    const std::string name(key.str());
    std::string problem = misplaced;
    if (problem.empty()) {
        const std::string nearest = findNearest(name, legal);
        problem = nearest.empty()
                      ? fmt::format("unknown key (expected one of {})", fmt::join(legal, ", "))
                      : fmt::format("unknown key (did you mean \"{}\"?)", nearest);
    }
    source_.fail(nameKey(name), key.source().begin, problem);
}

}  // namespace sandflow
