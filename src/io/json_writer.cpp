#include "io/json_writer.h"

#include "core/errors.h"
#include "io/number_text.h"

#include <cmath>

namespace sandflow {
namespace {

/// Bytes of the UTF-8 character at the start of `text`, 0 if it is malformed (RFC 3629: overlong
/// forms, surrogates and anything above U+10FFFF are).
std::size_t measureUtf8(std::string_view text)
{
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = at(0);
    if (lead < 0x80) {
        return 1;
    }
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length) {
        return 0;
    }
    const unsigned lowest = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned highest = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (at(1) < lowest || at(1) > highest) {
        return 0;
    }
    for (std::size_t i = 2; i < length; ++i) {
        if ((at(i) & 0xC0U) != 0x80U) {
            return 0;
        }
    }
    return length;
}

}  // namespace

JsonWriter& JsonWriter::beginObject()
{
    startValue();
    text_ += '{';
    open_.push_back({Level::object});
    return *this;
}

JsonWriter& JsonWriter::endObject()
{
    return endLevel(Level::object, '}');
}

JsonWriter& JsonWriter::beginArray()
{
    startValue();
    text_ += '[';
    open_.push_back({Level::array});
    return *this;
}

JsonWriter& JsonWriter::endArray()
{
    return endLevel(Level::array, ']');
}

JsonWriter& JsonWriter::key(std::string_view name)
{
    SAND_CHECK(!open_.empty() && open_.back().level == Level::object && !open_.back().keyWritten,
               "key \"{}\" where JSON allows none", name);
    if (!open_.back().empty) {
        text_ += ',';
    }
    open_.back().empty = false;
    open_.back().keyWritten = true;
    startLine(open_.size());
    appendQuoted(name);
    text_ += ": ";
    return *this;
}

JsonWriter& JsonWriter::value(std::string_view text)
{
    startValue();
    appendQuoted(text);
    return *this;
}

JsonWriter& JsonWriter::value(double number)
{
    if (!std::isfinite(number)) {
        return null();
    }
    startValue();
    appendNumber(text_, number);
    return *this;
}

JsonWriter& JsonWriter::value(bool truth)
{
    startValue();
    text_ += truth ? "true" : "false";
    return *this;
}

JsonWriter& JsonWriter::null()
{
    startValue();
    text_ += "null";
    return *this;
}

JsonWriter& JsonWriter::writeSigned(std::int64_t number)
{
    startValue();
    appendNumber(text_, number);
    return *this;
}

JsonWriter& JsonWriter::writeUnsigned(std::uint64_t number)
{
    startValue();
    appendNumber(text_, number);
    return *this;
}

std::string JsonWriter::text() const
{
    SAND_CHECK(open_.empty() && !text_.empty(), "the JSON text is not finished");
    return text_ + '\n';
}

void JsonWriter::startValue()
{
    if (open_.empty()) {
        SAND_CHECK(text_.empty(), "a JSON text holds one value");
        return;
    }
    Open& parent = open_.back();
    if (parent.level == Level::object) {
        SAND_CHECK(parent.keyWritten, "a value in a JSON object needs a key");
        parent.keyWritten = false;
        return;
    }
    if (!parent.empty) {
        text_ += ',';
    }
    parent.empty = false;
    startLine(open_.size());
}

void JsonWriter::startLine(std::size_t depth)
{
    text_ += '\n';
    text_.append(2 * depth, ' ');
}

JsonWriter& JsonWriter::endLevel(Level level, char bracket)
{
    SAND_CHECK(!open_.empty() && open_.back().level == level && !open_.back().keyWritten,
               "'{}' where JSON allows none", bracket);
    const bool empty = open_.back().empty;
    open_.pop_back();
    if (!empty) {
        startLine(open_.size());
    }
    text_ += bracket;
    return *this;
}

void JsonWriter::appendQuoted(std::string_view text)
{
    text_ += '"';
    while (!text.empty()) {
        const char first = text.front();
        std::size_t length = 1;
        switch (first) {
            case '"': text_ += "\\\""; break;
            case '\\': text_ += "\\\\"; break;
            case '\n': text_ += "\\n"; break;
            case '\r': text_ += "\\r"; break;
            case '\t': text_ += "\\t"; break;
            default:
                length = measureUtf8(text);
                if (length == 0) {
                    text_ += "\\ufffd";
                    length = 1;
                } else if (static_cast<unsigned char>(first) < 0x20) {
                    text_ += fmt::format("\\u{:04x}", static_cast<unsigned>(first));
                } else {
                    text_ += text.substr(0, length);
                }
        }
        text.remove_prefix(length);
    }
    text_ += '"';
}

}  // namespace sandflow
