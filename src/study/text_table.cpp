#include "study/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace sandflow {

std::string formatTable(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows)
{
    std::vector<std::size_t> width;
    const auto widen = [&width](const std::vector<std::string>& row) {
        width.resize(std::max(width.size(), row.size()));
        for (std::size_t c = 0; c < row.size(); ++c) {
            width[c] = std::max(width[c], row[c].size());
        }
    };
    widen(header);
    std::for_each(rows.begin(), rows.end(), widen);

    std::string text;
    const auto add = [&](const std::vector<std::string>& row) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            text += c == 0 ? fmt::format("{:<{}}", row[c], width[c])
                           : fmt::format("  {:>{}}", row[c], width[c]);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    };
    add(header);
    std::for_each(rows.begin(), rows.end(), add);
    return text;
}

}  // namespace sandflow
