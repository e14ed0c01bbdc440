#pragma once

#include <cstddef>
#include <cstdint>

namespace sandflow {

/// The order in which threads take the chunks: most of them four at a time, because a chunk finds its
/// neighbours' grains in the cache of the core that has just been through them; the last quarter one
/// by one, so that all threads end together.
class ChunkTurns {
public:
    explicit ChunkTurns(std::size_t chunks)
        : groups_(static_cast<std::int64_t>(chunks * 3 / 4 / kGroup)),
          chunks_(static_cast<std::int64_t>(chunks))
    {
    }

    std::int64_t count() const { return groups_ + (chunks_ - kGroup * groups_); }
    /// First chunk of turn t; that of the turn after the last is the number of chunks.
    std::uint32_t begin(std::int64_t t) const
    {
        return static_cast<std::uint32_t>(t < groups_ ? kGroup * t
                                                      : kGroup * groups_ + (t - groups_));
    }

private:
    static constexpr std::int64_t kGroup = 4;
    std::int64_t groups_, chunks_;
};

}  // namespace sandflow
