#pragma once

#include "core/cell_key.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sandflow {

/// Hash map from a 64-bit key to a 32-bit value (an index, a count): open addressing with linear
/// probing in a table of a power of two, at most half full. Nothing is ever erased singly, so there
/// are no tombstones. Any key is allowed. Reading from several threads at once is safe, inserting
/// is not.
///
///     slot   | key | value | stamp |  ...       used if stamp == generation_, so that clear()
///                                               is one increment and keeps the memory
class CellMap {
public:
    CellMap() = default;
    explicit CellMap(std::size_t expected) { reserve(expected); }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }

    /// Keys that fit before the table grows.
    std::size_t capacity() const { return slots_.size() / 2; }

    /// Forgets all keys, keeps the memory.
    void clear()
    {
        size_ = 0;
        if (++generation_ == 0) {  // after 2^32 clears old stamps could look new
            slots_.assign(slots_.size(), Slot{});
            generation_ = 1;
        }
    }

    /// Makes room for `count` keys in all without another allocation.
    void reserve(std::size_t count)
    {
        if (count > capacity()) {
            rehash(std::bit_ceil(count < kSmallest ? 2 * kSmallest : 2 * count));
        }
    }

    /// The value of `key`, or null. Valid until the next insert, reserve or clear.
    std::uint32_t* find(std::uint64_t key)
    {
        return const_cast<std::uint32_t*>(std::as_const(*this).find(key));
    }

    const std::uint32_t* find(std::uint64_t key) const
    {
        if (size_ == 0) {
            return nullptr;
        }
        const Slot& slot = slots_[probe(key)];
        return isUsed(slot) ? &slot.value : nullptr;
    }

    /// Adds `key` with `value` unless it is there; returns where its value lives and whether it was
    /// added. The pointer is valid until the next insert, reserve or clear.
    std::pair<std::uint32_t*, bool> insert(std::uint64_t key, std::uint32_t value)
    {
        if (size_ == capacity()) {
            // Growth could be needless for a key that is there already; that happens at most once
            // per doubling.
            rehash(slots_.empty() ? 2 * kSmallest : 2 * slots_.size());
        }
        Slot& slot = slots_[probe(key)];
        if (isUsed(slot)) {
            return {&slot.value, false};
        }
        slot = {key, value, generation_};
        ++size_;
        return {&slot.value, true};
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t value = 0;
        std::uint32_t stamp = 0;
    };
    static constexpr std::size_t kSmallest = 8;

    bool isUsed(const Slot& slot) const { return slot.stamp == generation_; }

    /// The slot of `key`, or the free slot where it belongs. Ends because half of them are free.
    std::size_t probe(std::uint64_t key) const
    {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = mixCellKey(key) & mask;
        while (isUsed(slots_[at]) && slots_[at].key != key) {
            at = (at + 1) & mask;
        }
        return at;
    }

    void rehash(std::size_t slotCount)
    {
        std::vector<Slot> old(slotCount);
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (isUsed(slot)) {
                slots_[probe(slot.key)] = slot;
            }
        }
    }

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
    std::uint32_t generation_ = 1;  ///< never 0, the stamp of a slot that was never used
};

}  // namespace sandflow
