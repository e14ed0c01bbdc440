#include "study/error_trial.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "study/trial_csv.h"

#include <charconv>

namespace sandflow {
namespace {

std::string joinOverrides(const std::vector<std::string>& overrides)
{
    std::string text;
    for (const std::string& one : overrides) {
        text += (text.empty() ? "--set " : " --set ") + one;
    }
    return text;
}

std::vector<std::string> splitOverrides(const std::string& text)
{
    constexpr std::string_view kOption = "--set ";
    std::vector<std::string> overrides;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = at + kOption.size();
        const std::size_t next = text.find(" --set ", begin);
        overrides.push_back(text.substr(begin, next == std::string::npos ? next : next - begin));
        at = next == std::string::npos ? text.size() : next + 1;
    }
    return overrides;
}

/// Takes the fields of a row one by one.
class RowReader {
public:
    RowReader(const std::string& path, std::size_t line, const std::vector<std::string>& fields)
        : path_(path), line_(line), fields_(fields)
    {
    }

    const std::string& text() { return fields_[at_++]; }

    template <class Number>
    Number number()
    {
        Number value{};
        const std::string& field = fields_[at_];
        const auto [stop, code] =
            std::from_chars(field.data(), field.data() + field.size(), value);
        if (code != std::errc{} || stop != field.data() + field.size()) {
            fail(fmt::format("\"{}\" is not a number", field));
        }
        ++at_;
        return value;
    }

    std::optional<double> optionalNumber()
    {
        if (fields_[at_].empty()) {
            ++at_;
            return std::nullopt;
        }
        return number<double>();
    }

    TrialEnd end()
    {
        for (const TrialEnd end : {TrialEnd::finished, TrialEnd::stopped, TrialEnd::refused,
                                   TrialEnd::broke}) {
            if (fields_[at_] == nameOf(end)) {
                ++at_;
                return end;
            }
        }
        fail(fmt::format("\"{}\" is no end of a trial", fields_[at_]));
    }

private:
    [[noreturn]] void fail(const std::string& problem) const
    {
        throw InputError(fmt::format("{}:{}: {}: {}", path_, line_, errorTrialColumns()[at_],
                                     problem));
    }

    const std::string& path_;
    std::size_t line_;
    const std::vector<std::string>& fields_;
    std::size_t at_ = 0;
};

}  // namespace

HeapErrors errorsOf(const HeapComparison& comparison)
{
    return {comparison.radial.mean, comparison.cells.mean, comparison.reposeDifference,
            comparison.apexDifference, comparison.r90Difference};
}

const std::vector<std::string>& errorTrialColumns()
{
    static const std::vector<std::string> kColumns{
        "approximation", "value",       "seed",       "end",     "wall_s",
        "processor_s",   "steps",       "grain_steps", "radial_d", "cells_d",
        "repose_deg",    "apex_d",      "r90_percent", "set",      "message"};
    return kColumns;
}

std::vector<std::string> errorTrialFields(const ErrorTrial& t)
{
    return {t.setting.approximation,
            t.setting.value,
            fmt::format("{}", t.seed),
            nameOf(t.end),
            csvNumber(t.wallSeconds),
            csvNumber(t.processorSeconds),
            fmt::format("{}", t.steps),
            fmt::format("{}", t.grainSteps),
            csvNumber(t.errors.radial),
            csvNumber(t.errors.cells),
            t.errors.reposeDeg ? csvNumber(*t.errors.reposeDeg) : "",
            csvNumber(t.errors.apex),
            csvNumber(t.errors.r90),
            joinOverrides(t.setting.overrides),
            t.message};
}

std::vector<ErrorTrial> readErrorTrials(const std::string& path)
{
    const std::vector<std::vector<std::string>> rows = parseCsv(readWholeFile(path));
    if (rows.empty() || rows.front() != errorTrialColumns()) {
        throw InputError(fmt::format("{} is not a table of trials of this version: its columns "
                                     "differ",
                                     path));
    }
    std::vector<ErrorTrial> trials;
    for (std::size_t k = 1; k < rows.size(); ++k) {
        if (rows[k].size() != errorTrialColumns().size()) {
            throw InputError(fmt::format("{}: row {} has {} fields, expected {}", path, k,
                                         rows[k].size(), errorTrialColumns().size()));
        }
        RowReader row(path, k + 1, rows[k]);
        ErrorTrial t;
        t.setting.approximation = row.text();
        t.setting.value = row.text();
        t.seed = row.number<std::uint64_t>();
        t.end = row.end();
        t.wallSeconds = row.number<double>();
        t.processorSeconds = row.number<double>();
        t.steps = row.number<std::uint64_t>();
        t.grainSteps = row.number<std::uint64_t>();
        t.errors.radial = row.number<double>();
        t.errors.cells = row.number<double>();
        t.errors.reposeDeg = row.optionalNumber();
        t.errors.apex = row.number<double>();
        t.errors.r90 = row.number<double>();
        t.setting.overrides = splitOverrides(row.text());
        t.message = row.text();
        trials.push_back(std::move(t));
    }
    return trials;
}

}  // namespace sandflow
