#include "study/error_figures.h"

#include "core/errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sandflow {
namespace {

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double meanOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// One number of a trial for each seed.
using BySeed = std::map<std::uint64_t, double>;

std::vector<double> valuesOf(const BySeed& bySeed)
{
    std::vector<double> values;
    for (const auto& [seed, value] : bySeed) {
        values.push_back(value);
    }
    return values;
}

/// All trials of one setting.
struct TrialGroup {
    ErrorSetting setting;
    std::vector<const ErrorTrial*> trials;
    BySeed cost, error;  ///< of those that finished; cost relative to the default's
};

std::vector<TrialGroup> groupTrials(const std::vector<ErrorTrial>& trials)
{
    std::vector<TrialGroup> groups;
    for (const ErrorTrial& trial : trials) {
        const auto found = std::find_if(groups.begin(), groups.end(), [&](const TrialGroup& g) {
            return g.setting.approximation == trial.setting.approximation &&
                   g.setting.value == trial.setting.value;
        });
        TrialGroup& group = found != groups.end() ? *found
                                                  : groups.emplace_back(TrialGroup{trial.setting,
                                                                                   {}, {}, {}});
        group.trials.push_back(&trial);
    }
    return groups;
}

HeapErrors averageErrors(const std::vector<HeapErrors>& all)
{
    const auto average = [&](double HeapErrors::*field) {
        double sum = 0.0;
        for (const HeapErrors& one : all) {
            sum += one.*field;
        }
        return sum / static_cast<double>(all.size());
    };
    HeapErrors mean{average(&HeapErrors::radial), average(&HeapErrors::cells), std::nullopt,
                    average(&HeapErrors::apex), average(&HeapErrors::r90)};
    double sum = 0.0;
    std::size_t count = 0;
    for (const HeapErrors& one : all) {
        sum += one.reposeDeg.value_or(0.0);
        count += one.reposeDeg ? 1 : 0;
    }
    if (count > 0) {
        mean.reposeDeg = sum / static_cast<double>(count);
    }
    return mean;
}

SettingFigures makeFigures(const TrialGroup& group, StudyClock clock)
{
    SettingFigures figures;
    figures.setting = group.setting;
    std::vector<double> seconds;
    std::vector<HeapErrors> errors;
    for (const ErrorTrial* trial : group.trials) {
        if (trial->end != TrialEnd::finished) {
            figures.message = figures.failed++ == 0 ? trial->message : figures.message;
        } else if (group.cost.count(trial->seed) > 0) {
            seconds.push_back(clock == StudyClock::wall ? trial->wallSeconds
                                                        : trial->processorSeconds);
            errors.push_back(trial->errors);
        }
    }
    figures.finished = seconds.size();
    if (figures.finished > 0) {
        const std::vector<double> values = valuesOf(group.error);
        figures.seconds = medianOf(seconds);
        figures.cost = medianOf(valuesOf(group.cost));
        figures.error = meanOf(values);
        figures.errorLow = *std::min_element(values.begin(), values.end());
        figures.errorHigh = *std::max_element(values.begin(), values.end());
        figures.mean = averageErrors(errors);
    }
    return figures;
}

/// Standard deviation of what neither setting nor seed explains.
double residualDeviation(const std::vector<const BySeed*>& rows)
{
    const std::size_t seeds = rows.front()->size();
    std::vector<double> shift(seeds, 0.0);
    std::vector<double> mean;
    for (const BySeed* row : rows) {
        const std::vector<double> values = valuesOf(*row);
        mean.push_back(meanOf(values));
        for (std::size_t s = 0; s < seeds; ++s) {
            shift[s] += (values[s] - mean.back()) / static_cast<double>(rows.size());
        }
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const std::vector<double> values = valuesOf(*rows[k]);
        for (std::size_t s = 0; s < seeds; ++s) {
            const double residual = values[s] - mean[k] - shift[s];
            sum += residual * residual;
        }
    }
    return std::sqrt(sum / static_cast<double>((rows.size() - 1) * (seeds - 1)));
}

std::optional<ChoiceNoise> estimateNoise(const std::vector<TrialGroup>& groups, std::size_t seeds)
{
    std::vector<BySeed> logCosts;
    std::vector<const BySeed*> errors, costs;
    for (const TrialGroup& group : groups) {
        if (group.error.size() == seeds) {
            errors.push_back(&group.error);
            logCosts.push_back(group.cost);
            for (auto& [seed, cost] : logCosts.back()) {
                cost = std::log(cost);
            }
        }
    }
    if (seeds < 2 || errors.size() < 2) {
        return std::nullopt;
    }
    for (const BySeed& row : logCosts) {
        costs.push_back(&row);
    }
    const double factor = 2.0 * std::sqrt(2.0 / static_cast<double>(seeds));
    return ChoiceNoise{factor * residualDeviation(costs), factor * residualDeviation(errors)};
}

std::vector<ApproximationVerdict> judge(const std::vector<SettingFigures>& settings,
                                        const ChoiceNoise& noise)
{
    std::vector<ApproximationVerdict> verdicts;
    const CostAndError shipped{settings.front().cost, settings.front().error};
    for (std::size_t k = 1; k < settings.size(); ++k) {
        if (!settings[k].counts()) {
            continue;
        }
        const std::string& name = settings[k].setting.approximation;
        if (verdicts.empty() || verdicts.back().approximation != name) {
            verdicts.push_back({name, std::nullopt, false});
        }
        ApproximationVerdict& verdict = verdicts.back();
        const CostAndError other{settings[k].cost, settings[k].error};
        const bool clearly = dominatesClearly(other, shipped, noise);
        // Whatever beats it clearly counts before what may be chance.
        if (dominates(other, shipped) &&
            (!verdict.better || clearly > verdict.clearly ||
             (clearly == verdict.clearly && other.error < settings[*verdict.better].error))) {
            verdict.better = k;
            verdict.clearly = clearly;
        }
    }
    return verdicts;
}

HeapErrors magnitudes(HeapErrors errors)
{
    errors.apex = std::abs(errors.apex);
    errors.r90 = std::abs(errors.r90);
    if (errors.reposeDeg) {
        errors.reposeDeg = std::abs(*errors.reposeDeg);
    }
    return errors;
}

double measureOf(const HeapErrors& errors, ErrorMeasure measure)
{
    return measure == ErrorMeasure::radial ? errors.radial : errors.cells;
}

/// Time of the default for each seed that also has a reference.
BySeed findDefaultTimes(const std::vector<ErrorTrial>& trials, StudyClock clock)
{
    BySeed times;
    for (const ErrorTrial& trial : trials) {
        const bool referenced =
            std::any_of(trials.begin(), trials.end(), [&](const ErrorTrial& other) {
                return other.isReference() && other.end == TrialEnd::finished &&
                       other.seed == trial.seed;
            });
        if (trial.isDefault() && trial.end == TrialEnd::finished && referenced) {
            times[trial.seed] =
                clock == StudyClock::wall ? trial.wallSeconds : trial.processorSeconds;
        }
    }
    return times;
}

}  // namespace

