#include "mesh/mesh_gates.h"
#include "mesh/refuse_mesh.h"
#include "mesh/split_polygon.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>

namespace sandflow {
namespace {

/// Statements that do not change where the faces are.
constexpr std::array<std::string_view, 17> kSkipped = {
    "vt",     "vn",  "vp",    "g",        "o",        "s",          "mg",        "usemtl", "usemap",
    "mtllib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "maplib"};

/// The lines of an OBJ file, those that end in a backslash joined with the next.
class ObjLines {
public:
    explicit ObjLines(std::string_view text) : lines_(text) {}

    bool next()
    {
        if (!lines_.nextWithWords()) {
            return false;
        }
        number_ = lines_.number();
        words_ = lines_.words();
        while (!words_.empty() && words_.back().ends_with('\\')) {
            words_.back().remove_suffix(1);
            if (words_.back().empty()) {
                words_.pop_back();
            }
            if (!lines_.next()) {
                break;
            }
            words_.insert(words_.end(), lines_.words().begin(), lines_.words().end());
        }
        const auto comment = std::find_if(words_.begin(), words_.end(),
                                          [](std::string_view w) { return w.starts_with('#'); });
        words_.erase(comment, words_.end());
        return true;
    }

    const std::vector<std::string_view>& words() const { return words_; }
    std::size_t number() const { return number_; }
    bool endedInBreak() const { return lines_.endedInBreak(); }

private:
    TextLines lines_;
    std::size_t number_ = 0;
    std::vector<std::string_view> words_;
};

class ObjGate {
public:
    ObjGate(std::string_view bytes, const std::string& file)
        : file_(file), lines_(withoutMark(bytes))
    {
    }

    CleanCopy pass()
    {
        bool endsInStatement = false;
        while (lines_.next()) {
            if (!lines_.words().empty()) {
                endsInStatement = readStatement(lines_.words()[0]);
            }
        }
        if (writer_.pointCount() == 0) {
            refuseMesh(file_, "the OBJ file has no vertices");
        }
        if (faceLines_.empty()) {
            refuseMesh(file_, "the OBJ file has no faces; export a surface");
        }
        addFaces();
        CleanCopy copy = writer_.finish();
        if (endsInStatement && !lines_.endedInBreak()) {
            copy.repairs.push_back(
                "its last line has no line break: the file may have been cut short");
        }
        if (leftOut_ > 0) {
            copy.repairs.push_back(fmt::format("left out {} points and lines", leftOut_));
        }
        return copy;
    }

private:
    /// Returns whether the statement counts.
    bool readStatement(std::string_view keyword)
    {
        if (keyword == "v") {
            readVertex();
        } else if (keyword == "f") {
            readFace();
        } else if (keyword == "p" || keyword == "l") {
            ++leftOut_;
        } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
            refuseMesh(file_,
                       "line {} begins with {}, which is no OBJ statement for polygons; export "
                       "the file again as polygons",
                       lines_.number(), quoteWord(keyword));
        } else {
            return false;
        }
        return true;
    }

    /// v x y z, then perhaps a weight, a colour, or both.
    void readVertex()
    {
        const std::vector<std::string_view>& words = lines_.words();
        std::array<double, 8> numbers{};
        const std::size_t count = words.size() - 1;
        bool good = count >= 3 && count < numbers.size();
        for (std::size_t i = 0; good && i < count; ++i) {
            const auto number = parseReal(words[i + 1]);
            good = number.has_value();
            numbers[i] = number.value_or(0.0);
        }
        if (!good) {
            refuseMesh(file_, "line {}: vertex {} is not x y z; repair the file", lines_.number(),
                       writer_.pointCount() + 1);
        }
        if ((count == 4 || count == 7) && numbers[3] != 1.0) {
            refuseMesh(file_,
                       "line {}: vertex {} has the weight {}; export the file without "
                       "weights",
                       lines_.number(), writer_.pointCount() + 1, numbers[3]);
        }
        if (!writer_.addPoint({numbers[0], numbers[1], numbers[2]})) {
            refuseMesh(file_,
                       "line {}: vertex {} has the coordinates ({}, {}, {}), which are not "
                       "finite in single precision; repair the file",
                       lines_.number(), writer_.pointCount() + 1, numbers[0], numbers[1],
                       numbers[2]);
        }
    }

    /// Corners may name vertices that come later, so they are checked at the end.
    void readFace()
    {
        const std::vector<std::string_view>& words = lines_.words();
        const std::size_t count = words.size() - 1;
        if (count < 3 || count > kMaxCorners) {
            refuseMesh(file_,
                       "line {}: face {} has {} corners, allowed are 3 to {}; repair or "
                       "split it",
                       lines_.number(), faceLines_.size() + 1, count, kMaxCorners);
        }
        for (std::size_t i = 1; i <= count; ++i) {
            corners_.push_back(readCorner(words[i]));
        }
        faceLines_.push_back(lines_.number());
        faceEnds_.push_back(corners_.size());
    }

    /// "7", "7/1", "7//3" or "7/1/3"; a negative number counts back from the last vertex. Returns
    /// the index from 0; those of a missing vertex are found in addFaces.
    std::int64_t readCorner(std::string_view word)
    {
        const std::size_t slash = std::min(word.find('/'), word.size());
        const auto index = parseInteger(word.substr(0, slash));
        const bool restGood = word.find_first_not_of("0123456789/-", slash) == word.npos &&
                              std::count(word.begin(), word.end(), '/') <= 2;
        if (!index || !restGood) {
            refuseMesh(file_, "line {}: {} is no corner of a face; repair the file",
                       lines_.number(), quoteWord(word));
        }
        const auto points = static_cast<std::int64_t>(writer_.pointCount());
        const std::int64_t fromZero = *index > 0 ? *index - 1 : points + *index;
        if (*index == 0 || fromZero < 0) {
            refuseMesh(file_,
                       "line {}: face {} names vertex {}, which does not exist; repair the "
                       "file",
                       lines_.number(), faceLines_.size() + 1, *index);
        }
        return fromZero;
    }

    void addFaces()
    {
        const auto points = static_cast<std::int64_t>(writer_.pointCount());
        std::vector<std::uint32_t> face;
        std::size_t at = 0;
        for (std::size_t f = 0; f < faceLines_.size(); ++f) {
            face.clear();
            for (; at < faceEnds_[f]; ++at) {
                if (corners_[at] >= points) {
                    refuseMesh(file_,
                               "line {}: face {} names vertex {}, but there are only {}; the file "
                               "is damaged or cut short, copy or export it again",
                               faceLines_[f], f + 1, corners_[at] + 1, points);
                }
                face.push_back(static_cast<std::uint32_t>(corners_[at]));
            }
            if (!writer_.addFace(face)) {
                refuseMesh(file_,
                           "line {}: face {} with {} corners crosses itself; split it into "
                           "triangles in a modelling program",
                           faceLines_[f], f + 1, face.size());
            }
        }
    }

    const std::string& file_;
    ObjLines lines_;
    PlyWriter writer_{file_};
    std::vector<std::int64_t> corners_;
    std::vector<std::size_t> faceEnds_;  ///< into corners_, one per face
    std::vector<std::size_t> faceLines_;
    std::size_t leftOut_ = 0;  ///< points and lines
};

}  // namespace

CleanCopy passObj(std::string_view bytes, const std::string& file)
{
    return ObjGate(bytes, file).pass();
}

}  // namespace sandflow
