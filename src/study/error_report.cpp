#include "study/error_report.h"

#include "io/json_writer.h"
#include "study/text_table.h"
#include "study/trial_csv.h"

#include <fmt/format.h>

#include <cmath>

namespace sandflow {
namespace {

std::string nameOf(ErrorMeasure measure)
{
    return measure == ErrorMeasure::radial ? "radial" : "cells";
}

std::string nameOf(StudyClock clock)
{
    return clock == StudyClock::wall ? "wall" : "processor";
}

/// Where a setting stands: "front", "front, knee", "same as default" or "".
std::string standingOf(const ErrorEvaluation& evaluation, std::size_t setting)
{
    if (evaluation.settings[setting].sameAsDefault) {
        return "same as default";
    }
    if (!evaluation.onFront(setting)) {
        return "";
    }
    return evaluation.knee == setting ? "front, knee" : "front";
}

std::vector<std::string> formatErrors(const HeapErrors& errors)
{
    return {fmt::format("{:.3f}", errors.radial), fmt::format("{:.3f}", errors.cells),
            errors.reposeDeg ? fmt::format("{:+.2f}", *errors.reposeDeg) : "none",
            fmt::format("{:+.2f}", errors.apex), fmt::format("{:+.2f}", errors.r90)};
}

std::vector<std::string> tableRow(const SettingFigures& figures, const std::string& standing)
{
    std::vector<std::string> row{labelOf(figures.setting)};
    if (figures.finished == 0) {
        row.insert(row.end(), {"", "", "", "", "", "", "failed: " + figures.message});
        return row;
    }
    row.push_back(fmt::format("{:.2f}", figures.cost));
    for (const std::string& text : formatErrors(figures.mean)) {
        row.push_back(text);
    }
    row.push_back(figures.failed > 0 ? fmt::format("failed with {} of {} seeds: {}", figures.failed,
                                                   figures.failed + figures.finished,
                                                   figures.message)
                                     : standing);
    return row;
}

std::string describeNoise(const ErrorEvaluation& evaluation)
{
    if (!evaluation.noise) {
        return "one seed says nothing about chance: take two or more\n";
    }
    return fmt::format(
        "by chance (2 sigma) two settings differ by up to {:.3f} d and {:.1f} % of the time\n",
        evaluation.noise->error, 100.0 * std::expm1(evaluation.noise->logCost));
}

std::string describeFront(const ErrorEvaluation& evaluation)
{
    std::string text = "front:";
    for (const std::size_t k : evaluation.front) {
        const SettingFigures& figures = evaluation.settings[k];
        text += fmt::format("{} {} ({:.2f}, {:.3f} d)", k == evaluation.front.front() ? "" : ",",
                            labelOf(figures.setting), figures.cost, figures.error);
    }
    text += "\nknee: ";
    return text + (evaluation.knee ? labelOf(evaluation.settings[*evaluation.knee].setting)
                                   : "none: the front does not bend") + "\n";
}

std::string describeVerdicts(const ErrorEvaluation& evaluation)
{
    const SettingFigures& shipped = evaluation.settings.front();
    std::string text = fmt::format("default: {:.3f} d at 1.00; cheaper and better, or as good in "
                                   "one, is:\n",
                                   shipped.error);
    for (const ApproximationVerdict& verdict : evaluation.verdicts) {
        if (!verdict.better) {
            text += fmt::format("  {:<18} none\n", verdict.approximation);
            continue;
        }
        const SettingFigures& better = evaluation.settings[*verdict.better];
        text += fmt::format("  {:<18} {}: {:.3f} d at {:.2f}, {}\n", verdict.approximation,
                            labelOf(better.setting), better.error, better.cost,
                            verdict.clearly ? "clearly" : "within the noise");
    }
    return text;
}

void writeNumber(JsonWriter& json, const char* name, const std::optional<double>& number)
{
    json.key(name);
    if (number) {
        json.value(*number);
    } else {
        json.null();
    }
}

void writeErrors(JsonWriter& json, const HeapErrors& errors)
{
    json.member("radial_d", errors.radial).member("cells_d", errors.cells);
    writeNumber(json, "repose_deg", errors.reposeDeg);
    json.member("apex_d", errors.apex).member("r90_percent", errors.r90);
}

void writeSetting(JsonWriter& json, const SettingFigures& figures, bool front, bool knee)
{
    json.beginObject();
    json.member("approximation", figures.setting.approximation);
    json.member("value", figures.setting.value);
    json.key("set").beginArray();
    for (const std::string& text : figures.setting.overrides) {
        json.value(text);
    }
    json.endArray();
    json.member("finished", figures.finished).member("failed", figures.failed);
    if (!figures.message.empty()) {
        json.member("message", figures.message);
    }
    if (figures.finished > 0) {
        json.member("seconds", figures.seconds).member("cost", figures.cost);
        json.member("error_d", figures.error).member("error_low_d", figures.errorLow);
        json.member("error_high_d", figures.errorHigh);
        writeErrors(json, figures.mean);
    }
    json.member("on_front", front).member("knee", knee).endObject();
}

}  // namespace

std::string describeErrors(const ErrorEvaluation& evaluation)
{
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        rows.push_back(tableRow(evaluation.settings[k], standingOf(evaluation, k)));
    }
    rows.push_back(tableRow(evaluation.reference, evaluation.reference.setting.value));
    if (evaluation.referenceNoise) {
        std::vector<std::string> row{"two references", ""};
        for (const std::string& text : formatErrors(*evaluation.referenceNoise)) {
            row.push_back(text);
        }
        row.push_back("of different seeds, |difference|");
        rows.push_back(row);
    }
    std::string text = formatTable({"setting", "time", "radial", "cells", "repose", "apex", "r90",
                                    ""},
                                   rows);
    text += fmt::format(
        "\ntime: {} time over the default's ({:.1f} s), median of {} seed{}; mean |dH| by annuli "
        "and on cells of 5 d, apex: d; repose: deg; r90: %\n",
        nameOf(evaluation.clock), evaluation.settings.front().seconds, evaluation.seeds.size(),
        evaluation.seeds.size() == 1 ? "" : "s");
    text += fmt::format("the error that counts: {}\n", nameOf(evaluation.measure));
    return text + describeNoise(evaluation) + describeFront(evaluation) +
           describeVerdicts(evaluation);
}

