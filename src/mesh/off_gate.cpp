#include "mesh/mesh_gates.h"
#include "mesh/refuse_mesh.h"
#include "mesh/split_polygon.h"
#include "mesh/text_lines.h"

#include <algorithm>

namespace sandflow {
namespace {

class OffGate {
public:
    OffGate(std::string_view bytes, const std::string& file)
        : file_(file), lines_(withoutMark(bytes))
    {
    }

    CleanCopy pass()
    {
        readHeader();
        for (std::int64_t i = 0; i < vertexCount_; ++i) {
            readVertex(i);
        }
        for (std::int64_t i = 0; i < faceCount_; ++i) {
            readFace(i);
        }
        const bool endedInBreak = lines_.endedInBreak();
        if (nextLine()) {
            refuseMesh(file_,
                       "line {} follows the {} faces that the header declares; export the file "
                       "again",
                       lines_.number(), faceCount_);
        }
        CleanCopy copy = writer_.finish();
        if (!endedInBreak) {
            copy.repairs.push_back(
                "its last line has no line break: the file may have been cut short");
        }
        return copy;
    }

private:
    /// Goes to the next line that has words before its comment.
    bool nextLine()
    {
        while (lines_.nextWithWords()) {
            words_ = lines_.words();
            const auto comment =
                std::find_if(words_.begin(), words_.end(),
                             [](std::string_view word) { return word.starts_with('#'); });
            words_.erase(comment, words_.end());
            if (!words_.empty()) {
                return true;
            }
        }
        words_.clear();
        return false;
    }

    /// "OFF", before it ST, C or N for texture coordinates, colours, normals: they all stand behind
    /// the coordinates of a vertex. Then, on that line or the next, the counts.
    void readHeader()
    {
        if (!nextLine()) {
            refuseMesh(file_, "the file is empty");
        }
        std::string_view keyword = words_[0];
        for (const std::string_view prefix : {"ST", "C", "N"}) {
            if (keyword.starts_with(prefix)) {
                keyword.remove_prefix(prefix.size());
            }
        }
        if (keyword != "OFF") {
            refuseMesh(file_,
                       "the file begins with {}, not with OFF in one of its forms for three "
                       "dimensions; export it again",
                       quoteWord(words_[0]));
        }
        words_.erase(words_.begin());
        if (words_.empty()) {
            nextLine();
        }
        const auto vertices = words_.size() > 1 ? parseInteger(words_[0]) : std::nullopt;
        const auto faces = words_.size() > 1 ? parseInteger(words_[1]) : std::nullopt;
        if (!vertices || !faces || words_.size() > 3) {
            refuseMesh(file_,
                       "line {} does not give the numbers of vertices, faces and edges of an OFF "
                       "file in text; export it again",
                       lines_.number());
        }
        if (*vertices <= 0 || *faces <= 0) {
            refuseMesh(file_, "the OFF file has {} vertices and {} faces; export a surface",
                       *vertices, *faces);
        }
        vertexCount_ = *vertices;
        faceCount_ = *faces;
    }

    void readVertex(std::int64_t index)
    {
        Vec3 point;
        bool good = nextLine() && words_.size() >= 3;
        for (std::size_t i = 0; good && i < words_.size(); ++i) {
            const auto number = parseReal(words_[i]);
            good = number.has_value();
            if (i < 3) {
                point[static_cast<Eigen::Index>(i)] = number.value_or(0.0);
            }
        }
        if (!good) {
            refuseMesh(file_,
                       "vertex {} of {} (line {}) is not x y z; the file is damaged or cut short, "
                       "copy or export it again",
                       index, vertexCount_, lines_.number());
        }
        if (!writer_.addPoint(point)) {
            refuseMesh(file_,
                       "vertex {} (line {}) has the coordinates ({}, {}, {}), which are not finite "
                       "in single precision; repair the file",
                       index, lines_.number(), point.x(), point.y(), point.z());
        }
    }

    /// The number of corners, the corners, then perhaps a colour.
    void readFace(std::int64_t index)
    {
        const auto count = nextLine() ? parseInteger(words_[0]) : std::nullopt;
        if (!count) {
            refuseFace(index);
        }
        if (*count < 3 || *count > static_cast<std::int64_t>(kMaxCorners)) {
            refuseMesh(file_,
                       "face {} (line {}) has {} corners, allowed are 3 to {}; repair or split it",
                       index, lines_.number(), *count, kMaxCorners);
        }
        const auto end = static_cast<std::size_t>(*count) + 1;
        if (words_.size() < end) {
            refuseFace(index);
        }
        corners_.clear();
        for (std::size_t i = 1; i < words_.size(); ++i) {
            if (i < end) {
                corners_.push_back(readCorner(words_[i], index));
            } else if (!parseReal(words_[i])) {
                refuseFace(index);
            }
        }
        if (!writer_.addFace(corners_)) {
            refuseMesh(file_,
                       "face {} (line {}) with {} corners crosses itself; split it into triangles "
                       "in a modelling program",
                       index, lines_.number(), corners_.size());
        }
    }

    std::uint32_t readCorner(std::string_view word, std::int64_t face)
    {
        const auto corner = parseInteger(word);
        if (!corner) {
            refuseFace(face);
        }
        if (*corner < 0 || *corner >= vertexCount_) {
            refuseMesh(file_,
                       "face {} (line {}) names vertex {}, but there are only 0 to {}; repair the "
                       "file",
                       face, lines_.number(), *corner, vertexCount_ - 1);
        }
        return static_cast<std::uint32_t>(*corner);
    }

    [[noreturn]] void refuseFace(std::int64_t index)
    {
        refuseMesh(file_,
                   "face {} of {} (line {}) is incomplete or no number; the file is damaged or cut "
                   "short, copy or export it again",
                   index, faceCount_, lines_.number());
    }

    const std::string& file_;
    TextLines lines_;
    std::vector<std::string_view> words_;  ///< of the line at hand, without its comment
    std::int64_t vertexCount_ = 0;
    std::int64_t faceCount_ = 0;
    PlyWriter writer_{file_};
    std::vector<std::uint32_t> corners_;
};

}  // namespace

CleanCopy passOff(std::string_view bytes, const std::string& file)
{
    return OffGate(bytes, file).pass();
}

}  // namespace sandflow
