#pragma once

#include <cctype>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sandflow {

/// The scalars of one JSON text by their path, "kernel.mps" or "emitters[0].name", as text (strings
/// without quotes). Strict: throws std::runtime_error for anything that is not JSON.
class JsonScalars {
public:
    explicit JsonScalars(std::string_view text) : text_(text)
    {
        readValue("");
        skipSpace();
        if (at_ != text_.size()) {
            fail("text behind the value");
        }
    }

    const std::string& text(const std::string& path) const
    {
        const auto found = scalars_.find(path);
        if (found == scalars_.end()) {
            throw std::runtime_error("no " + path + " in the JSON");
        }
        return found->second;
    }

    double number(const std::string& path) const
    {
        const std::string& value = text(path);
        double number = 0.0;
        const char* end = value.data() + value.size();
        const auto [stop, code] = std::from_chars(value.data(), end, number);
        if (code != std::errc{} || stop != end) {
            throw std::runtime_error(path + " is no number but " + value);
        }
        return number;
    }

    bool has(const std::string& path) const { return scalars_.count(path) != 0; }

private:
    [[noreturn]] void fail(const std::string& what) const
    {
        throw std::runtime_error("JSON: " + what + " at byte " + std::to_string(at_));
    }

    void skipSpace()
    {
        while (at_ < text_.size() && std::string_view(" \n\r\t").find(text_[at_]) != text_.npos) {
            ++at_;
        }
    }

    bool take(char wanted)
    {
        skipSpace();
        if (at_ < text_.size() && text_[at_] == wanted) {
            ++at_;
            return true;
        }
        return false;
    }

    void expect(char wanted)
    {
        if (!take(wanted)) {
            fail(std::string("expected ") + wanted);
        }
    }

    /// Escapes are kept as they stand, but for the quote and the backslash.
    std::string readString()
    {
        std::string out;
        expect('"');
        while (at_ < text_.size() && text_[at_] != '"') {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) {
                ++at_;
                out += text_[at_] == '"' || text_[at_] == '\\' ? "" : "\\";
            }
            out += text_[at_++];
        }
        expect('"');
        return out;
    }

    void readValue(const std::string& path)
    {
        skipSpace();
        if (take('{')) {
            if (take('}')) {
                return;
            }
            do {
                const std::string name = readString();
                expect(':');
                readValue(path.empty() ? name : path + "." + name);
            } while (take(','));
            expect('}');
        } else if (take('[')) {
            if (take(']')) {
                return;
            }
            std::size_t index = 0;
            do {
                readValue(path + "[" + std::to_string(index++) + "]");
            } while (take(','));
            expect(']');
        } else if (at_ < text_.size() && text_[at_] == '"') {
            scalars_[path] = readString();
        } else {
            scalars_[path] = readWord();
        }
    }

    /// A number, true, false or null.
    std::string readWord()
    {
        const std::size_t begin = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-' ||
                text_[at_] == '+' || text_[at_] == '.')) {
            ++at_;
        }
        const std::string word(text_.substr(begin, at_ - begin));
        double number = 0.0;
        const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), number);
        const bool isNumber = !word.empty() && code == std::errc{} &&
                              stop == word.data() + word.size() && word.back() != 'n' &&
                              word.back() != 'f';
        if (!isNumber && word != "true" && word != "false" && word != "null") {
            fail("expected a value, found \"" + word + "\"");
        }
        return word;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::map<std::string, std::string> scalars_;
};

}  // namespace sandflow
