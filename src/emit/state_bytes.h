#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace sandflow {

/// Writes plain values one after another into a byte string.
class StateWriter {
public:
    template <typename T>
    void put(T value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }

    void putBlob(const std::vector<std::uint8_t>& blob)
    {
        put(static_cast<std::uint64_t>(blob.size()));
        bytes_.insert(bytes_.end(), blob.begin(), blob.end());
    }

    std::vector<std::uint8_t> take() { return std::move(bytes_); }

private:
    std::vector<std::uint8_t> bytes_;
};

/// Reads them back in the same order; throws std::out_of_range past the end.
class StateReader {
public:
    explicit StateReader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    template <typename T>
    T get()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        need(sizeof(T));
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }

    std::vector<std::uint8_t> getBlob()
    {
        const auto size = get<std::uint64_t>();
        need(size);
        const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
        at_ += size;
        return {first, first + static_cast<std::ptrdiff_t>(size)};
    }

    bool atEnd() const { return at_ == bytes_.size(); }

private:
    void need(std::uint64_t size) const
    {
        if (size > bytes_.size() - at_) {
            throw std::out_of_range("emitter state ends early");
        }
    }

    const std::vector<std::uint8_t>& bytes_;
    std::size_t at_ = 0;
};

}  // namespace sandflow
