#pragma once

#include <string>

namespace sandflow {

/// Throws SystemError, saying how to install it, if gnuplot cannot be started. To be asked before a
/// study starts: after hours of trials is too late.
void requireGnuplot();

/// Writes `script` to `scriptPath` and runs gnuplot on it; the picture lies where the script says.
/// Throws SystemError if gnuplot is missing or does not like the script.
void plotWithGnuplot(const std::string& scriptPath, const std::string& script);

/// A text as gnuplot reads it back, in double quotes.
std::string gnuplotQuoted(const std::string& text);

}  // namespace sandflow
