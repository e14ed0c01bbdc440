#include "core/errors.h"
#include "core/hash.h"
#include "io/temp_folder.h"
#include "mesh/sample_cache.h"
#include "mesh/sampling_shapes.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <optional>
#include <zlib.h>

namespace sandflow {
namespace {

namespace fs = std::filesystem;

constexpr double kGap = 0.0045;  ///< m
constexpr std::uint64_t kSeed = 3;
constexpr std::size_t kFirstPoint = 44;  ///< byte at which the points begin

TriangleMesh makeMesh()
{
    return makeSpike(0.02, 0.05);
}

/// The same bits, not only equal numbers.
bool areSame(const SurfaceSamples& a, const SurfaceSamples& b)
{
    const auto areSameBits = [](const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
        return p.size() == q.size() &&
               std::memcmp(p.data(), q.data(), p.size() * sizeof(Vec3)) == 0;
    };
    return areSameBits(a.points, b.points) && areSameBits(a.normals, b.normals);
}

/// Puts the right sum at the end of a file that was changed.
std::string withSum(std::string bytes)
{
    const std::size_t body = bytes.size() - 4;
    const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), body);
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[body + i] = static_cast<char>(static_cast<unsigned char>(sum >> (8 * i)));
    }
    return bytes;
}

class SampleCache : public ::testing::Test {
protected:
    SurfaceSamples fetch() const { return sampleSurfaceCached(mesh, kGap, kSeed, folder); }

    const TriangleMesh mesh = makeMesh();
    const SurfaceSamples fresh = sampleSurface(mesh, kGap, kSeed);
    const TempFolder temporary;
    const fs::path folder = fs::path(temporary.path()) / "deep" / "cache";
    const fs::path file = sampleCacheFile(mesh, kGap, kSeed, folder);
};

TEST_F(SampleCache, GivesTheVerySameBitsFirstAndLater)
{
    EXPECT_GT(fresh.points.size(), 50u);
    EXPECT_TRUE(areSame(fetch(), fresh));
    ASSERT_TRUE(fs::exists(file));
    EXPECT_EQ(fs::file_size(file), kFirstPoint + 48 * fresh.points.size() + 4);
    EXPECT_TRUE(areSame(fetch(), fresh));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(SampleCache, HoldsMoreThanABufferful)
{
    const TriangleMesh large = makeIcosphereMesh(Vec3::Zero(), 0.2, 3);
    const SurfaceSamples first = sampleSurfaceCached(large, kGap, 1, folder);
    ASSERT_GT(first.points.size() * 48, 10u << 16);
    EXPECT_TRUE(areSame(sampleSurfaceCached(large, kGap, 1, folder), first));
}

/// A changed number, under a right sum, shows that the second answer comes from the file; and that
/// zeros with a sign and numbers near the smallest pass through unharmed.
TEST_F(SampleCache, ReadsTheFile)
{
    fetch();
    std::string bytes = slurp(file.string());
    const std::array<double, 3> odd = {-0.0, 4.9e-324, -1.0 / 3.0};
    for (std::size_t d = 0; d < 3; ++d) {
        const auto bits = std::bit_cast<std::uint64_t>(odd[d]);
        for (std::size_t i = 0; i < 8; ++i) {
            bytes[kFirstPoint + 8 * d + i] =
                static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
        }
    }
    spill(file.string(), withSum(bytes));
    SurfaceSamples expected = fresh;
    expected.points[0] = Vec3(odd[0], odd[1], odd[2]);
    EXPECT_TRUE(areSame(fetch(), expected));
}

TEST_F(SampleCache, OtherContentsHaveOtherFiles)
{
    TriangleMesh moved = mesh;
    moved.points[2].x() = std::nextafter(moved.points[2].x(), 1.0);
    const double nextGap = std::nextafter(kGap, 1.0);
    const std::vector<fs::path> files = {file, sampleCacheFile(moved, kGap, kSeed, folder),
                                         sampleCacheFile(mesh, nextGap, kSeed, folder),
                                         sampleCacheFile(mesh, kGap, kSeed + 1, folder)};
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_NE(files[i], files[k]);
        }
    }
    fetch();
    EXPECT_TRUE(areSame(sampleSurfaceCached(mesh, kGap, kSeed + 1, folder),
                        sampleSurface(mesh, kGap, kSeed + 1)));
    // Under a name that is not its own a file is foreign.
    fs::copy_file(file, files[1]);
    EXPECT_TRUE(areSame(sampleSurfaceCached(moved, kGap, kSeed, folder),
                        sampleSurface(moved, kGap, kSeed)));
}

