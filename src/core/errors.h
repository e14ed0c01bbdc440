#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace sandflow {

/// What the program tells the shell; see README "Exit codes".
enum class ExitCode { done = 0, internalFault = 1, badInput = 2, physicsBroke = 3, systemFailed = 4 };

/// Something the user can mend: a scene key, a flag, a file that is not there. One sentence.
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The simulation left the range in which its equations hold. One sentence, with a remedy.
class PhysicsError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The machine failed us: disk, memory, permission. One sentence.
class SystemError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A broken invariant of our own.
class InternalError : public std::logic_error {
    using std::logic_error::logic_error;
};

}  // namespace sandflow

/// Always on. Use for invariants whose breach would make later results wrong.
#define SAND_CHECK(condition, ...)                                                               \
    do {                                                                                         \
        if (!(condition)) {                                                                      \
            throw ::sandflow::InternalError(fmt::format("{}:{}: broken invariant ({}): {}",      \
                                                        __FILE__, __LINE__, #condition,          \
                                                        fmt::format(__VA_ARGS__)));              \
        }                                                                                        \
    } while (false)