bool ErrorEvaluation::onFront(std::size_t setting) const
{
    return std::find(front.begin(), front.end(), setting) != front.end();
}

std::optional<double> ErrorEvaluation::referenceScatter() const
{
    return referenceNoise ? std::optional(measureOf(*referenceNoise, measure)) : std::nullopt;
}

std::string labelOf(const ErrorSetting& setting)
{
    const bool saysItself =
        setting.approximation == "method" || setting.approximation == "precision";
    return saysItself              ? setting.value
           : setting.value.empty() ? setting.approximation
                                   : setting.approximation + " " + setting.value;
}

ErrorEvaluation evaluateErrors(const std::vector<ErrorTrial>& trials,
                               const std::vector<HeapErrors>& referencePairs, ErrorMeasure measure,
                               StudyClock clock)
{
    const BySeed defaultTime = findDefaultTimes(trials, clock);
    if (defaultTime.empty()) {
        throw InputError("no seed has both a reference and a default that finished: there is "
                         "nothing to compare");
    }
    std::vector<TrialGroup> groups = groupTrials(trials);
    for (TrialGroup& group : groups) {
        for (const ErrorTrial* trial : group.trials) {
            const auto time = defaultTime.find(trial->seed);
            if (trial->end == TrialEnd::finished && time != defaultTime.end()) {
                group.cost[trial->seed] =
                    (clock == StudyClock::wall ? trial->wallSeconds : trial->processorSeconds) /
                    time->second;
                group.error[trial->seed] = measureOf(trial->errors, measure);
            }
        }
    }

    ErrorEvaluation result;
    result.measure = measure;
    result.clock = clock;
    for (const auto& [seed, time] : defaultTime) {
        result.seeds.push_back(seed);
    }
    const auto takeOut = [&](const char* approximation) {
        const auto at = std::find_if(groups.begin(), groups.end(), [&](const TrialGroup& group) {
            return group.setting.approximation == approximation;
        });
        const TrialGroup group = *at;
        groups.erase(at);
        return group;
    };
    result.reference = makeFigures(takeOut(kReferenceSetting), clock);
    groups.insert(groups.begin(), takeOut(kDefaultSetting));
    for (const TrialGroup& group : groups) {
        result.settings.push_back(makeFigures(group, clock));
    }

    std::vector<HeapErrors> apart;
    std::transform(referencePairs.begin(), referencePairs.end(), std::back_inserter(apart),
                   magnitudes);
    if (!apart.empty()) {
        result.referenceNoise = averageErrors(apart);
    }
    result.noise = estimateNoise(groups, result.seeds.size());

    std::vector<CostAndError> choices;
    std::vector<std::size_t> settingOf;
    for (std::size_t k = 0; k < result.settings.size(); ++k) {
        if (result.settings[k].counts()) {
            choices.push_back({result.settings[k].cost, result.settings[k].error});
            settingOf.push_back(k);
        }
    }
    const std::vector<std::size_t> front = findParetoFront(choices);
    for (const std::size_t k : front) {
        result.front.push_back(settingOf[k]);
    }
    if (const auto knee = findKnee(choices, front)) {
        result.knee = settingOf[*knee];
    }
    result.verdicts = judge(result.settings, result.noise.value_or(ChoiceNoise{}));
    return result;
}

}  // namespace sandflow
