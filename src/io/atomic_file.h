#pragma once

#include <string>
#include <string_view>

namespace sandflow {

/// Whether a file must have reached the disk before it takes its name.
enum class Durability { buffered, synced };

/// A file that appears under its name only when it is whole. It is written as "<path>.tmp" in the
/// same folder and renamed by commit(); without commit() the destructor removes it, and whatever
/// had the name before stays untouched. A path that names a device or a pipe is written directly.
///
/// Every failure (full disk, permission, missing folder) throws SystemError with path and cause,
/// and leaves no temporary behind.
class AtomicFile {
public:
    explicit AtomicFile(std::string path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);

    /// Closes the file and gives it its name. Nothing may be written afterwards.
    void commit(Durability durability = Durability::buffered);

private:
    [[noreturn]] void fail(const char* action);
    void discard() noexcept;

    std::string path_;
    std::string temporary_;  ///< empty when a device is written directly
    int descriptor_ = -1;
};

/// The whole of a file in one call. Throws SystemError.
void writeFileAtomically(const std::string& path, std::string_view content,
                         Durability durability = Durability::buffered);

/// Writes all bytes to an open descriptor; returns false, with errno set, when one was refused.
bool writeAllBytes(int descriptor, std::string_view bytes) noexcept;

/// The whole content of a file. Throws InputError if it is not there, is no regular file or may
/// not be read; SystemError if reading breaks off.
std::string readWholeFile(const std::string& path);

}  // namespace sandflow
