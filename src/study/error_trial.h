#pragma once

#include "measure/compare.h"
#include "study/error_setting.h"
#include "study/scene_trial.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sandflow {

/// How far a heap is from the reference of the same seed, as `sandflow compare` has it.
struct HeapErrors {
    double radial = 0.0;               ///< d, mean |dH| over annuli
    double cells = 0.0;                ///< d, mean |dH| over cells of 5 d
    std::optional<double> reposeDeg;   ///< deg, with sign; none unless both heaps have an angle
    double apex = 0.0;                 ///< d, with sign
    double r90 = 0.0;                  ///< %, with sign
};

HeapErrors errorsOf(const HeapComparison& comparison);

/// One row of trials.csv.
struct ErrorTrial {
    ErrorSetting setting;
    std::uint64_t seed = 0;
    TrialEnd end = TrialEnd::finished;
    double wallSeconds = 0.0;
    double processorSeconds = 0.0;
    std::uint64_t steps = 0;
    std::uint64_t grainSteps = 0;   ///< grains computed, summed over the steps
    HeapErrors errors;              ///< of a trial that finished; all 0 for the reference itself
    std::string message;            ///< of one that did not

    bool isDefault() const { return setting.approximation == kDefaultSetting; }
    bool isReference() const { return setting.approximation == kReferenceSetting; }
};

const std::vector<std::string>& errorTrialColumns();
std::vector<std::string> errorTrialFields(const ErrorTrial& trial);

/// Reads trials.csv back; a last line that was not finished is left out. Throws InputError for a
/// file that is not one.
std::vector<ErrorTrial> readErrorTrials(const std::string& path);

}  // namespace sandflow
