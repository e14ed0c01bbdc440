#pragma once

#include "study/error_figures.h"

#include <string>

namespace sandflow {

/// A gnuplot script that draws every setting as a point, time against error, with the Pareto front,
/// its knee and the default, into `picture` (PNG). `title` says what was studied.
std::string scriptOfFront(const ErrorEvaluation& evaluation, const std::string& title,
                          const std::string& picture);

/// The same plane once for each approximation, with its own values joined to the default.
std::string scriptOfSweeps(const ErrorEvaluation& evaluation, const std::string& title,
                           const std::string& picture);

}  // namespace sandflow
