#pragma once

#include <string>
#include <vector>

namespace sandflow {

/// What a run turned out to be, from good to bad.
enum class Verdict {
    sound,
    refused,     ///< the program said why it will not run this: nothing wrong was computed
    wrongShape,  ///< it ran without complaint, and the sand lies where it cannot
    jitters,     ///< sand that should rest does not
    broke        ///< numbers that are none, sand through solids, energy from nowhere
};

/// "sound", "refused", "wrong shape", "jitters", "broke".
const char* nameOf(Verdict verdict);

/// Whether a user can rely on what he got: it is sound, or he was told why he gets nothing.
bool isAcceptable(Verdict verdict);

/// One thing that was measured, how far it may be off, and what it means if it is further off.
struct Check {
    std::string measure;  ///< what, against what
    double error = 0.0;
    double limit = 0.0;   ///< > 0
    std::string unit;
    Verdict otherwise = Verdict::broke;
    std::string cause;    ///< for people, if it fails
    bool isGuard = false; ///< of no interest unless it fails: how near it comes says little
};

/// One line of the study's table.
struct Finding {
    std::string family;
    std::string parameter;  ///< with its unit
    double value = 0.0;
    std::string mode;       ///< "dem" or "surface-flow", and what else sets a run apart
    Verdict verdict = Verdict::sound;
    Check decisive;         ///< the worst failure, or what came nearest to one (no guard)
    std::string cause;      ///< empty if sound
};

/// The verdict of all checks of one run: the worst of those that failed. An error that is no number
/// fails. A run without checks proves nothing and is an InternalError.
void judge(const std::vector<Check>& checks, Finding& finding);

}  // namespace sandflow
