#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <omp.h>
#include <vector>

namespace sandflow {

/// Sorts numbered keys: stable radix sort from the lowest digit, so that the result is one whatever
/// the number of threads that share it.
template <class Key>
class KeySorter {
public:
    struct Entry {
        Key key;
        std::uint32_t point;
    };
    /// Fewer keys are sorted by one thread: waking the others would take longer.
    static constexpr std::size_t kFew = 4096;

    std::vector<Entry>& entries() { return entries_; }
    std::size_t bytes() const
    {
        return (entries_.capacity() + scratch_.capacity()) * sizeof(Entry);
    }

    /// By the lowest `bits` of the keys.
    void sort(int bits)
    {
        constexpr int kMostBits = 11;  // per pass: a count per digit fits the first-level cache
        if (bits == 0) {
            return;
        }
        const auto n = static_cast<std::int64_t>(entries_.size());
        const bool many = entries_.size() > kFew;
        const int passes = (bits + kMostBits - 1) / kMostBits;
        const int digitBits = (bits + passes - 1) / passes;
        const std::size_t digits = std::size_t{1} << digitBits;
        const std::int64_t blocks = many ? omp_get_max_threads() : 1;
        const auto blockBegin = [&](std::int64_t b) { return n * b / blocks; };

        scratch_.resize(entries_.size());
        count_.resize(static_cast<std::size_t>(blocks) * digits);
        for (int shift = 0; shift < bits; shift += digitBits) {
            const auto digitOf = [&](const Entry& e) {
                return static_cast<std::size_t>(e.key >> shift) & (digits - 1);
            };
#pragma omp parallel for schedule(static, 1) if (many)
            for (std::int64_t b = 0; b < blocks; ++b) {
                std::uint32_t* count = count_.data() + static_cast<std::size_t>(b) * digits;
                std::fill(count, count + digits, 0);
                for (std::int64_t k = blockBegin(b); k < blockBegin(b + 1); ++k) {
                    ++count[digitOf(entries_[k])];
                }
            }
            std::uint32_t sum = 0;
            for (std::size_t digit = 0; digit < digits; ++digit) {
                for (std::int64_t b = 0; b < blocks; ++b) {
                    std::uint32_t& count = count_[static_cast<std::size_t>(b) * digits + digit];
                    const std::uint32_t here = count;
                    count = sum;
                    sum += here;
                }
            }
#pragma omp parallel for schedule(static, 1) if (many)
            for (std::int64_t b = 0; b < blocks; ++b) {
                std::uint32_t* place = count_.data() + static_cast<std::size_t>(b) * digits;
                for (std::int64_t k = blockBegin(b); k < blockBegin(b + 1); ++k) {
                    scratch_[place[digitOf(entries_[k])]++] = entries_[k];
                }
            }
            entries_.swap(scratch_);
        }
    }

private:
    std::vector<Entry> entries_, scratch_;
    std::vector<std::uint32_t> count_;
};

}  // namespace sandflow
