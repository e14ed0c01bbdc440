#pragma once

#include "io/frame_row.h"

#include <chrono>
#include <cstdint>

namespace sandflow {

/// One line that is written over on a terminal; a line every few seconds elsewhere; nothing when
/// quiet.
class Progress {
public:
    Progress(std::uint64_t frames, bool quiet);
    void show(const FrameRow& row);
    void finish();

private:
    using Clock = std::chrono::steady_clock;
    std::uint64_t frames_;
    bool quiet_, terminal_;
    Clock::time_point start_, last_;
};

}  // namespace sandflow
