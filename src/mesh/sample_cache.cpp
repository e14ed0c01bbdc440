#include "mesh/sample_cache.h"

#include "core/errors.h"
#include "core/hash.h"

#include <sys/stat.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <zlib.h>

namespace sandflow {
namespace {

namespace fs = std::filesystem;

// The file, numbers lowest byte first:
//
//     magic 8 | version 4 | mesh 8 | gap 8 | seed 8 | count 8 | count x (point 24, normal 24) | crc
//     4
//
// The sum covers all bytes before it.
constexpr std::string_view kMagic = "SANDSMPL";

/// Raise it when the layout changes, or when sampleSurface gives other bits than before: files of
/// other versions are then made anew.
constexpr std::uint32_t kVersion = 1;

constexpr std::size_t kHeaderSize = 8 + 4 + 4 * 8;
constexpr std::size_t kSampleSize = 6 * 8;
constexpr std::size_t kChecksumSize = 4;
constexpr std::size_t kBufferSize = std::size_t{1} << 16;

static_assert(std::numeric_limits<double>::is_iec559);

/// What a file is known by.
struct CacheKey {
    std::uint64_t mesh;
    std::uint64_t gap;  ///< its bits
    std::uint64_t seed;
};

/// An open file; closed at the end of its life.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    bool isOpen() const { return number_ >= 0; }
    int number() const { return number_; }

