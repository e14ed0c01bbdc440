#include "mesh/json_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace sandflow {
namespace {

constexpr std::size_t kMaxValues = 1'000'000;
constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxKeys = 256;  ///< of one object: they are looked up one by one

class JsonParser {
public:
    explicit JsonParser(std::string_view text) : text_(text) {}

    JsonValue parse()
    {
        JsonValue value = readValue(0);
        skipBlanks();
        if (at_ != text_.size()) {
            fail("text behind the value");
        }
        return value;
    }

private:
    [[noreturn]] void fail(std::string_view what) const
    {
        throw JsonError(fmt::format("{} at byte {}", what, at_));
    }

    void skipBlanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    bool take(char wanted)
    {
        skipBlanks();
        if (peek() != wanted || at_ == text_.size()) {
            return false;
        }
        ++at_;
        return true;
    }

    void expect(char wanted)
    {
        if (!take(wanted)) {
            fail(fmt::format("no '{}'", wanted));
        }
    }

    JsonValue readValue(int depth)
    {
        if (depth > kMaxDepth || ++values_ > kMaxValues) {
            fail(depth > kMaxDepth ? "too many levels" : "too many values");
        }
        JsonValue value;
        if (take('{')) {
            value.kind = JsonValue::Kind::object;
            readMembers(value, depth);
        } else if (take('[')) {
            value.kind = JsonValue::Kind::array;
            readItems(value, depth);
        } else if (peek() == '"') {
            value.kind = JsonValue::Kind::string;
            value.text = readString();
        } else {
            readWord(value);
        }
        return value;
    }

    void readItems(JsonValue& array, int depth)
    {
        if (take(']')) {
            return;
        }
        do {
            array.items.push_back(readValue(depth + 1));
        } while (take(','));
        expect(']');
    }

    void readMembers(JsonValue& object, int depth)
    {
        if (take('}')) {
            return;
        }
        do {
            skipBlanks();
            object.keys.push_back(readString());
            expect(':');
            object.items.push_back(readValue(depth + 1));
        } while (take(',') && object.keys.size() < kMaxKeys);
        expect('}');
        std::vector<std::string> sorted = object.keys;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
            fail("an object with a key twice, ending");
        }
    }

    std::string readString()
    {
        if (peek() != '"') {
            fail("no string");
        }
        ++at_;
        std::string out;
        while (true) {
            // Runs without escapes in one go: a buffer in the text has megabytes.
            std::size_t end = at_;
            while (end < text_.size() && text_[end] != '"' && text_[end] != '\\' &&
                   static_cast<unsigned char>(text_[end]) >= ' ') {
                ++end;
            }
            out += text_.substr(at_, end - at_);
            at_ = end;
            const char c = peek();
            ++at_;
            if (c == '"' && end < text_.size()) {
                return out;
            }
            if (c != '\\') {
                fail("an unfinished string");
            }
            readEscape(out);
        }
    }

    void readEscape(std::string& out)
    {
        constexpr std::string_view kLetters = "\"\\/bfnrt";
        constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
        const char letter = peek();
        ++at_;
        const std::size_t which = kLetters.find(letter);
        if (which != kLetters.npos) {
            out += kMeanings[which];
        } else if (letter == 'u') {
            std::uint32_t code = readHex();
            if (code >= 0xd800 && code < 0xdc00 &&
                text_.substr(std::min(at_, text_.size()), 2) == "\\u") {
                at_ += 2;
                code = 0x10000 + ((code - 0xd800) << 10) + (readHex() - 0xdc00);
            }
            appendUtf8(code, out);
        } else {
            fail("an unknown escape");
        }
    }

    std::uint32_t readHex()
    {
        const std::string_view digits = text_.substr(std::min(at_, text_.size()), 4);
        std::uint32_t code = 0;
        const auto [stop, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (error != std::errc{} || digits.size() < 4 || stop != digits.data() + 4) {
            fail("an unfinished escape");
        }
        at_ += 4;
        return code;
    }

    void appendUtf8(std::uint32_t code, std::string& out) const
    {
        if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) {
            fail("half a surrogate pair");
        }
        if (code < 0x80) {
            out += static_cast<char>(code);
            return;
        }
        const int extra = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
        const std::uint32_t lead = extra == 1 ? 0xc0 : extra == 2 ? 0xe0 : 0xf0;
        out += static_cast<char>(lead | (code >> (6 * extra)));
        for (int k = extra - 1; k >= 0; --k) {
            out += static_cast<char>(0x80 | ((code >> (6 * k)) & 0x3f));
        }
    }

    /// A number, true, false or null.
    void readWord(JsonValue& value)
    {
        const std::size_t end = std::min(
            text_.find_first_not_of("+-.0123456789abcdefghijklmnopqrstuvwxyzE", at_), text_.size());
        const std::string_view word = text_.substr(at_, end - at_);
        if (word == "null") {
            value.kind = JsonValue::Kind::null;
        } else if (word == "true" || word == "false") {
            value.kind = JsonValue::Kind::boolean;
            value.number = word == "true" ? 1.0 : 0.0;
        } else {
            value.kind = JsonValue::Kind::number;
            const auto [stop, error] =
                std::from_chars(word.data(), word.data() + word.size(), value.number);
            if (word.empty() || error != std::errc{} || stop != word.data() + word.size() ||
                !std::isfinite(value.number)) {
                fail("no JSON value");
            }
        }
        at_ = end;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t values_ = 0;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const
{
    if (kind != Kind::object) {
        return nullptr;
    }
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

std::optional<std::size_t> JsonValue::asIndex() const
{
    constexpr double kLimit = 9007199254740992.0;  // 2^53
    if (kind != Kind::number || !(number >= 0.0) || number > kLimit ||
        number != std::floor(number)) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(number);
}

JsonValue parseJson(std::string_view text)
{
    return JsonParser(text).parse();
}

}  // namespace sandflow
