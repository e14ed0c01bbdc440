#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// The statistics of a run, one row per frame, as read from its frames.csv. Columns are found by
/// name, so that a later version may add some.
class RunTable {
public:
    /// Reads a comma-separated file whose first line names the columns; every other field is a
    /// number. Throws InputError with path and line for anything else, and if it cannot be opened.
    static RunTable read(const std::filesystem::path& path);

    /// frames.csv of a run folder.
    static RunTable readRun(const std::filesystem::path& folder)
    {
        return read(folder / "frames.csv");
    }

    const std::filesystem::path& path() const { return path_; }
    std::size_t rowCount() const { return rowCount_; }
    const std::vector<std::string>& names() const { return names_; }

    bool has(std::string_view column) const;
    /// One value per frame, in the unit that the column's name ends in. Throws InputError if there
    /// is no such column.
    const std::vector<double>& column(std::string_view name) const;

private:
    void readHeader(std::string_view line);
    void readRow(std::string_view line, std::size_t lineNumber);

    std::filesystem::path path_;
    std::vector<std::string> names_;
    std::vector<std::vector<double>> values_;  ///< by column
    std::size_t rowCount_ = 0;
};

/// Mean of a column over the frames with from <= time_s <= until, both in s of simulated time.
/// Throws InputError if there is no such column or no such frame.
double meanOver(const RunTable& table, std::string_view column, double from, double until);

}  // namespace sandflow
