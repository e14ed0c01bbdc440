#include "io/run_folder.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/frame_log.h"
#include "io/pov_scene.h"
#include "io/state_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace sandflow {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kPlainNames{"scene.toml", "frames.csv", "summary.json",
                                                      "checkpoint.bin", "state_last.bin"};

/// The frame number in "<prefix>NNNNNN<suffix>", six digits or more.
std::optional<std::uint64_t> parseNumberedName(std::string_view name, std::string_view prefix,
                                               std::string_view suffix)
{
    if (name.size() < prefix.size() + 6 + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix)) {
        return std::nullopt;
    }
    name.remove_prefix(prefix.size());
    name.remove_suffix(suffix.size());
    std::uint64_t frame = 0;
    const auto result = std::from_chars(name.data(), name.data() + name.size(), frame);
    if (result.ec != std::errc{} || result.ptr != name.data() + name.size() ||
        (name.size() > 6 && name.front() == '0')) {
        return std::nullopt;
    }
    return frame;
}

std::optional<std::uint64_t> parseFrameFileName(std::string_view name)
{
    const auto frame = parseNumberedName(name, "frame_", ".inc");
    return frame ? frame : parseNumberedName(name, "state_", ".bin");
}

[[noreturn]] void failOn(const char* action, const std::string& path, const std::error_code& error)
{
    throw SystemError(fmt::format("cannot {} {}: {}", action, path, error.message()));
}

void removeFile(const std::string& path)
{
    std::error_code error;
    fs::remove(path, error);
    if (error) {
        failOn("remove", path, error);
    }
}

}  // namespace

bool isRunFileName(std::string_view name)
{
    if (name.ends_with(".tmp")) {
        name.remove_suffix(4);  // a file that was being written when the program was killed
    }
    return std::ranges::find(kPlainNames, name) != kPlainNames.end() || isPovSceneFileName(name) ||
           parseFrameFileName(name).has_value();
}

RunFolder::RunFolder(std::string path, FolderUse use) : path_(std::move(path))
{
    std::error_code error;
    const fs::file_status status = fs::status(path_, error);
    if (fs::exists(status) && !fs::is_directory(status)) {
        throw InputError(fmt::format("{} is not a folder", path_));
    }
    const bool exists = fs::exists(status);
    const bool hasRun = exists && fs::exists(frameLogPath(), error);
    if (use == FolderUse::resume || use == FolderUse::read) {
        if (!hasRun) {
            throw InputError(fmt::format("{} holds no run: there is no frames.csv in it", path_));
        }
        return;
    }
    if (!exists) {
        fs::create_directories(path_, error);
        if (error) {
            failOn("create the folder", path_, error);
        }
    }
    const std::vector<std::string> old = listRunFiles();
    if (!hasRun && !old.empty()) {
        throw InputError(fmt::format(
            "{} holds {} but no run, and a run would overwrite it: choose another folder", path_,
            old.front()));
    }
    if (use == FolderUse::fresh && !old.empty()) {
        throw InputError(fmt::format(
            "{} already holds a run: choose another folder, or use --resume or --force", path_));
    }
    for (const std::string& name : old) {
        removeFile(inside(name));
    }
    writeFileAtomically(frameLogPath(), frameLogHeader() + '\n');
}

std::string RunFolder::statePath(std::uint64_t frame) const
{
    return inside(fmt::format("state_{:06}.bin", frame));
}

std::string RunFolder::framePath(std::uint64_t frame) const
{
    return inside(povFrameName(frame));
}

std::string RunFolder::findState(std::optional<std::uint64_t> frame) const
{
    std::error_code error;
    const bool hasLast = fs::exists(lastStatePath(), error);
    if (!frame) {
        if (!hasLast) {
            throw InputError(fmt::format("{} holds no state yet: no frame was finished", path_));
        }
        return lastStatePath();
    }
    if (fs::exists(statePath(*frame), error)) {
        return statePath(*frame);
    }
    if (hasLast) {
        const std::uint64_t last = readState(lastStatePath()).frame;
        if (last == *frame) {
            return lastStatePath();
        }
        throw InputError(fmt::format(
            "{} kept no state of frame {}; its last frame is {} (a run with --keep-states keeps "
            "all)",
            path_, *frame, last));
    }
    throw InputError(fmt::format("{} kept no state of frame {}", path_, *frame));
}

void RunFolder::removeFramesAfter(std::uint64_t frame) const
{
    for (const std::string& name : listRunFiles()) {
        const auto number = parseFrameFileName(name);
        if (number && *number > frame) {
            removeFile(inside(name));
        }
    }
}

void RunFolder::writeSummary(const JsonWriter& json) const
{
    writeFileAtomically(summaryPath(), json.text());
}

std::string RunFolder::inside(std::string_view name) const
{
    return (fs::path(path_) / name).string();
}

std::vector<std::string> RunFolder::listRunFiles() const
{
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(path_, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        std::error_code statusError;
        if (isRunFileName(name) && !fs::is_directory(entry->symlink_status(statusError))) {
            names.push_back(name);
        }
    }
    if (error) {
        failOn("list the folder", path_, error);
    }
    std::ranges::sort(names);
    return names;
}

}  // namespace sandflow
