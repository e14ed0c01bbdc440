#include "scene/did_you_mean.h"

#include <algorithm>
#include <cstdlib>

namespace sandflow {
namespace {

char foldLetter(char letter)
{
    if (letter >= 'A' && letter <= 'Z') {
        return static_cast<char>(letter - 'A' + 'a');
    }
    return letter == '-' ? '_' : letter;
}

bool sameLetter(char a, char b)
{
    return foldLetter(a) == foldLetter(b);
}

}  // namespace

int editDistance(std::string_view from, std::string_view to)
{
    // rows[i][j]: distance of the first i letters of `from` to the first j of `to`.
    std::vector<std::vector<int>> rows(from.size() + 1, std::vector<int>(to.size() + 1));
    for (std::size_t i = 0; i <= from.size(); ++i) {
        for (std::size_t j = 0; j <= to.size(); ++j) {
            if (i == 0 || j == 0) {
                rows[i][j] = static_cast<int>(i + j);
                continue;
            }
            const int replace = rows[i - 1][j - 1] + (sameLetter(from[i - 1], to[j - 1]) ? 0 : 1);
            rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, replace});
            if (i > 1 && j > 1 && sameLetter(from[i - 1], to[j - 2]) &&
                sameLetter(from[i - 2], to[j - 1])) {
                rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
            }
        }
    }
    return rows[from.size()][to.size()];
}

std::string findNearest(std::string_view word, const std::vector<std::string>& candidates)
{
    int best = word.size() <= 3 ? 1 : 2;
    const std::string* nearest = nullptr;
    for (const std::string& candidate : candidates) {
        // A cheap bound first: the word may be megabytes of nonsense.
        const auto longer = std::max(word.size(), candidate.size());
        const auto shorter = std::min(word.size(), candidate.size());
        if (longer - shorter > 2) {
            continue;
        }
        const int distance = editDistance(word, candidate);
        if (distance < best || (distance == best && nearest == nullptr)) {
            best = distance;
            nearest = &candidate;
        }
    }
    return nearest == nullptr ? "" : *nearest;
}

}  // namespace sandflow
