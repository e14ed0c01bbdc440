#include "io/snapshot_check.h"

#include "core/errors.h"

namespace sandflow {

void checkSnapshot(const Snapshot& snapshot)
{
    const std::size_t n = snapshot.size();
    SAND_CHECK(snapshot.position.size() == n && snapshot.velocity.size() == n &&
                   snapshot.spin.size() == n && snapshot.radius.size() == n &&
                   snapshot.state.size() == n,
               "the arrays of a snapshot of {} grains differ in length", n);
    for (std::size_t i = 1; i < n; ++i) {
        SAND_CHECK(snapshot.id[i - 1] < snapshot.id[i], "grain {} follows grain {}",
                   snapshot.id[i], snapshot.id[i - 1]);
    }
}

}  // namespace sandflow
