#pragma once

#include <charconv>
#include <string>

namespace sandflow {

/// Appends the shortest text that reads back as the same number; a point whatever the locale.
template <typename Number>
void appendNumber(std::string& text, Number number)
{
    char buffer[32];  // the longest double takes 24 characters
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
    text.append(buffer, end);
}

}  // namespace sandflow
