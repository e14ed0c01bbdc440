#include "mesh_files.h"

#include <ctime>
#include <random>

namespace sandflow {
namespace {

/// Spoils a file in one to three places, as a bad disk, a cut-off copy or a slip of the hand would.
class FileMutator {
public:
    explicit FileMutator(std::uint64_t seed) : bits_(seed) {}

    std::string mutate(std::string bytes)
    {
        for (auto changes = 1 + below(3); changes > 0; --changes) {
            change(bytes);
        }
        return bytes;
    }

private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : (bits_() >> 11) % end; }

    void change(std::string& bytes)
    {
        const std::size_t at = below(bytes.size());
        switch (below(8)) {
            case 0:
            case 1:
                if (!bytes.empty()) {
                    bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                }
                break;
            case 2:
                bytes.insert(at, 1, static_cast<char>(below(256)));
                break;
            case 3:
                bytes.erase(at, 1 + below(12));
                break;
            case 4:
                if (below(4) == 0) {
                    bytes.resize(at);
                } else {
                    bytes.insert(at, bytes.substr(below(bytes.size()), below(40)));
                }
                break;
            case 5:
                replaceNumber(bytes, at);
                break;
            case 6:
                dropOrRepeatLine(bytes, at);
                break;
            default:
                // Four bytes of a binary number.
                for (std::size_t i = at; i < bytes.size() && i < at + 4; ++i) {
                    bytes[i] = static_cast<char>(below(3) == 0 ? 0xff : below(256));
                }
        }
    }

    void replaceNumber(std::string& bytes, std::size_t near)
    {
        static const std::string numbers[] = {"0",
                                              "-1",
                                              "1",
                                              "3",
                                              "7",
                                              "8",
                                              "9",
                                              "255",
                                              "256",
                                              "65535",
                                              "4294967295",
                                              "4294967296",
                                              "99999999999999999999",
                                              "1e39",
                                              "-1e999",
                                              "nan",
                                              "inf",
                                              "0.5",
                                              "1e-45",
                                              "",
                                              "-",
                                              ".",
                                              "0x10",
                                              "1e",
                                              "\xef\xbb\xbf",
                                              "\n",
                                              "//"};
        const std::size_t begin = bytes.find_first_of("0123456789", near);
        if (begin == bytes.npos) {
            return;
        }
        const std::size_t end =
            std::min(bytes.find_first_not_of("0123456789.e+-", begin), bytes.size());
        bytes.replace(begin, end - begin, numbers[below(std::size(numbers))]);
    }

    void dropOrRepeatLine(std::string& bytes, std::size_t near)
    {
        const std::size_t begin = bytes.rfind('\n', near);
        if (begin == bytes.npos) {
            return;
        }
        const std::size_t end = std::min(bytes.find('\n', begin + 1), bytes.size());
        if (below(2) == 0) {
            bytes.erase(begin, end - begin);
        } else {
            bytes.insert(begin, bytes.substr(begin, end - begin));
        }
    }

    std::mt19937_64 bits_;
};

void expectSound(const LoadedMesh& loaded)
{
    ASSERT_FALSE(loaded.mesh.triangles.empty());
    for (const Vec3& p : loaded.mesh.points) {
        ASSERT_TRUE(p.allFinite());
    }
    for (const auto& t : loaded.mesh.triangles) {
        ASSERT_LT(std::max({t[0], t[1], t[2]}), loaded.mesh.points.size());
        ASSERT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    }
    ASSERT_TRUE(std::isfinite(loaded.report.signedVolume));
    ASSERT_TRUE(std::isfinite(loaded.report.largestHole));
    ASSERT_EQ(loaded.report.points, loaded.mesh.points.size());
    ASSERT_EQ(loaded.report.triangles, loaded.mesh.triangles.size());
}

/// What became of the mutations of one file.
struct Outcome {
    int loaded = 0;
    int refused = 0;
    double longest = 0.0;  ///< s of processor time
};

Outcome mutateFile(const MeshFile& file, int count, std::uint64_t seed)
{
    FileMutator mutator(seed);
    Outcome outcome;
    for (int i = 0; i < count; ++i) {
        const std::string bytes = mutator.mutate(file.bytes);
        const std::clock_t start = std::clock();
        try {
            expectSound(loadBytes(bytes, file.extension));
            ++outcome.loaded;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_TRUE(message.starts_with("m" + file.extension + ": ")) << message;
            EXPECT_LT(message.size(), 500u) << message;
            EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) {
                return c >= ' ' && c <= '~';
            })) << message;
            ++outcome.refused;
        } catch (const std::exception& error) {
            ADD_FAILURE() << file.name << ", mutation " << i
                          << ": neither a mesh nor an InputError: " << error.what();
        }
        outcome.longest =
            std::max(outcome.longest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return outcome;
}

/// Every outcome is a sound mesh or a sentence, in far less than two seconds.
TEST(MeshMutations, ASpoiltFileIsAMeshOrAnInputError)
{
    // Half of all for PLY, the format of the scans.
    TriangleMesh two = makeBoxMesh(kBoxMin, kBoxMax);
    two.points.push_back(Vec3(7.0, 7.0, 7.0));
    two.triangles.push_back({0, 7, 8});
    std::uint64_t seed = 20240601;
    int total = 0;
    for (const MeshFile& file : writeAllFormats(two)) {
        const int count = file.extension == ".ply" ? 16000 : 8000;
        const Outcome outcome = mutateFile(file, count, seed++);
        std::string key = file.name;
        std::replace_if(
            key.begin(), key.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
        RecordProperty(key, fmt::format("{} loaded, {} refused, longest {:.3f} s", outcome.loaded,
                                        outcome.refused, outcome.longest));
        EXPECT_EQ(outcome.loaded + outcome.refused, count);
        EXPECT_GT(outcome.loaded, count / 100) << file.name;
        EXPECT_GT(outcome.refused, count / 5) << file.name;
        EXPECT_LT(outcome.longest, kLongestLoad) << file.name;
        total += count;
    }
    EXPECT_GE(total, 100000);
}

}  // namespace
}  // namespace sandflow
