#include "study/trial_csv.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/number_text.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace sandflow {
namespace {

std::string quoteIfNeeded(const std::string& field)
{
    if (field.find_first_of(",\"\r\n") == std::string::npos) {
        return field;
    }
    std::string quoted = "\"";
    for (const char c : field) {
        quoted += c;
        if (c == '"') {
            quoted += c;
        }
    }
    return quoted + '"';
}

[[noreturn]] void failOn(const char* action, const std::string& path)
{
    throw SystemError(
        fmt::format("cannot {} {}: {}", action, path, std::generic_category().message(errno)));
}

}  // namespace

std::string formatCsvLine(const std::vector<std::string>& fields)
{
    std::string line;
    for (const std::string& field : fields) {
        line += &field == &fields.front() ? "" : ",";
        line += quoteIfNeeded(field);
    }
    return line + '\n';
}

std::vector<std::vector<std::string>> parseCsv(const std::string& text)
{
    std::vector<std::vector<std::string>> lines;
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (quoted && c == '"' && at + 1 < text.size() && text[at + 1] == '"') {
            fields.back() += c;
            ++at;
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == ',') {
            fields.emplace_back();
        } else if (!quoted && c == '\n') {
            lines.push_back(std::move(fields));
            fields.assign(1, "");
        } else {
            fields.back() += c;
        }
    }
    return lines;
}

std::string csvNumber(double number)
{
    std::string text;
    appendNumber(text, number);
    return text;
}

TrialCsv::TrialCsv(const std::string& path, const std::vector<std::string>& columns)
    : path_(path), columns_(columns.size())
{
    writeFileAtomically(path, formatCsvLine(columns));
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) {
        failOn("open", path);
    }
}

TrialCsv::~TrialCsv()
{
    ::close(descriptor_);
}

void TrialCsv::append(const std::vector<std::string>& fields)
{
    SAND_CHECK(fields.size() == columns_, "{}: {} fields for {} columns", path_, fields.size(),
               columns_);
    if (!writeAllBytes(descriptor_, formatCsvLine(fields))) {
        failOn("write", path_);
    }
}

}  // namespace sandflow