/// Whatever is damaged is noticed and mended.
TEST_F(SampleCache, MakesADamagedFileAnew)
{
    fetch();
    const std::string good = slurp(file.string());
    const auto expectMended = [&](const std::string& bad, const std::string& what) {
        spill(file.string(), bad);
        EXPECT_TRUE(areSame(fetch(), fresh)) << what;
        EXPECT_TRUE(slurp(file.string()) == good) << what;
    };
    for (std::size_t at = 0; at < good.size(); at += at < 60 ? 1 : 97) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 0x10);
        expectMended(bad, "byte " + std::to_string(at));
        if (at < kFirstPoint) {  // version, key and count count even under a right sum
            expectMended(withSum(bad), "byte " + std::to_string(at) + ", with its sum");
        }
        expectMended(good.substr(0, at), "cut at " + std::to_string(at));
    }
    std::string last = good;
    last.back() = static_cast<char>(last.back() ^ 1);
    expectMended(last, "the sum");
    expectMended(good + "x", "longer");
    expectMended("", "empty");
    expectMended(std::string(100000, '\0'), "zeros");
    std::string wild = good;
    std::fill_n(wild.begin() + static_cast<long>(kFirstPoint) - 8, 8, '\xff');
    expectMended(withSum(wild), "count of 2^64 - 1");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(SampleCache, IsNotHeldUpByOtherThingsOfThatName)
{
    fs::create_directories(folder);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_TRUE(areSame(fetch(), fresh));
    fs::remove(file);
    fs::create_directories(file / "inner");
    EXPECT_TRUE(areSame(fetch(), fresh));
    EXPECT_TRUE(fs::exists(file / "inner"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(SampleCache, WorksWithoutAPlaceToWrite)
{
    const std::string plain = temporary.file("plain");
    spill(plain, "a file, no folder");
    for (const fs::path& none : {fs::path(plain), fs::path(plain) / "below", fs::path(),
                                 fs::path("/proc/none"), fs::path(std::string(5000, 'x'))}) {
        EXPECT_TRUE(areSame(sampleSurfaceCached(mesh, kGap, kSeed, none), fresh)) << none;
    }
    EXPECT_EQ(slurp(plain), "a file, no folder");
}

/// A limit on the size of files stands for the full disk; in a process of its own.
TEST_F(SampleCache, AFullDiskLeavesNothingBehind)
{
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{1000, 1000};
        const bool isRight = ::setrlimit(RLIMIT_FSIZE, &small) == 0 && areSame(fetch(), fresh) &&
                             fs::directory_iterator(folder) == fs::directory_iterator();
        ::_exit(isRight ? 0 : 1);
    }
    int status = -1;
    EXPECT_EQ(::waitpid(pid, &status, 0), pid);
    EXPECT_EQ(status, 0);
}

TEST_F(SampleCache, KeepsNothingOfWhatIsRefused)
{
    EXPECT_THROW(sampleSurfaceCached(makeBoxMesh(Vec3::Zero(), Vec3::Ones()), 1e-5, 1, folder),
                 InputError);
    EXPECT_FALSE(fs::exists(folder));
}

/// Writers, readers and one who keeps deleting: nobody ever gets anything but the right samples,
/// and what is left is one whole file.
TEST_F(SampleCache, ProcessesMayShareIt)
{
    constexpr int kProcesses = 4;
    constexpr int kRounds = 60;
    std::vector<pid_t> children;
    for (int child = 0; child < kProcesses; ++child) {
        const pid_t pid = ::fork();
        ASSERT_GE(pid, 0);
        if (pid == 0) {
            int wrong = 0;
            for (int round = 0; round < kRounds; ++round) {
                if (round % kProcesses == child) {
                    std::error_code ignored;
                    fs::remove(file, ignored);
                }
                wrong += areSame(fetch(), fresh) ? 0 : 1;
            }
            ::_exit(wrong == 0 ? 0 : 1);
        }
        children.push_back(pid);
    }
    for (const pid_t pid : children) {
        int status = -1;
        EXPECT_EQ(::waitpid(pid, &status, 0), pid);
        EXPECT_EQ(status, 0);
    }
    EXPECT_TRUE(areSame(fetch(), fresh));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

/// Sets a variable of the environment, or removes it, and puts it back at the end.
class Variable {
public:
    Variable(const char* name, const char* value) : name_(name)
    {
        if (const char* before = std::getenv(name)) {
            before_ = before;
        }
        set(value);
    }
    ~Variable() { set(before_ ? before_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

    void set(const char* value) const
    {
        if (value == nullptr) {
            ::unsetenv(name_);
        } else {
            ::setenv(name_, value, 1);
        }
    }

private:
    const char* name_;
    std::optional<std::string> before_;
};

TEST(SampleCacheFolder, FollowsTheEnvironment)
{
    const Variable own("SANDFLOW_CACHE_DIR", "here");
    const Variable cache("XDG_CACHE_HOME", "/cache");
    const Variable home("HOME", "/home/someone");
    const Variable temporary("TMPDIR", "/tmp");
    EXPECT_EQ(defaultSampleCacheFolder(), "here");
    own.set("");
    EXPECT_EQ(defaultSampleCacheFolder(), "/cache/sandflow");
    own.set(nullptr);
    EXPECT_EQ(defaultSampleCacheFolder(), "/cache/sandflow");
    cache.set("relative");
    EXPECT_EQ(defaultSampleCacheFolder(), "/home/someone/.cache/sandflow");
    cache.set(nullptr);
    EXPECT_EQ(defaultSampleCacheFolder(), "/home/someone/.cache/sandflow");
    home.set("");
    EXPECT_EQ(defaultSampleCacheFolder(), "/tmp/sandflow-cache-" + std::to_string(::geteuid()));
    temporary.set("/no such folder");
    EXPECT_EQ(defaultSampleCacheFolder(), "");
}

}  // namespace
}  // namespace sandflow
