#include "app/commands.h"
#include "io/export.h"
#include "io/run_folder.h"
#include "io/state_file.h"

#include <charconv>
#include <unistd.h>

namespace sandflow {
namespace {

struct ExportOptions {
    std::string run;
    std::string frame = "last";
    std::string format = "csv";
    std::string out;
};

/// A frame's number; nothing for "last".
std::optional<std::uint64_t> parseFrame(const std::string& text)
{
    if (text == "last") {
        return std::nullopt;
    }
    std::uint64_t frame = 0;
    const char* end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, frame);
    if (code != std::errc{} || stop != end) {
        throw InputError(fmt::format("--frame {}: expected the number of a frame, or last", text));
    }
    return frame;
}

ExitCode exportRun(const ExportOptions& options)
{
    const std::optional<std::uint64_t> frame = parseFrame(options.frame);
    const ExportFormat format = parseExportFormat(options.format);
    const bool toOutput = options.out.empty() || options.out == "-";
    if (toOutput && format == ExportFormat::ply && ::isatty(STDOUT_FILENO) == 1) {
        throw InputError(
            "ply is binary and would garble the terminal: name a file with --out, or "
            "send the output to a file or pipe");
    }
    const RunFolder folder(options.run, FolderUse::read);
    const Snapshot snapshot = readState(folder.findState(frame));
    exportSnapshot(snapshot, format, toOutput ? "-" : options.out);
    return ExitCode::done;
}

}  // namespace

void addExportCommand(CLI::App& app, Action& action)
{
    auto options = std::make_shared<ExportOptions>();
    CLI::App* command =
        app.add_subcommand("export", "Write the grains of a frame, buried ones included");
    command->add_option("run", options->run, "Run folder")->required();
    command->add_option("--frame", options->frame, "Number of the frame, or last (default)")
        ->type_name("N|last");
    command->add_option("--format", options->format, "csv (default), ply or vtp")
        ->check(CLI::IsMember({"csv", "ply", "vtp"}));
    command->add_option("--out", options->out, "File (default: the standard output)")
        ->type_name("FILE");
    command->callback([options, &action] { action = [options] { return exportRun(*options); }; });
}

}  // namespace sandflow
