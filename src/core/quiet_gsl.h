#pragma once

#include <gsl/gsl_errno.h>

namespace sandflow {

/// GSL aborts the process on an error unless told not to. Restored on leaving, so that one function
/// does not decide for the rest of the program.
class QuietGsl {
public:
    QuietGsl() : previous_(gsl_set_error_handler_off()) {}
    ~QuietGsl() { gsl_set_error_handler(previous_); }
    QuietGsl(const QuietGsl&) = delete;
    QuietGsl& operator=(const QuietGsl&) = delete;

private:
    gsl_error_handler_t* previous_;
};

}  // namespace sandflow