    bool close() { return number_ >= 0 && ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

std::uint32_t addToChecksum(std::uint32_t sum, std::string_view bytes)
{
    return static_cast<std::uint32_t>(
        crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Writes numbers through a buffer. A failure is remembered and makes all further writing void.
class SumWriter {
public:
    explicit SumWriter(int descriptor) : descriptor_(descriptor) { buffer_.reserve(kBufferSize); }

    void putText(std::string_view text)
    {
        buffer_.append(text);
        if (buffer_.size() >= kBufferSize - sizeof(std::uint64_t)) {
            flush();
        }
    }
    void putNumber(std::uint64_t number, std::size_t bytes)
    {
        std::array<char, sizeof number> text{};
        for (std::size_t i = 0; i < bytes; ++i) {
            text[i] = static_cast<char>(static_cast<unsigned char>(number >> (8 * i)));
        }
        putText({text.data(), bytes});
    }
    void putVector(const Vec3& vector)
    {
        for (const double component : vector) {
            putNumber(std::bit_cast<std::uint64_t>(component), sizeof component);
        }
    }

    /// Appends the sum of all before; true if everything was written.
    bool finish()
    {
        flush();
        putNumber(sum_, kChecksumSize);
        flush();
        return !failed_;
    }

private:
    void flush()
    {
        sum_ = addToChecksum(sum_, buffer_);
        std::string_view left = buffer_;
        while (!left.empty() && !failed_) {
            const ssize_t written = ::write(descriptor_, left.data(), left.size());
            if (written >= 0) {
                left.remove_prefix(static_cast<std::size_t>(written));
            } else if (errno != EINTR) {
                failed_ = true;
            }
        }
        buffer_.clear();
    }

    int descriptor_;
    std::string buffer_;
    std::uint32_t sum_ = 0;
    bool failed_ = false;
};

/// The mirror image. What is read after the end of the file is 0 and makes it a failure.
class SumReader {
public:
    explicit SumReader(int descriptor) : descriptor_(descriptor), buffer_(kBufferSize, '\0') {}

    std::uint64_t getNumber(std::size_t bytes)
    {
        std::uint64_t number = 0;
        for (std::size_t i = 0; i < bytes; ++i) {
            if (next_ == filled_) {
                fill();
            }
            if (failed_) {
                return 0;
            }
            const auto byte = static_cast<unsigned char>(buffer_[next_++]);
            number |= static_cast<std::uint64_t>(byte) << (8 * i);
        }
        return number;
    }
    Vec3 getVector()
    {
        Vec3 vector;
        for (double& component : vector) {
            component = std::bit_cast<double>(getNumber(sizeof component));
        }
        return vector;
    }

    /// Reads the sum; true if it fits all that was read before.
    bool finish()
    {
        const std::uint32_t sum =
            addToChecksum(sum_, std::string_view(buffer_).substr(summed_, next_ - summed_));
        return getNumber(kChecksumSize) == sum && !failed_;
    }

private:
    void fill()
    {
        sum_ = addToChecksum(sum_, std::string_view(buffer_).substr(summed_, filled_ - summed_));
        next_ = summed_ = filled_ = 0;
        ssize_t got = -1;
        do {
            got = ::read(descriptor_, buffer_.data(), buffer_.size());
        } while (got < 0 && errno == EINTR);
        if (got <= 0) {
            failed_ = true;
        } else {
            filled_ = static_cast<std::size_t>(got);
        }
    }

    int descriptor_;
    std::string buffer_;
    std::size_t summed_ = 0;  ///< bytes of the buffer that are in sum_ already
    std::size_t next_ = 0;
    std::size_t filled_ = 0;
    std::uint32_t sum_ = 0;
    bool failed_ = false;
};

/// Nothing unless the file is whole and holds what the key stands for.
std::optional<SurfaceSamples> readSamples(const fs::path& path, const CacheKey& key)
{
    // Non-blocking: a pipe of that name must not be waited for.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (!file.isOpen() || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    SumReader in(file.number());
    for (const char expected : kMagic) {
        if (in.getNumber(1) != static_cast<unsigned char>(expected)) {
            return std::nullopt;
        }
    }
    if (in.getNumber(4) != kVersion || in.getNumber(8) != key.mesh || in.getNumber(8) != key.gap ||
        in.getNumber(8) != key.seed) {
        return std::nullopt;
    }
    // The count is believed only if it fits the size of the file: no wild number takes memory.
    const std::uint64_t count = in.getNumber(8);
    if (count > kMostSurfaceSamples || static_cast<std::uint64_t>(status.st_size) !=
                                           kHeaderSize + count * kSampleSize + kChecksumSize) {
        return std::nullopt;
    }
    SurfaceSamples samples;
    samples.points.reserve(count);
    samples.normals.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        samples.points.push_back(in.getVector());
        samples.normals.push_back(in.getVector());
    }
    if (!in.finish()) {
        return std::nullopt;
    }
    return samples;
}

bool writeContent(int descriptor, const CacheKey& key, const SurfaceSamples& samples)
{
    SumWriter out(descriptor);
    out.putText(kMagic);
    out.putNumber(kVersion, 4);
    out.putNumber(key.mesh, 8);
    out.putNumber(key.gap, 8);
    out.putNumber(key.seed, 8);
    out.putNumber(samples.points.size(), 8);
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
        out.putVector(samples.points[i]);
        out.putVector(samples.normals[i]);
    }
    return out.finish();
}

/// Written aside under a name nobody else has, then renamed: others see the old file, or none, or
/// the whole new one. Not synced: what a power cut leaves behind fails the checksum.
void writeSamples(const fs::path& path, const CacheKey& key, const SurfaceSamples& samples)
{
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    std::string aside = path.string() + ".XXXXXX";
    Descriptor file(::mkostemp(aside.data(), O_CLOEXEC));
    if (!file.isOpen()) {
        return;
    }
    // Readable for all whom the folder lets in, as mkostemp does not make it.
    const bool isWhole = writeContent(file.number(), key, samples) &&
                         ::fchmod(file.number(), 0644) == 0 && file.close();
    if (!isWhole || ::rename(aside.c_str(), path.c_str()) != 0) {
        ::unlink(aside.c_str());
    }
}

CacheKey keyOf(const TriangleMesh& mesh, double gap, std::uint64_t seed)
{
    return {contentHashOf(mesh), std::bit_cast<std::uint64_t>(gap), seed};
}

fs::path fileOf(const CacheKey& key, const fs::path& folder)
{
    const std::uint64_t name = extendHash(extendHash(key.mesh, key.gap), key.seed);
    return folder / fmt::format("samples-{:016x}.bin", name);
}

fs::path pathFromEnvironment(const char* variable)
{
    const char* value = std::getenv(variable);
    return value == nullptr ? fs::path() : fs::path(value);
}

}  // namespace

SurfaceSamples sampleSurfaceCached(const TriangleMesh& mesh, double gap, std::uint64_t seed,
                                   const fs::path& folder)
{
    if (folder.empty()) {
        return sampleSurface(mesh, gap, seed);
    }
    const CacheKey key = keyOf(mesh, gap, seed);
    const fs::path path = fileOf(key, folder);
    if (std::optional<SurfaceSamples> kept = readSamples(path, key)) {
        return std::move(*kept);
    }
    SurfaceSamples samples = sampleSurface(mesh, gap, seed);
    writeSamples(path, key, samples);
    return samples;
}

fs::path defaultSampleCacheFolder()
{
    const fs::path own = pathFromEnvironment("SANDFLOW_CACHE_DIR");
    if (!own.empty()) {
        return own;
    }
    const fs::path cache = pathFromEnvironment("XDG_CACHE_HOME");
    if (cache.is_absolute()) {
        return cache / "sandflow";
    }
    const fs::path home = pathFromEnvironment("HOME");
    if (home.is_absolute()) {
        return home / ".cache" / "sandflow";
    }
    std::error_code failed;
    const fs::path temporary = fs::temp_directory_path(failed);
    return failed ? fs::path() : temporary / fmt::format("sandflow-cache-{}", ::geteuid());
}

fs::path sampleCacheFile(const TriangleMesh& mesh, double gap, std::uint64_t seed,
                         const fs::path& folder)
{
    return fileOf(keyOf(mesh, gap, seed), folder);
}

}  // namespace sandflow
