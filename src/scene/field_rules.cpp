#include "scene/field_rules.h"

#include <fmt/format.h>

namespace sandflow {
namespace {

std::string describeInterval(const Range& range)
{
    const std::string low = fmt::format("{:.7g}", range.low);
    const std::string high = fmt::format("{:.7g}", range.high);
    if (range.lowOpen) {
        return fmt::format("above {} and {} {}", low, range.highOpen ? "below" : "up to", high);
    }
    return fmt::format("from {} to {}{}", low, range.highOpen ? "below " : "", high);
}

}  // namespace

std::string describeRule(const Range& rule)
{
    return "a number " + describeInterval(rule);
}

std::string describeRule(const IntegerRange& rule)
{
    return fmt::format("an integer from {} to {}", rule.low, rule.high);
}

std::string describeRule(const AutoRange& rule)
{
    return "\"auto\" or " + describeRule(rule.range);
}

std::string describeRule(const SolvedRange& rule)
{
    return "\"auto\" or " + describeRule(rule.range);
}

std::string describeRule(const TargetRange& rule)
{
    return describeRule(rule.range);
}

std::string describeRule(const OptionalRange& rule)
{
    return describeRule(rule.range);
}

std::string describeRule(const OpenRange& rule)
{
    return describeRule(rule.range);
}

std::string describeRule(const Flag&)
{
    return "true or false";
}

std::string describeRule(const Text& rule)
{
    return rule.mayBeEmpty ? "a string" : "a string that is not empty";
}

std::string describeRule(const Direction&)
{
    return "a direction [x, y, z] of any length but zero";
}

std::string describeVector(const Range& rule, int components)
{
    return fmt::format("{} with each component {}", components == 2 ? "[x, y]" : "[x, y, z]",
                       describeInterval(rule));
}

std::string joinUnit(const std::string& description, const char* unit)
{
    return *unit == '\0' ? description : description + ' ' + unit;
}

}  // namespace sandflow
