#include "study/gnuplot.h"

#include "core/errors.h"
#include "io/atomic_file.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <system_error>

extern char** environ;

namespace sandflow {
namespace {

/// Exit code of `gnuplot ARGUMENT`; 127 if it could not be started.
int callGnuplot(std::string argument)
{
    std::string name = "gnuplot";
    char* const arguments[] = {name.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, name.c_str(), nullptr, nullptr, arguments, environ);
    if (error == ENOENT) {
        return 127;
    }
    if (error != 0) {
        throw SystemError(
            fmt::format("cannot start gnuplot: {}", std::generic_category().message(error)));
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            throw SystemError(fmt::format("lost sight of gnuplot: {}",
                                          std::generic_category().message(errno)));
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

[[noreturn]] void failMissing()
{
    throw SystemError("gnuplot is not installed: get it with `apt-get install gnuplot-nox`, or use "
                      "--no-plot");
}

}  // namespace

void requireGnuplot()
{
    if (callGnuplot("/dev/null") != 0) {
        failMissing();
    }
}

void plotWithGnuplot(const std::string& scriptPath, const std::string& script)
{
    writeFileAtomically(scriptPath, script);
    const int code = callGnuplot(scriptPath);
    if (code == 127) {
        failMissing();
    }
    if (code != 0) {
        throw SystemError(fmt::format("gnuplot ended with exit code {} on {}: see what it said "
                                      "above",
                                      code, scriptPath));
    }
}

std::string gnuplotQuoted(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            quoted += '\\';
        }
        quoted += c;
    }
    return quoted + '"';
}

}  // namespace sandflow
