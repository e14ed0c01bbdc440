#pragma once

#include <sys/types.h>

#include <vector>

namespace sandflow {

/// Processes that do nothing but keep a processor busy each, for as long as this lives: to see what
/// others on the machine cost. They end with the program, however it ends.
class BusyNeighbours {
public:
    /// Throws SystemError if they cannot be started.
    explicit BusyNeighbours(int count);
    ~BusyNeighbours();
    BusyNeighbours(const BusyNeighbours&) = delete;
    BusyNeighbours& operator=(const BusyNeighbours&) = delete;

private:
    std::vector<pid_t> processes_;
};

}  // namespace sandflow
