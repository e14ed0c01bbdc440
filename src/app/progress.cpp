#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace sandflow {
namespace {

constexpr double kTerminalPause = 0.1;  // s between updates
constexpr double kLogPause = 5.0;

double secondsBetween(std::chrono::steady_clock::time_point a,
                      std::chrono::steady_clock::time_point b)
{
    return std::chrono::duration<double>(b - a).count();
}

}  // namespace

Progress::Progress(std::uint64_t frames, bool quiet)
    : frames_(frames), quiet_(quiet), terminal_(::isatty(STDOUT_FILENO) == 1), start_(Clock::now()),
      last_(start_)
{
}

void Progress::show(const FrameRow& row)
{
    const auto now = Clock::now();
    const bool due = secondsBetween(last_, now) >= (terminal_ ? kTerminalPause : kLogPause);
    if (quiet_ || (!due && row.frame != frames_)) {
        return;
    }
    last_ = now;
    const double spent = secondsBetween(start_, now);
    const double left = spent / static_cast<double>(row.frame) *
                        static_cast<double>(frames_ - row.frame);
    fmt::print("{}frame {}/{}  {:.2f} s  mobile {} (asleep {}) of {}  {:.3f} s/frame  {:.0f} s left{}",
               terminal_ ? "\r\033[K" : "", row.frame, frames_, row.time, row.mobile, row.asleep,
               row.emitted, row.wall, left, terminal_ ? "" : "\n");
    std::fflush(stdout);
}

void Progress::finish()
{
    if (!quiet_ && terminal_) {
        fmt::print("\n");
    }
}

}  // namespace sandflow
