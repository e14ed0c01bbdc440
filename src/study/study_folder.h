#pragma once

#include <string>

namespace sandflow {

/// Makes the folder of a study, and its parents. Throws InputError if there is anything of that
/// name already: hours of work are never written over. SystemError if it cannot be made.
void makeStudyFolder(const std::string& path);

}  // namespace sandflow
