#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// Builds one JSON text (RFC 8259), indented by two spaces, independent of the locale. Numbers
/// are written with the fewest digits that read back as the same value; NaN and infinity, which
/// JSON lacks, become null; text that is not UTF-8 gets U+FFFD where it goes wrong.
///
///     JsonWriter json;
///     json.beginObject().member("scene", "floor").key("heap").beginObject();
///     json.member("apex_m", 0.21).endObject().endObject();
///
/// Wrong nesting (a value without a key, an end without a begin) is an InternalError.
class JsonWriter {
public:
    JsonWriter& beginObject();
    JsonWriter& endObject();
    JsonWriter& beginArray();
    JsonWriter& endArray();
    JsonWriter& key(std::string_view name);

    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
    JsonWriter& value(double number);
    JsonWriter& value(bool truth);
    template <std::integral T>
    JsonWriter& value(T number)
    {
        if constexpr (std::is_signed_v<T>) {
            return writeSigned(number);
        } else {
            return writeUnsigned(number);
        }
    }
    JsonWriter& null();
    /// null where there is none.
    JsonWriter& value(const std::optional<double>& number)
    {
        return number ? value(*number) : null();
    }

    template <typename T>
    JsonWriter& member(std::string_view name, const T& content)
    {
        return key(name).value(content);
    }

    /// The text, with a newline at its end. InternalError while something is still open.
    std::string text() const;

private:
    enum class Level { object, array };
    struct Open {
        Level level;
        bool empty = true;
        bool keyWritten = false;
    };
    JsonWriter& writeSigned(std::int64_t number);
    JsonWriter& writeUnsigned(std::uint64_t number);
    void startValue();
    void startLine(std::size_t depth);
    JsonWriter& endLevel(Level level, char bracket);
    void appendQuoted(std::string_view text);

    std::string text_;
    std::vector<Open> open_;
};

}  // namespace sandflow
