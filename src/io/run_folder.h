#pragma once

#include "io/json_writer.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// What a folder that already holds a run means to the caller.
enum class FolderUse {
    fresh,   ///< it is refused
    force,   ///< the old run's files are removed
    resume,  ///< it must hold a run, which is continued
    read     ///< it must hold a run, which is only looked at
};

/// True for the names sandflow gives to files of a run (scene.toml, frame_000042.inc, ...).
/// Pictures rendered from them are the user's.
bool isRunFileName(std::string_view name);

/// The folder of one run: knows the names of its files, nothing of their content.
class RunFolder {
public:
    /// Creates the folder and its parents where the use allows it. A new run starts with a
    /// frames.csv that holds only its header, which marks the folder as a run from then on.
    ///
    /// Throws InputError if the use and the folder do not fit; also, whatever the use, if the
    /// folder holds no run but a file of such a name: that is likely the user's own scene.toml.
    /// SystemError if the folder cannot be made or emptied.
    RunFolder(std::string path, FolderUse use);

    const std::string& path() const { return path_; }
    std::string scenePath() const { return inside("scene.toml"); }
    std::string frameLogPath() const { return inside("frames.csv"); }
    std::string summaryPath() const { return inside("summary.json"); }
    std::string checkpointPath() const { return inside("checkpoint.bin"); }
    std::string lastStatePath() const { return inside("state_last.bin"); }
    std::string statePath(std::uint64_t frame) const;
    std::string framePath(std::uint64_t frame) const;

    /// Path of the state of a frame, or of the last one. Throws InputError, naming what there is,
    /// if the run kept no such state.
    std::string findState(std::optional<std::uint64_t> frame) const;

    /// Removes frame and state files of later frames, which a resumed run writes again.
    void removeFramesAfter(std::uint64_t frame) const;

    /// Throws SystemError.
    void writeSummary(const JsonWriter& json) const;

private:
    std::string inside(std::string_view name) const;
    std::vector<std::string> listRunFiles() const;

    std::string path_;
};

}  // namespace sandflow
