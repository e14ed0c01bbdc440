#include "io/state_file.h"

#include "core/errors.h"
#include "io/snapshot_check.h"

#include <zlib.h>

#include <bit>
#include <concepts>
#include <cstring>
#include <limits>
#include <string_view>

namespace sandflow {
namespace {

constexpr std::string_view kMagic = "SANDSTAT";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint8_t kStateBits = 0x03;
constexpr std::uint8_t kMovingBit = 0x80;
constexpr std::size_t kHeaderSize = 8 + 4 + 7 * 8;
constexpr std::size_t kChecksumSize = 4;
constexpr std::size_t kGrainSize = 4 + 1 + 4 + 3 * 8;
constexpr std::size_t kMotionSize = 6 * 4;

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559);

/// Appends numbers to a buffer of known size, lowest byte first on every machine.
class ByteWriter {
public:
    explicit ByteWriter(std::size_t capacity) { bytes_.reserve(capacity); }

    template <std::unsigned_integral T>
    void put(T number)
    {
        char buffer[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            buffer[i] = static_cast<char>(static_cast<unsigned char>(number >> (8 * i)));
        }
        bytes_.append(buffer, sizeof(T));
    }
    void put(double number) { put(std::bit_cast<std::uint64_t>(number)); }
    void put(float number) { put(std::bit_cast<std::uint32_t>(number)); }
    void put(std::string_view text) { bytes_.append(text); }

    std::string& bytes() { return bytes_; }

private:
    std::string bytes_;
};

/// The mirror image; the caller has made sure that the bytes are there.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    template <std::unsigned_integral T>
    void get(T& number)
    {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            sum |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[i])) << (8 * i);
        }
        number = static_cast<T>(sum);
        bytes_.remove_prefix(sizeof(T));
    }
    void get(double& number)
    {
        std::uint64_t bits = 0;
        get(bits);
        number = std::bit_cast<double>(bits);
    }
    void get(float& number)
    {
        std::uint32_t bits = 0;
        get(bits);
        number = std::bit_cast<float>(bits);
    }
    template <typename Vector>
    void getVector(Vector& vector)
    {
        get(vector.x());
        get(vector.y());
        get(vector.z());
    }
    void skip(std::size_t count) { bytes_.remove_prefix(count); }

private:
    std::string_view bytes_;
};

template <typename Vector>
void putVector(ByteWriter& out, const Vector& vector)
{
    out.put(vector.x());
    out.put(vector.y());
    out.put(vector.z());
}

/// True if any bit of velocity or spin is set: a -0 counts, so that nothing is lost.
bool hasMotion(const Vec3f& velocity, const Vec3f& spin)
{
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    constexpr char zero[sizeof(Vec3f)] = {};
    return std::memcmp(velocity.data(), zero, sizeof zero) != 0 ||
           std::memcmp(spin.data(), zero, sizeof zero) != 0;
}

std::uint32_t computeChecksum(std::string_view bytes)
{
    return static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

[[noreturn]] void refuse(const std::string& path, const std::string& defect)
{
    throw InputError(fmt::format("{} is not a usable state file: {}", path, defect));
}

/// Everything that can be wrong with the file as a whole.
void checkFile(const std::string& path, std::string_view bytes)
{
    if (bytes.substr(0, kMagic.size()) != kMagic.substr(0, bytes.size()) || bytes.empty()) {
        refuse(path, "it was not written by sandflow");
    }
    if (bytes.size() < kHeaderSize + kChecksumSize) {
        refuse(path, fmt::format("it ends after {} bytes, within its header", bytes.size()));
    }
    std::uint32_t version = 0;
    ByteReader(bytes.substr(kMagic.size())).get(version);
    if (version != kVersion) {
        refuse(path, fmt::format("it has format version {}, this program reads {}", version,
                                 kVersion));
    }
    std::uint32_t checksum = 0;
    const std::string_view guarded = bytes.substr(0, bytes.size() - kChecksumSize);
    ByteReader(bytes.substr(guarded.size())).get(checksum);
    if (checksum != computeChecksum(guarded)) {
        refuse(path, "its checksum is wrong, so it is cut off or damaged");
    }
}

}  // namespace

