#include "scene/field_format.h"

#include <fmt/format.h>

#include <cmath>

namespace sandflow {
namespace {

std::string formatFloat(double value)
{
    SAND_CHECK(std::isfinite(value), "a scene holds the number {}", value);
    std::string text = formatShortest(value);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

template <class Vector>
std::string formatVector(const Vector& vector)
{
    std::string text = "[";
    for (Eigen::Index i = 0; i < vector.size(); ++i) {
        text += (i == 0 ? "" : ", ") + formatFloat(vector[i]);
    }
    return text + "]";
}

}  // namespace

std::string formatShortest(double value)
{
    return fmt::format("{}", value);
}

std::string escapeControls(std::string_view text)
{
    std::string escaped;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            escaped += fmt::format("\\u{:04X}", byte);
        } else {
            escaped += c;
        }
    }
    return escaped;
}

bool isBareKey(std::string_view text)
{
    return !text.empty() && text.find_first_not_of(kBareKeyLetters) == std::string_view::npos;
}

std::string formatValue(double value, const Range&)
{
    return formatFloat(value);
}

std::string formatValue(double value, const OpenRange& rule)
{
    return value == rule.open ? "" : formatFloat(value);
}

std::string formatValue(const std::optional<double>& value, const AutoRange&)
{
    return value ? formatFloat(*value) : "\"auto\"";
}

std::string formatValue(double value, const SolvedRange&)
{
    return formatFloat(value);
}

std::string formatValue(const std::optional<double>&, const TargetRange&)
{
    return "";
}

std::string formatValue(const std::optional<double>& value, const OptionalRange&)
{
    return value ? formatFloat(*value) : "";
}

std::string formatValue(std::int64_t value, const IntegerRange&)
{
    return fmt::format("{}", value);
}

std::string formatValue(std::uint64_t value, const IntegerRange& rule)
{
    SAND_CHECK(value <= static_cast<std::uint64_t>(rule.high), "{} does not fit a TOML integer",
               value);
    return fmt::format("{}", value);
}

std::string formatValue(bool value, const Flag&)
{
    return value ? "true" : "false";
}

std::string formatValue(const std::string& value, const Text&)
{
    std::string quoted;
    for (const char c : value) {
        if (c == '"' || c == '\\') {
            quoted += '\\';
        }
        quoted += c;
    }
    return '"' + escapeControls(quoted) + '"';
}

std::string formatValue(const Vec2& value, const Range&)
{
    return formatVector(value);
}

std::string formatValue(const Vec3& value, const Range&)
{
    return formatVector(value);
}

std::string formatValue(const Vec3& value, const OpenRange& rule)
{
    return value == Vec3::Constant(rule.open) ? "" : formatVector(value);
}

std::string formatValue(const Vec3& value, const Direction&)
{
    return formatVector(value);
}

std::string formatValue(const std::optional<Vec3>& value, const OptionalRange&)
{
    return value ? formatVector(*value) : "";
}

}  // namespace sandflow