std::string errorsAsJson(const ErrorEvaluation& evaluation, const std::string& scene,
                         const std::string& version, int threads)
{
    JsonWriter json;
    json.beginObject().key("error").beginObject();
    json.member("scene", scene).member("version", version).member("threads", threads);
    json.member("measure", nameOf(evaluation.measure)).member("clock", nameOf(evaluation.clock));
    json.key("seeds").beginArray();
    for (const std::uint64_t seed : evaluation.seeds) {
        json.value(seed);
    }
    json.endArray();
    json.key("settings").beginArray();
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        writeSetting(json, evaluation.settings[k], evaluation.onFront(k), evaluation.knee == k);
    }
    json.endArray().key("reference");
    writeSetting(json, evaluation.reference, false, false);
    json.key("two_references");
    if (evaluation.referenceNoise) {
        json.beginObject();
        writeErrors(json, *evaluation.referenceNoise);
        json.endObject();
    } else {
        json.null();
    }
    json.key("noise").beginObject();
    writeNumber(json, "error_d",
                evaluation.noise ? std::optional(evaluation.noise->error) : std::nullopt);
    writeNumber(json, "log_cost",
                evaluation.noise ? std::optional(evaluation.noise->logCost) : std::nullopt);
    json.endObject().key("verdicts").beginArray();
    for (const ApproximationVerdict& verdict : evaluation.verdicts) {
        json.beginObject().member("approximation", verdict.approximation).key("better");
        if (verdict.better) {
            json.value(labelOf(evaluation.settings[*verdict.better].setting));
        } else {
            json.null();
        }
        json.member("clearly", verdict.clearly).endObject();
    }
    json.endArray().endObject().endObject();
    return json.text();
}

std::string errorsAsCsv(const ErrorEvaluation& evaluation)
{
    std::string text = formatCsvLine({"approximation", "value", "finished", "failed", "seconds",
                                      "time_ratio", "error_d", "error_low_d", "error_high_d",
                                      "radial_d", "cells_d", "repose_deg", "apex_d", "r90_percent",
                                      "standing"});
    const auto add = [&](const SettingFigures& f, const std::string& standing) {
        std::vector<std::string> fields{f.setting.approximation, f.setting.value,
                                        fmt::format("{}", f.finished),
                                        fmt::format("{}", f.failed)};
        std::vector<std::optional<double>> numbers(10);
        if (f.finished > 0) {
            numbers = {f.seconds,     f.cost,       f.error,          f.errorLow,  f.errorHigh,
                       f.mean.radial, f.mean.cells, f.mean.reposeDeg, f.mean.apex, f.mean.r90};
        }
        for (const std::optional<double>& number : numbers) {
            fields.push_back(number ? fmt::format("{:.5g}", *number) : "");
        }
        fields.push_back(standing);
        text += formatCsvLine(fields);
    };
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        add(evaluation.settings[k], standingOf(evaluation, k));
    }
    add(evaluation.reference, "");
    return text;
}

}  // namespace sandflow
