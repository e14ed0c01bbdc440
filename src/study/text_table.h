#pragma once

#include <string>
#include <vector>

namespace sandflow {

/// A table for people: columns as wide as their longest entry and two blanks apart, the first
/// flush left, the others flush right, no blanks at the end of a line. A row may be shorter than
/// the header.
std::string formatTable(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows);

}  // namespace sandflow
