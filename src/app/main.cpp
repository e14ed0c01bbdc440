#include "app/commands.h"
#include "app/environment.h"

#include <fmt/format.h>
#include <gsl/gsl_errno.h>

#include <cstdio>
#include <new>

namespace {

using namespace sandflow;

/// The one place where errors become a sentence and an exit code.
ExitCode runGuarded(const Action& action)
{
    const auto say = [](const char* what) { fmt::print(stderr, "sandflow: {}\n", what); };
    try {
        return action();
    } catch (const InputError& e) {
        say(e.what());
        return ExitCode::badInput;
    } catch (const PhysicsError& e) {
        say(e.what());
        return ExitCode::physicsBroke;
    } catch (const SystemError& e) {
        say(e.what());
        return ExitCode::systemFailed;
    } catch (const std::bad_alloc&) {
        say("out of memory: lower the grain count or close other programs");
        return ExitCode::systemFailed;
    } catch (const std::exception& e) {
        fmt::print(stderr, "sandflow: internal fault: {}\n", e.what());
        return ExitCode::internalFault;
    }
}

}  // namespace

int main(int argc, char** argv)
{
    prepareEnvironment(argv);
    gsl_set_error_handler_off();

    CLI::App app("Sandflow: animates sand as a surface flow.", "sandflow");
    app.set_version_flag("--version", describeVersion());
    app.require_subcommand(1);
    Action action;
    addRunCommand(app, action);
    addCheckCommand(app, action);
    addCompareCommand(app, action);
    addExportCommand(app, action);
    addBenchCommand(app, action);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const bool asked = e.get_exit_code() == 0;  // --help, --version
        app.exit(e);
        return static_cast<int>(asked ? ExitCode::done : ExitCode::badInput);
    }
    return static_cast<int>(runGuarded(action));
}
