#pragma once

#include "study/error_trial.h"
#include "study/pareto.h"

#include <optional>
#include <string>
#include <vector>

namespace sandflow {

/// Which error counts where one number must do.
enum class ErrorMeasure {
    radial,  ///< mean |dH| over annuli: of a single heap, the quieter one
    cells    ///< mean |dH| over cells of 5 d: of any scene
};

/// Which time is the cost.
enum class StudyClock {
    wall,
    processor  ///< of all threads: for a machine that is busy with other things
};

/// A setting over its seeds.
struct SettingFigures {
    ErrorSetting setting;
    std::size_t finished = 0;  ///< trials that count
    std::size_t failed = 0;    ///< refused or broken: the setting is then on no front
    std::string message;       ///< of the first of those
    bool sameAsDefault = false;  ///< did the very same with every seed: it costs and errs alike
    double seconds = 0.0;      ///< median
    double cost = 0.0;         ///< median over the seeds of the time over the default's
    double error = 0.0;        ///< d, mean of the measure that counts
    double errorLow = 0.0, errorHigh = 0.0;  ///< d, of its trials
    HeapErrors mean;           ///< every measure; those with a sign keep it

    /// True if it is a choice of its own beside the default.
    bool counts() const { return finished > 0 && failed == 0 && !sameAsDefault; }
};

/// Whether what ships is the best value of one approximation: the setting that beats the default in
/// cost and error at once, if one does (of several the one with the least error).
struct ApproximationVerdict {
    std::string approximation;
    std::optional<std::size_t> better;  ///< index into ErrorEvaluation::settings
    bool clearly = false;               ///< by more than the noise
};

/// What a study found.
struct ErrorEvaluation {
    ErrorMeasure measure = ErrorMeasure::radial;
    StudyClock clock = StudyClock::wall;
    std::vector<std::uint64_t> seeds;
    std::vector<SettingFigures> settings;  ///< the default first, then in the order of the trials
    SettingFigures reference;
    std::optional<HeapErrors> referenceNoise;  ///< two seeds of the reference: mean over all
                                               ///< pairs, without signs; none with one seed
    std::optional<ChoiceNoise> noise;  ///< two settings differ by chance up to this: 2 sigma of the
                                       ///< difference of their means; none with one seed
    std::vector<std::size_t> front;    ///< into settings, by rising cost
    std::optional<std::size_t> knee;   ///< into settings
    std::vector<ApproximationVerdict> verdicts;

    bool onFront(std::size_t setting) const;
    /// The reference's own scatter in the measure that counts, d.
    std::optional<double> referenceScatter() const;
};

/// Puts the trials of a study together. `referencePairs` are references of different seeds against
/// each other. Throws InputError if no seed has both a reference and a default that finished.
///
/// A trial's time is set against what the default would have taken at its place in the order of the
/// trials: on the straight line between the trials before and after it that did the very same as
/// the default (the default's own repeats, and settings without effect on this scene).
///
/// The noise is what is left of the trials' errors when each setting's mean and each seed's common
/// shift are taken out (two-way layout without interaction), of the settings that have every seed.
ErrorEvaluation evaluateErrors(const std::vector<ErrorTrial>& trials,
                               const std::vector<HeapErrors>& referencePairs, ErrorMeasure measure,
                               StudyClock clock);

/// "R_min 3 d", "dem", "default".
std::string labelOf(const ErrorSetting& setting);

}  // namespace sandflow