void writeState(const std::string& path, const Snapshot& snapshot, Durability durability)
{
    checkSnapshot(snapshot);
    const std::size_t n = snapshot.size();
    std::size_t moving = 0;
    for (std::size_t i = 0; i < n; ++i) {
        moving += hasMotion(snapshot.velocity[i], snapshot.spin[i]) ? 1 : 0;
    }
    ByteWriter out(kHeaderSize + n * kGrainSize + moving * kMotionSize + kChecksumSize);
    out.put(kMagic);
    out.put(kVersion);
    out.put(snapshot.frame);
    out.put(snapshot.time);
    out.put(snapshot.meanRadius);
    out.put(snapshot.emitted);
    out.put(snapshot.exited);
    out.put(std::uint64_t{n});
    out.put(std::uint64_t{moving});
    for (std::uint32_t id : snapshot.id) {
        out.put(id);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const bool isMoving = hasMotion(snapshot.velocity[i], snapshot.spin[i]);
        out.put(static_cast<std::uint8_t>(static_cast<unsigned>(snapshot.state[i]) |
                                          (isMoving ? kMovingBit : 0U)));
    }
    for (float radius : snapshot.radius) {
        out.put(radius);
    }
    for (const Vec3& position : snapshot.position) {
        putVector(out, position);
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (hasMotion(snapshot.velocity[i], snapshot.spin[i])) {
            putVector(out, snapshot.velocity[i]);
            putVector(out, snapshot.spin[i]);
        }
    }
    out.put(computeChecksum(out.bytes()));
    writeFileAtomically(path, out.bytes(), durability);
}

Snapshot readState(const std::string& path)
{
    const std::string bytes = readWholeFile(path);
    checkFile(path, bytes);
    ByteReader in(bytes);
    in.skip(kMagic.size() + sizeof kVersion);
    Snapshot snapshot;
    std::uint64_t n = 0;
    std::uint64_t moving = 0;
    in.get(snapshot.frame);
    in.get(snapshot.time);
    in.get(snapshot.meanRadius);
    in.get(snapshot.emitted);
    in.get(snapshot.exited);
    in.get(n);
    in.get(moving);
    // Bounds first, so that the product cannot wrap around.
    const std::size_t body = bytes.size() - kHeaderSize - kChecksumSize;
    if (n > body / kGrainSize || moving > n || body != n * kGrainSize + moving * kMotionSize) {
        refuse(path, "its size does not fit the number of grains it announces");
    }
    snapshot.id.resize(n);
    snapshot.state.resize(n);
    snapshot.radius.resize(n);
    snapshot.position.resize(n);
    snapshot.velocity.assign(n, Vec3f::Zero());
    snapshot.spin.assign(n, Vec3f::Zero());
    for (std::uint32_t& id : snapshot.id) {
        in.get(id);
    }
    std::vector<std::uint8_t> flags(n);
    std::size_t movingFlags = 0;
    for (std::size_t i = 0; i < n; ++i) {
        in.get(flags[i]);
        if ((flags[i] & ~(kStateBits | kMovingBit)) != 0) {
            refuse(path, fmt::format("grain {} is in no known state", snapshot.id[i]));
        }
        snapshot.state[i] = static_cast<GrainState>(flags[i] & kStateBits);
        movingFlags += (flags[i] & kMovingBit) != 0 ? 1 : 0;
        if (i > 0 && snapshot.id[i] <= snapshot.id[i - 1]) {
            refuse(path, "its grains are not in the order of their ids");
        }
    }
    if (movingFlags != moving) {
        refuse(path, "its number of moving grains does not add up");
    }
    for (float& radius : snapshot.radius) {
        in.get(radius);
    }
    for (Vec3& position : snapshot.position) {
        in.getVector(position);
    }
    for (std::size_t i = 0; i < n; ++i) {
        if ((flags[i] & kMovingBit) != 0) {
            in.getVector(snapshot.velocity[i]);
            in.getVector(snapshot.spin[i]);
        }
    }
    return snapshot;
}

}  // namespace sandflow
