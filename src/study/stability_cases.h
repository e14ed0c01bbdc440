#pragma once

#include "scene/scene.h"
#include "study/stability_verdict.h"

#include <functional>
#include <string>
#include <vector>

namespace sandflow {

/// One line of the table to come, or several from one run. `run` fills what was found; family,
/// parameter, value and mode stand already.
struct StabilityCase {
    Finding head;
    std::function<std::vector<Finding>(const Finding& head)> run;
};

/// How much is worth running: quick takes the ends of each range and single pours.
enum class StudySize { quick, whole };

/// "dem" or "surface-flow".
std::string labelOf(Mode mode);

/// A case with one finding.
StabilityCase makeCase(std::string family, std::string parameter, double value, std::string mode,
                       std::function<void(Finding&)> run);

// One family or several that share their scene each.
void addPourCases(StudySize size, std::vector<StabilityCase>& cases);
void addBounceCases(StudySize size, std::vector<StabilityCase>& cases);
void addImpactCases(StudySize size, std::vector<StabilityCase>& cases);
void addColumnCases(StudySize size, std::vector<StabilityCase>& cases);
void addOverlapCases(StudySize size, std::vector<StabilityCase>& cases);
void addRestCases(StudySize size, std::vector<StabilityCase>& cases);
void addTiltCases(StudySize size, std::vector<StabilityCase>& cases);

}  // namespace sandflow
