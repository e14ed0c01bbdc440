#pragma once

#include "io/frame_row.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sandflow {

/// The header line of frames.csv, without its newline.
std::string frameLogHeader();

/// All rows of a frames.csv. A last line without its newline (the run was killed while writing
/// it) is left out. Throws InputError for a file with another header or a broken row.
std::vector<FrameRow> readFrameLog(const std::string& path);

/// Appends to frames.csv; every row is in the file when append() returns, so that the file can be
/// followed while the run goes on. Throws SystemError when the disk refuses it.
class FrameLog {
public:
    /// Starts the file anew. With `keepUpTo`, the rows of an earlier run up to and including that
    /// frame stay (a resumed run writes the later ones again).
    explicit FrameLog(const std::string& path,
                      std::optional<std::uint64_t> keepUpTo = std::nullopt);
    ~FrameLog();
    FrameLog(const FrameLog&) = delete;
    FrameLog& operator=(const FrameLog&) = delete;

    void append(const FrameRow& row);

private:
    std::string path_;
    int descriptor_ = -1;
};

}  // namespace sandflow
