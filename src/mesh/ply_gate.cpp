#include "mesh/mesh_gates.h"
#include "mesh/ply_header.h"
#include "mesh/refuse_mesh.h"
#include "mesh/split_polygon.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace sandflow {
namespace {

/// The numbers behind the header, one after the other.
class PlyBody {
public:
    PlyBody(std::string_view body, PlyFormat format) : body_(body), format_(format), lines_(body) {}

    /// To be called before the numbers of each element: in text it has a line of its own.
    bool begin()
    {
        word_ = 0;
        return format_ != PlyFormat::ascii || lines_.nextWithWords();
    }

    /// Nothing at the end of the line or the file, or where something else than a number stands.
    std::optional<double> read(PlyType type)
    {
        return format_ == PlyFormat::ascii ? readWord(type) : readBinary(type);
    }

    /// Whether the element has no more numbers than were read.
    bool end() const { return format_ != PlyFormat::ascii || word_ == lines_.words().size(); }

    /// Whether nothing but blanks is left.
    bool exhausted()
    {
        if (format_ == PlyFormat::ascii) {
            return !lines_.nextWithWords();
        }
        return body_.find_first_not_of(std::string_view(" \t\r\n\0", 5), at_) == body_.npos;
    }

    bool endedInBreak() const { return format_ != PlyFormat::ascii || lines_.endedInBreak(); }

private:
    std::optional<double> readWord(PlyType type)
    {
        if (word_ == lines_.words().size()) {
            return std::nullopt;
        }
        const std::string_view word = lines_.words()[word_++];
        if (!isInteger(type)) {
            return parseReal(word);
        }
        const auto number = parseInteger(word);
        return number ? std::optional(static_cast<double>(*number)) : std::nullopt;
    }

    std::optional<double> readBinary(PlyType type)
    {
        const std::size_t size = sizeOf(type);
        if (body_.size() - at_ < size) {
            return std::nullopt;
        }
        std::array<char, 8> raw{};
        std::copy_n(body_.data() + at_, size, raw.begin());
        if (format_ == PlyFormat::bigEndian) {
            std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
        }
        at_ += size;
        switch (type) {
            case PlyType::int8:
                return as<std::int8_t>(raw);
            case PlyType::uint8:
                return as<std::uint8_t>(raw);
            case PlyType::int16:
                return as<std::int16_t>(raw);
            case PlyType::uint16:
                return as<std::uint16_t>(raw);
            case PlyType::int32:
                return as<std::int32_t>(raw);
            case PlyType::uint32:
                return as<std::uint32_t>(raw);
            case PlyType::float32:
                return as<float>(raw);
            case PlyType::float64:
                return as<double>(raw);
        }
        return std::nullopt;
    }

    template <typename Number>
    static double as(const std::array<char, 8>& raw)
    {
        Number number{};
        std::memcpy(&number, raw.data(), sizeof number);
        return static_cast<double>(number);
    }

    std::string_view body_;
    PlyFormat format_;
    std::size_t at_ = 0;
    TextLines lines_;
    std::size_t word_ = 0;
};

class PlyGate {
public:
    PlyGate(std::string_view bytes, const std::string& file)
        : file_(file),
          header_(readPlyHeader(bytes, file)),
          body_(bytes.substr(header_.bodyAt), header_.format)
    {
    }

    CleanCopy pass()
    {
        for (std::uint64_t i = 0; i < header_.vertex.count; ++i) {
            readVertex(i);
        }
        for (std::uint64_t i = 0; i < header_.face.count; ++i) {
            readFace(i);
        }
        if (header_.facesAreLast && !body_.exhausted()) {
            refuseMesh(file_,
                       "more data follows the {} faces that the header declares; "
                       "export the file again",
                       header_.face.count);
        }
        CleanCopy copy = writer_.finish();
        if (header_.facesAreLast && !body_.endedInBreak()) {
            copy.repairs.push_back(
                "its last line has no line break: the file may have been cut short");
        }
        return copy;
    }

private:
    [[noreturn]] void refuseShort(const char* what, std::uint64_t index, std::uint64_t count)
    {
        refuseMesh(file_,
                   "{} {} of {} is incomplete or no number; the file is damaged or cut short, "
                   "copy or export it again",
                   what, index, count);
    }

    void readVertex(std::uint64_t index)
    {
        const PlyElement& vertex = header_.vertex;
        if (!body_.begin()) {
            refuseShort("vertex", index, vertex.count);
        }
        Vec3 point;
        for (const PlyProperty& property : vertex.properties) {
            const auto number = body_.read(property.type);
            if (!number) {
                refuseShort("vertex", index, vertex.count);
            }
            if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
                point[property.name[0] - 'x'] = *number;
            }
        }
        if (!body_.end()) {
            refuseMesh(file_, "vertex {} has more numbers than the header declares", index);
        }
        if (!writer_.addPoint(point)) {
            refuseMesh(file_,
                       "vertex {} has the coordinates ({}, {}, {}), which are not finite in single "
                       "precision; repair the file",
                       index, point.x(), point.y(), point.z());
        }
    }

    void readFace(std::uint64_t index)
    {
        const PlyElement& face = header_.face;
        if (!body_.begin()) {
            refuseShort("face", index, face.count);
        }
        for (const PlyProperty& property : face.properties) {
            if (isIndexList(property)) {
                readCorners(property, index);
            } else {
                skip(property, index);
            }
        }
        if (!body_.end()) {
            refuseMesh(file_, "face {} has more numbers than the header declares", index);
        }
        if (!writer_.addFace(corners_)) {
            refuseMesh(file_,
                       "face {} with {} corners crosses itself; split it into triangles in a "
                       "modelling program",
                       index, corners_.size());
        }
    }

    void readCorners(const PlyProperty& list, std::uint64_t index)
    {
        const auto count = body_.read(list.countType);
        if (!count) {
            refuseShort("face", index, header_.face.count);
        }
        if (*count < 3.0 || *count > static_cast<double>(kMaxCorners)) {
            refuseMesh(file_, "face {} has {} corners, allowed are 3 to {}; repair or split it",
                       index, *count, kMaxCorners);
        }
        corners_.clear();
        for (auto left = static_cast<std::size_t>(*count); left > 0; --left) {
            const auto corner = body_.read(list.type);
            if (!corner) {
                refuseShort("face", index, header_.face.count);
            }
            if (*corner < 0.0 || *corner >= static_cast<double>(writer_.pointCount())) {
                refuseMesh(file_,
                           "face {} names vertex {}, but there are only 0 to {}; repair the "
                           "file",
                           index, *corner, writer_.pointCount() - 1);
            }
            corners_.push_back(static_cast<std::uint32_t>(*corner));
        }
    }

    void skip(const PlyProperty& property, std::uint64_t index)
    {
        double count = 1.0;
        if (property.isList) {
            const auto length = body_.read(property.countType);
            if (!length || !(*length >= 0.0) || *length != std::floor(*length)) {
                refuseShort("face", index, header_.face.count);
            }
            count = *length;
        }
        for (; count > 0.0; count -= 1.0) {
            if (!body_.read(property.type)) {
                refuseShort("face", index, header_.face.count);
            }
        }
    }

    const std::string& file_;
    PlyHeader header_;
    PlyBody body_;
    PlyWriter writer_{file_};
    std::vector<std::uint32_t> corners_;
};

}  // namespace

CleanCopy passPly(std::string_view bytes, const std::string& file)
{
    return PlyGate(bytes, file).pass();
}

}  // namespace sandflow
