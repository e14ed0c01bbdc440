#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// The lines of a text, which may end in LF, CR LF or CR.
class TextLines {
public:
    explicit TextLines(std::string_view text) : text_(text) {}

    /// Goes to the next line and splits it at blanks; false at the end.
    bool next();
    /// Goes on to the next line with a word in it.
    bool nextWithWords();
    const std::vector<std::string_view>& words() const { return words_; }
    std::size_t number() const { return number_; }  ///< of the line, from 1
    /// Whether the last line read so far ended in a line break: a file cut short does not.
    bool endedInBreak() const { return endedInBreak_; }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t number_ = 0;
    bool endedInBreak_ = true;
    std::vector<std::string_view> words_;
};

/// The text without a UTF-8 byte order mark.
std::string_view withoutMark(std::string_view text);

/// The whole word as a decimal number, nan and inf included, or nothing.
std::optional<double> parseReal(std::string_view word);
/// The whole word as a decimal integer, or nothing.
std::optional<std::int64_t> parseInteger(std::string_view word);

/// A word of a file for a message: at most 40 characters, no control characters.
std::string quoteWord(std::string_view word);

}  // namespace sandflow
