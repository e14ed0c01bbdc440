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

double secondsOf(const ErrorTrial& trial, StudyClock clock)
{
    return clock == StudyClock::wall ? trial.wallSeconds : trial.processorSeconds;
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
    BySeed cost, error;         ///< of those that finished; cost relative to the default's
    bool sameAsDefault = true;  ///< every one that finished
};

std::vector<TrialGroup> groupTrials(const std::vector<ErrorTrial>& trials)
{
    std::vector<TrialGroup> groups;
    for (const ErrorTrial& trial : trials) {
        const auto found = std::find_if(groups.begin(), groups.end(), [&](const TrialGroup& g) {
            return g.setting.approximation == trial.setting.approximation &&
                   g.setting.value == trial.setting.value;
        });
        TrialGroup& group = found != groups.end() ? *found : groups.emplace_back();
        group.setting = trial.setting;
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
            seconds.push_back(secondsOf(*trial, clock));
            errors.push_back(trial->errors);
        }
    }
    figures.finished = group.cost.size();
    figures.sameAsDefault = group.sameAsDefault;
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
        if (group.error.size() == seeds && !group.sameAsDefault) {
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
        const std::string& name = settings[k].setting.approximation;
        if (verdicts.empty() || verdicts.back().approximation != name) {
            verdicts.push_back({name, std::nullopt, false});
        }
        if (!settings[k].counts()) {
            continue;
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

/// True if both did the same, step by step, as far as a row can tell. The heaps may differ by what
/// the places of buried grains are rounded to, which moves no figure by so much as this.
bool didTheSame(const ErrorTrial& a, const ErrorTrial& b)
{
    constexpr double kRounding = 1e-5;  // d, deg or %
    const auto areClose = [](double x, double y) { return std::abs(x - y) <= kRounding; };
    const HeapErrors& ea = a.errors;
    const HeapErrors& eb = b.errors;
    return a.steps == b.steps && a.grainSteps == b.grainSteps && areClose(ea.radial, eb.radial) &&
           areClose(ea.cells, eb.cells) && areClose(ea.apex, eb.apex) && areClose(ea.r90, eb.r90) &&
           areClose(ea.reposeDeg.value_or(0.0), eb.reposeDeg.value_or(0.0));
}

/// The trials of one seed in their order, and what the default takes at each place in it.
class SeedTrials {
public:
    void add(const ErrorTrial& trial) { trials_.push_back(&trial); }

    /// False if the default or the reference did not finish.
    bool complete() const
    {
        return defaultTrial() != nullptr &&
               std::any_of(trials_.begin(), trials_.end(), [](const ErrorTrial* t) {
                   return t->isReference() && t->end == TrialEnd::finished;
               });
    }

    /// The first that finished.
    const ErrorTrial* defaultTrial() const
    {
        const auto found = std::find_if(trials_.begin(), trials_.end(), [](const ErrorTrial* t) {
            return t->isDefault() && t->end == TrialEnd::finished;
        });
        return found == trials_.end() ? nullptr : *found;
    }

    /// Time of the trial over what the default would have taken in its place.
    double costOf(const ErrorTrial& trial, StudyClock clock) const
    {
        const auto place = std::find(trials_.begin(), trials_.end(), &trial) - trials_.begin();
        // The nearest pace trials: at or before this place, and at or after it.
        std::ptrdiff_t before = -1, after = -1;
        for (std::ptrdiff_t k = 0; k < std::ssize(trials_); ++k) {
            const ErrorTrial& other = *trials_[static_cast<std::size_t>(k)];
            if (other.end == TrialEnd::finished && didTheSame(other, *defaultTrial())) {
                before = k <= place ? k : before;
                after = k >= place && after < 0 ? k : after;
            }
        }
        before = before < 0 ? after : before;
        after = after < 0 ? before : after;
        const auto paceAt = [&](std::ptrdiff_t k) {
            return secondsOf(*trials_[static_cast<std::size_t>(k)], clock);
        };
        const double share = after > before ? static_cast<double>(place - before) /
                                                  static_cast<double>(after - before)
                                            : 0.0;
        return secondsOf(trial, clock) /
               ((1.0 - share) * paceAt(before) + share * paceAt(after));
    }

private:
    std::vector<const ErrorTrial*> trials_;
};

/// By seed, those that are complete.
std::map<std::uint64_t, SeedTrials> sortBySeed(const std::vector<ErrorTrial>& trials)
{
    std::map<std::uint64_t, SeedTrials> bySeed;
    for (const ErrorTrial& trial : trials) {
        bySeed[trial.seed].add(trial);
    }
    std::erase_if(bySeed, [](const auto& entry) { return !entry.second.complete(); });
    return bySeed;
}

/// Puts cost and error of the trials that finished into their groups.
void fillGroups(const std::map<std::uint64_t, SeedTrials>& bySeed, ErrorMeasure measure,
                StudyClock clock, std::vector<TrialGroup>& groups)
{
    for (TrialGroup& group : groups) {
        for (const ErrorTrial* trial : group.trials) {
            const auto seed = bySeed.find(trial->seed);
            if (trial->end != TrialEnd::finished || seed == bySeed.end()) {
                continue;
            }
            group.cost[trial->seed] = seed->second.costOf(*trial, clock);
            group.error[trial->seed] = measureOf(trial->errors, measure);
            group.sameAsDefault =
                group.sameAsDefault && didTheSame(*trial, *seed->second.defaultTrial());
        }
        group.sameAsDefault = group.sameAsDefault && !group.cost.empty() &&
                              group.setting.approximation != kDefaultSetting;
    }
}

/// The front of the settings that count, and its knee.
void findFront(ErrorEvaluation& evaluation)
{
    std::vector<CostAndError> choices;
    std::vector<std::size_t> settingOf;
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        if (evaluation.settings[k].counts()) {
            choices.push_back({evaluation.settings[k].cost, evaluation.settings[k].error});
            settingOf.push_back(k);
        }
    }
    const std::vector<std::size_t> front = findParetoFront(choices);
    for (const std::size_t k : front) {
        evaluation.front.push_back(settingOf[k]);
    }
    if (const auto knee = findKnee(choices, front)) {
        evaluation.knee = settingOf[*knee];
    }
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
    const bool needsNoValue =
        setting.value.empty() || setting.approximation == kReferenceSetting;
    return saysItself     ? setting.value
           : needsNoValue ? setting.approximation
                          : setting.approximation + " " + setting.value;
}

ErrorEvaluation evaluateErrors(const std::vector<ErrorTrial>& trials,
                               const std::vector<HeapErrors>& referencePairs, ErrorMeasure measure,
                               StudyClock clock)
{
    const std::map<std::uint64_t, SeedTrials> bySeed = sortBySeed(trials);
    if (bySeed.empty()) {
        throw InputError("no seed has both a reference and a default that finished: there is "
                         "nothing to compare");
    }
    std::vector<TrialGroup> groups = groupTrials(trials);
    fillGroups(bySeed, measure, clock, groups);

    ErrorEvaluation result;
    result.measure = measure;
    result.clock = clock;
    for (const auto& [seed, trialsOfSeed] : bySeed) {
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

    findFront(result);
    result.verdicts = judge(result.settings, result.noise.value_or(ChoiceNoise{}));
    return result;
}

}  // namespace sandflow
