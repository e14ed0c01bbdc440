#include "io/atomic_file.h"

#include "core/errors.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace sandflow {
namespace {

std::string describeErrno(int code)
{
    return std::generic_category().message(code);
}

bool isDeviceOrPipe(const std::string& path)
{
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) &&
           !S_ISDIR(status.st_mode);
}

}  // namespace

bool writeAllBytes(int descriptor, std::string_view bytes) noexcept
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) {
                continue;
            }
            return false;
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path))
{
    const bool direct = isDeviceOrPipe(path_);
    const std::string opened = direct ? path_ : path_ + ".tmp";
    descriptor_ = ::open(opened.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        fail("open");
    }
    // Only from here on is there a temporary of ours to remove.
    if (!direct) {
        temporary_ = opened;
    }
}

AtomicFile::~AtomicFile()
{
    discard();
}

void AtomicFile::write(std::string_view bytes)
{
    SAND_CHECK(descriptor_ >= 0, "{} is written after it was committed", path_);
    if (!writeAllBytes(descriptor_, bytes)) {
        fail("write");
    }
}

void AtomicFile::commit(Durability durability)
{
    SAND_CHECK(descriptor_ >= 0, "{} is committed twice", path_);
    if (durability == Durability::synced && !temporary_.empty() && ::fsync(descriptor_) != 0) {
        fail("sync");
    }
    // Some file systems report a full disk only when the file is closed.
    if (::close(std::exchange(descriptor_, -1)) != 0) {
        fail("close");
    }
    if (!temporary_.empty()) {
        if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
            fail("name");
        }
        temporary_.clear();
    }
}

void AtomicFile::fail(const char* action)
{
    const int code = errno;
    discard();
    throw SystemError(fmt::format("cannot {} {}: {}", action, path_, describeErrno(code)));
}

void AtomicFile::discard() noexcept
{
    if (descriptor_ >= 0) {
        ::close(std::exchange(descriptor_, -1));
    }
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        temporary_.clear();
    }
}

void writeFileAtomically(const std::string& path, std::string_view content, Durability durability)
{
    AtomicFile file(path);
    file.write(content);
    file.commit(durability);
}

std::string readWholeFile(const std::string& path)
{
    // Non-blocking, so that a pipe nobody writes to is refused below instead of waited for.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        throw InputError(fmt::format("cannot open {}: {}", path, describeErrno(errno)));
    }
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(descriptor);
        throw InputError(fmt::format("{} is not a regular file", path));
    }
    std::string content(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t filled = 0;
    while (filled < content.size()) {
        const ssize_t got =
            ::read(descriptor, content.data() + filled, content.size() - filled);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            const int code = errno;
            ::close(descriptor);
            throw SystemError(fmt::format("cannot read {}: {}", path, describeErrno(code)));
        }
        if (got == 0) {
            break;
        }
        filled += static_cast<std::size_t>(got);
    }
    ::close(descriptor);
    content.resize(filled);
    return content;
}

}  // namespace sandflow
