#include "mesh/text_lines.h"

#include <algorithm>
#include <charconv>

namespace sandflow {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

void splitWords(std::string_view line, std::vector<std::string_view>& words)
{
    words.clear();
    std::size_t begin = line.find_first_not_of(kBlanks);
    while (begin != line.npos) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kBlanks, end);
    }
}

template <typename Number>
std::optional<Number> parseWhole(std::string_view word)
{
    // from_chars knows no plus sign.
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') {
        word.remove_prefix(1);
    }
    Number number{};
    const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (code != std::errc{} || stop != word.data() + word.size()) {
        return std::nullopt;
    }
    return number;
}

}  // namespace

bool TextLines::next()
{
    if (at_ >= text_.size()) {
        words_.clear();
        return false;
    }
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    splitWords(text_.substr(at_, end - at_), words_);
    endedInBreak_ = end < text_.size();
    at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    ++number_;
    return true;
}

bool TextLines::nextWithWords()
{
    while (next()) {
        if (!words_.empty()) {
            return true;
        }
    }
    return false;
}

std::string_view withoutMark(std::string_view text)
{
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::optional<double> parseReal(std::string_view word)
{
    return parseWhole<double>(word);
}

std::optional<std::int64_t> parseInteger(std::string_view word)
{
    return parseWhole<std::int64_t>(word);
}

std::string quoteWord(std::string_view word)
{
    constexpr std::size_t kLongest = 40;
    std::string quoted = "\"";
    for (const char c : word.substr(0, kLongest)) {
        const bool printable = c >= ' ' && c <= '~';
        quoted += printable ? c : '?';
    }
    return quoted + (word.size() > kLongest ? "...\"" : "\"");
}

}  // namespace sandflow
