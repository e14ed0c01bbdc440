#include "mesh/mesh_gates.h"
#include "mesh/refuse_mesh.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace sandflow {
namespace {

constexpr std::size_t kHeaderSize = 80;            ///< bytes of free text
constexpr std::size_t kBodyAt = kHeaderSize + 4;   ///< behind the number of triangles
constexpr std::size_t kTriangleSize = 12 * 4 + 2;  ///< normal, three corners, attributes

/// Makes the clean copy: binary, with empty header, normals and attributes.
class StlWriter {
public:
    /// Returns whether all corners are finite in single precision; if not they are not added.
    bool addTriangle(const std::array<Vec3, 3>& corners)
    {
        std::array<Vec3f, 3> rounded;
        for (std::size_t i = 0; i < 3; ++i) {
            rounded[i] = corners[i].cast<float>();
            if (!rounded[i].allFinite()) {
                return false;
            }
        }
        body_.append(12, '\0');
        for (const Vec3f& corner : rounded) {
            for (int axis = 0; axis < 3; ++axis) {
                appendBytes(body_, corner[axis]);
            }
        }
        body_.append(2, '\0');
        faceSum_ += hashOfFace(rounded);
        ++count_;
        return true;
    }

    std::uint32_t count() const { return count_; }

    CleanCopy finish() const
    {
        CleanCopy copy;
        copy.fileName = "clean.stl";
        copy.bytes.assign(kHeaderSize, '\0');
        appendBytes(copy.bytes, count_);
        copy.bytes += body_;
        copy.faces = count_;
        copy.faceSum = faceSum_;
        return copy;
    }

private:
    std::string body_;
    std::uint32_t count_ = 0;
    std::uint64_t faceSum_ = 0;
};

bool equalIgnoringCase(std::string_view word, std::string_view lower)
{
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

/// "facet normal a b c", "outer loop", three lines "vertex x y z", "endloop", "endfacet", over and
/// over between "solid name" and "endsolid name"; there may be several solids.
class TextStl {
public:
    TextStl(std::string_view bytes, const std::string& file)
        : file_(file), lines_(withoutMark(bytes))
    {
    }

    CleanCopy pass()
    {
        while (lines_.nextWithWords()) {
            expect("solid", 1);
            readSolid();
        }
        if (writer_.count() == 0) {
            refuseMesh(file_, "the STL file has no triangles");
        }
        return writer_.finish();
    }

private:
    void readSolid()
    {
        while (true) {
            nextLine();
            if (equalIgnoringCase(lines_.words()[0], "endsolid")) {
                return;
            }
            readFacet();
        }
    }

    void readFacet()
    {
        expect("facet", 5);
        nextLine();
        expect("outer", 2);
        std::array<Vec3, 3> corners;
        for (Vec3& corner : corners) {
            nextLine();
            expect("vertex", 4);
            for (int axis = 0; axis < 3; ++axis) {
                const std::string_view word = lines_.words()[static_cast<std::size_t>(axis) + 1];
                const auto number = parseReal(word);
                if (!number) {
                    refuseMesh(file_, "line {}: {} is no coordinate; repair the file",
                               lines_.number(), quoteWord(word));
                }
                corner[axis] = *number;
            }
        }
        nextLine();
        expect("endloop", 1);
        nextLine();
        expect("endfacet", 1);
        if (!writer_.addTriangle(corners)) {
            refuseMesh(file_,
                       "triangle {} (before line {}) has a coordinate that is not finite in single "
                       "precision; repair the file",
                       writer_.count() + 1, lines_.number());
        }
    }

    void nextLine()
    {
        if (!lines_.nextWithWords()) {
            refuseMesh(file_,
                       "the STL file ends after {} triangles without \"endsolid\"; it is cut "
                       "short, copy or export it again",
                       writer_.count());
        }
    }

    /// Names may follow "solid"; the other lines have exactly `count` words.
    void expect(std::string_view keyword, std::size_t count)
    {
        const std::vector<std::string_view>& words = lines_.words();
        const bool counted = keyword == "solid" || words.size() == count;
        if (!counted || !equalIgnoringCase(words[0], keyword)) {
            refuseMesh(file_,
                       "line {} begins with {} and has {} words, where STL needs \"{}\"{}; repair "
                       "or export the file again",
                       lines_.number(), quoteWord(words[0]), words.size(), keyword,
                       counted ? "" : fmt::format(" and {} words in all", count));
        }
    }

    const std::string& file_;
    TextLines lines_;
    StlWriter writer_;
};

CleanCopy passBinary(std::string_view bytes, std::uint32_t count, const std::string& file)
{
    if (count == 0) {
        refuseMesh(file, "the STL file has no triangles");
    }
    StlWriter writer;
    for (std::uint32_t t = 0; t < count; ++t) {
        std::array<float, 9> numbers{};
        std::memcpy(numbers.data(), bytes.data() + kBodyAt + t * kTriangleSize + 12,
                    sizeof numbers);
        const std::array<Vec3, 3> corners{Vec3(numbers[0], numbers[1], numbers[2]),
                                          Vec3(numbers[3], numbers[4], numbers[5]),
                                          Vec3(numbers[6], numbers[7], numbers[8])};
        if (!writer.addTriangle(corners)) {
            refuseMesh(file,
                       "triangle {} of {} has a coordinate that is not finite; repair the "
                       "file",
                       t + 1, count);
        }
    }
    return writer.finish();
}

}  // namespace

CleanCopy passStl(std::string_view bytes, const std::string& file)
{
    std::uint32_t declared = 0;
    if (bytes.size() >= kBodyAt) {
        std::memcpy(&declared, bytes.data() + kHeaderSize, sizeof declared);
        // Binary files may begin with "solid", so the size decides.
        if (bytes.size() - kBodyAt == std::size_t{declared} * kTriangleSize) {
            return passBinary(bytes, declared, file);
        }
    }
    TextLines first(withoutMark(bytes.substr(0, kHeaderSize)));
    const bool hasNul = bytes.substr(0, 2 * kBodyAt).find('\0') != bytes.npos;
    if (first.nextWithWords() && equalIgnoringCase(first.words()[0], "solid") && !hasNul) {
        return TextStl(bytes, file).pass();
    }
    if (bytes.size() < kBodyAt) {
        refuseMesh(file,
                   "the file has {} bytes and does not begin with \"solid\"; it is no STL "
                   "file",
                   bytes.size());
    }
    refuseMesh(file,
               "the binary STL file declares {} triangles, which need {} bytes, but has {}; it is "
               "damaged or cut short, copy or export it again",
               declared, kBodyAt + std::size_t{declared} * kTriangleSize, bytes.size());
}

}  // namespace sandflow
