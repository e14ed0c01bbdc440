#include "core/errors.h"
#include "io/state_file.h"
#include "sample_snapshot.h"
#include "temp_folder.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace sandflow {
namespace {

/// Bitwise, so that -0 and NaN count.
template <typename T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() &&
           (a.empty() ||
            std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                        a.size() * sizeof(T)) == 0);
}

void expectSame(const Snapshot& a, const Snapshot& b)
{
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.time), std::bit_cast<std::uint64_t>(b.time));
    EXPECT_EQ(a.meanRadius, b.meanRadius);
    EXPECT_EQ(a.emitted, b.emitted);
    EXPECT_EQ(a.exited, b.exited);
    EXPECT_TRUE(sameBits(a.id, b.id));
    EXPECT_TRUE(sameBits(a.position, b.position));
    EXPECT_TRUE(sameBits(a.velocity, b.velocity));
    EXPECT_TRUE(sameBits(a.spin, b.spin));
    EXPECT_TRUE(sameBits(a.radius, b.radius));
    EXPECT_TRUE(sameBits(a.state, b.state));
}

TEST(StateFile, bringsEveryBitBack)
{
    TempFolder folder;
    Snapshot heap = makeHeap(1001);
    heap.position[3] = Vec3(1e-310, -0.0, 1e30);
    heap.velocity[5] = Vec3f(0.0F, -0.0F, 0.0F);
    heap.spin[6] = Vec3f(std::nanf(""), 0.0F, 0.0F);
    writeState(folder.file("s.bin"), heap, Durability::synced);
    expectSame(readState(folder.file("s.bin")), heap);
    // Grains at rest take 33 bytes, moving ones 24 more.
    const std::size_t moving = 251 + 2;
    EXPECT_EQ(slurp(folder.file("s.bin")).size(), 68 + 33 * 1001 + 24 * moving + 4);
}

TEST(StateFile, knowsAnEmptyScene)
{
    TempFolder folder;
    Snapshot none;
    none.meanRadius = 0.005;
    writeState(folder.file("s.bin"), none);
    expectSame(readState(folder.file("s.bin")), none);
}

TEST(StateFile, isLittleEndianWithItsNameInFront)
{
    TempFolder folder;
    Snapshot one;
    one.frame = 0x0102030405060708;
    one.meanRadius = 0.005;
    addGrain(one, 0xA1B2C3D4, Vec3(1.0, 0.0, 0.0));
    writeState(folder.file("s.bin"), one);
    const std::string bytes = slurp(folder.file("s.bin"));
    EXPECT_EQ(bytes.substr(0, 12), std::string("SANDSTAT\1\0\0\0", 12));
    EXPECT_EQ(bytes.substr(12, 8), "\x08\x07\x06\x05\x04\x03\x02\x01");
    EXPECT_EQ(bytes.substr(68, 4), "\xD4\xC3\xB2\xA1");
}

TEST(StateFile, refusesEverySingleFlippedBit)
{
    TempFolder folder;
    const std::string path = folder.file("s.bin");
    writeState(path, makeHeap(3));
    const std::string good = slurp(path);
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            std::string bad = good;
            bad[i] = static_cast<char>(static_cast<unsigned char>(bad[i]) ^ (1U << bit));
            spill(path, bad);
            ASSERT_THROW(readState(path), InputError) << "byte " << i << " bit " << bit;
        }
    }
    spill(path, good);
    EXPECT_EQ(readState(path).size(), 3u);
}

TEST(StateFile, refusesEveryOtherLength)
{
    TempFolder folder;
    const std::string path = folder.file("s.bin");
    writeState(path, makeHeap(5));
    const std::string good = slurp(path);
    for (std::size_t length = 0; length < good.size(); ++length) {
        spill(path, good.substr(0, length));
        ASSERT_THROW(readState(path), InputError) << "cut to " << length;
    }
    spill(path, good + '\0');
    EXPECT_THROW(readState(path), InputError);
}

TEST(StateFile, saysWhatIsWrong)
{
    TempFolder folder;
    const std::string path = folder.file("s.bin");
    const auto read = [&] { readState(path); };
    const std::string start = path + " is not a usable state file: ";

    EXPECT_EQ(messageOf<InputError>(read), "cannot open " + path + ": No such file or directory");
    spill(path, "id,x,y,z\n");
    EXPECT_EQ(messageOf<InputError>(read), start + "it was not written by sandflow");
    spill(path, "");
    EXPECT_EQ(messageOf<InputError>(read), start + "it was not written by sandflow");
    spill(path, "SANDSTAT\1");
    EXPECT_EQ(messageOf<InputError>(read), start + "it ends after 9 bytes, within its header");
    writeState(path, makeHeap(5));
    std::string bytes = slurp(path);
    spill(path, bytes.substr(0, 200));
    EXPECT_EQ(messageOf<InputError>(read),
              start + "its checksum is wrong, so it is cut off or damaged");
    bytes[8] = 2;
    spill(path, bytes);
    EXPECT_EQ(messageOf<InputError>(read),
              start + "it has format version 2, this program reads 1");
}

TEST(StateFile, refusesASnapshotThatIsNotOne)
{
    TempFolder folder;
    const std::string path = folder.file("s.bin");
    Snapshot uneven = makeHeap(5);
    uneven.spin.pop_back();
    EXPECT_THROW(writeState(path, uneven), InternalError);
    Snapshot unsorted = makeHeap(5);
    std::swap(unsorted.id[1], unsorted.id[2]);
    EXPECT_THROW(writeState(path, unsorted), InternalError);
    EXPECT_EQ(folder.countEntries(), 0u);
}

}  // namespace
}  // namespace sandflow
