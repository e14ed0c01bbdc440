#include "measure/run_table.h"

#include "core/errors.h"

#include <algorithm>
#include <charconv>
#include <fstream>

namespace sandflow {
namespace {

std::string_view trim(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> splitFields(std::string_view line)
{
    std::vector<std::string_view> fields;
    std::size_t begin = 0;
    while (true) {
        const std::size_t comma = line.find(',', begin);
        fields.push_back(trim(line.substr(begin, comma - begin)));
        if (comma == std::string_view::npos) {
            return fields;
        }
        begin = comma + 1;
    }
}

}  // namespace

RunTable RunTable::read(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::string line;
    // A folder opens, but does not read.
    if (!file || !(std::getline(file, line) || file.eof())) {
        throw InputError(fmt::format("{}: cannot be read", path.string()));
    }
    RunTable table;
    table.path_ = path;
    table.readHeader(line);
    for (std::size_t lineNumber = 2; std::getline(file, line); ++lineNumber) {
        if (!trim(line).empty()) {
            table.readRow(line, lineNumber);
        }
    }
    if (file.bad()) {
        throw SystemError(fmt::format("{}: reading failed half way", path.string()));
    }
    return table;
}

void RunTable::readHeader(std::string_view line)
{
    for (const std::string_view name : splitFields(line)) {
        if (name.empty()) {
            throw InputError(
                fmt::format("{}:1: expected the names of the columns", path_.string()));
        }
        if (has(name)) {
            throw InputError(
                fmt::format("{}:1: column \"{}\" is there twice", path_.string(), name));
        }
        names_.emplace_back(name);
    }
    values_.resize(names_.size());
}

void RunTable::readRow(std::string_view line, std::size_t lineNumber)
{
    const std::vector<std::string_view> fields = splitFields(line);
    if (fields.size() != names_.size()) {
        throw InputError(fmt::format("{}:{}: expected {} values, found {}", path_.string(),
                                     lineNumber, names_.size(), fields.size()));
    }
    for (std::size_t c = 0; c < fields.size(); ++c) {
        double value = 0.0;
        const char* end = fields[c].data() + fields[c].size();
        const auto [stop, code] = std::from_chars(fields[c].data(), end, value);
        if (code != std::errc{} || stop != end) {
            throw InputError(fmt::format("{}:{}: column \"{}\" holds \"{}\", which is no number",
                                         path_.string(), lineNumber, names_[c], fields[c]));
        }
        values_[c].push_back(value);
    }
    ++rowCount_;
}

bool RunTable::has(std::string_view column) const
{
    return std::find(names_.begin(), names_.end(), column) != names_.end();
}

const std::vector<double>& RunTable::column(std::string_view name) const
{
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
        throw InputError(fmt::format("{}: has no column \"{}\"", path_.string(), name));
    }
    return values_[static_cast<std::size_t>(found - names_.begin())];
}

double meanOver(const RunTable& table, std::string_view column, double from, double until)
{
    const std::vector<double>& values = table.column(column);
    const std::vector<double>& time = table.column("time_s");
    double sum = 0.0;
    std::size_t frames = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (time[n] >= from && time[n] <= until) {
            sum += values[n];
            ++frames;
        }
    }
    if (frames == 0) {
        throw InputError(fmt::format("{}: has no frame between {} s and {} s",
                                     table.path().string(), from, until));
    }
    return sum / static_cast<double>(frames);
}

}  // namespace sandflow
