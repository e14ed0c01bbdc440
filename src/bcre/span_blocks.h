#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sandflow {

/// Spans are worked on in blocks of fixed size. What is summed over spans is summed within a block,
/// then over blocks in order, so that it has the same bits for any number of threads.
inline constexpr std::size_t kSpanBlock = 512;
/// Below this a parallel region costs more than it saves.
inline constexpr std::size_t kParallelSpans = 4096;

inline std::size_t spanBlockCount(std::size_t spans)
{
    return (spans + kSpanBlock - 1) / kSpanBlock;
}

/// Calls body(block, begin, end) for every block of spans [begin, end), in parallel when there are
/// many. The body must write only what belongs to its block, and must not throw.
template <class Body>
void forSpanBlocks(std::size_t spans, const Body& body)
{
    const auto blocks = static_cast<std::int64_t>(spanBlockCount(spans));
#pragma omp parallel for schedule(static) if (spans > kParallelSpans)
    for (std::int64_t block = 0; block < blocks; ++block) {
        const std::size_t begin = static_cast<std::size_t>(block) * kSpanBlock;
        body(static_cast<std::size_t>(block), begin, std::min(begin + kSpanBlock, spans));
    }
}

}  // namespace sandflow
