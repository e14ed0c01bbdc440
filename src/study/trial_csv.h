#pragma once

#include <string>
#include <vector>

namespace sandflow {

/// A line of a CSV file (RFC 4180), its newline included: a field that holds a comma, a quote or a
/// line break is put in quotes.
std::string formatCsvLine(const std::vector<std::string>& fields);

/// The fields of each line of a CSV file, as formatCsvLine wrote them. A last line without its line
/// break, written when the program was ended, is left out.
std::vector<std::vector<std::string>> parseCsv(const std::string& text);

/// Rows of a study, in the file as soon as append() returns, each by one write at the file's end: a
/// study that is interrupted keeps what it has found.
class TrialCsv {
public:
    /// Starts the file anew, with a header. Throws SystemError.
    TrialCsv(const std::string& path, const std::vector<std::string>& columns);
    ~TrialCsv();
    TrialCsv(const TrialCsv&) = delete;
    TrialCsv& operator=(const TrialCsv&) = delete;

    /// One field per column. Throws SystemError when the disk refuses it.
    void append(const std::vector<std::string>& fields);

private:
    std::string path_;
    std::size_t columns_;
    int descriptor_ = -1;
};

/// The number with the fewest digits that read back as the same; a point whatever the locale.
std::string csvNumber(double number);

}  // namespace sandflow
