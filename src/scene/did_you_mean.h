#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// Steps from one word to the other: insert, remove or replace a letter, or swap two neighbours
/// (optimal string alignment). Case, '-' and '_' make no difference.
int editDistance(std::string_view from, std::string_view to);

/// The nearest of the candidates (the first of equals), or "" when none is near enough to be a slip
/// of the pen: two steps, or one in a word of three letters or less.
std::string findNearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace sandflow
