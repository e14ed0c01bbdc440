#include "mesh/ply_header.h"

#include "mesh/refuse_mesh.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace sandflow {
namespace {

constexpr std::size_t kLongestHeader = 65536;  ///< bytes; real ones have a few hundred

std::optional<PlyType> parseType(std::string_view word)
{
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{{
        {"char", PlyType::int8},
        {"int8", PlyType::int8},
        {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},
        {"short", PlyType::int16},
        {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},
        {"uint16", PlyType::uint16},
        {"int", PlyType::int32},
        {"int32", PlyType::int32},
        {"uint", PlyType::uint32},
        {"uint32", PlyType::uint32},
        {"float", PlyType::float32},
        {"float32", PlyType::float32},
        {"double", PlyType::float64},
        {"float64", PlyType::float64},
    }};
    for (const auto& [name, type] : names) {
        if (name == word) {
            return type;
        }
    }
    return std::nullopt;
}

/// The header's lines; the first one's end says how all others end, so that the body of a binary
/// file may begin with any byte.
class HeaderLines {
public:
    explicit HeaderLines(std::string_view bytes) : bytes_(bytes.substr(0, kLongestHeader))
    {
        const std::size_t end = bytes_.find_first_of("\r\n");
        if (end != bytes_.npos) {
            lineEnd_ = bytes_.substr(end, bytes_.substr(end, 2) == "\r\n" ? 2 : 1);
        }
    }

    bool next()
    {
        const std::size_t end = lineEnd_.empty() ? bytes_.npos : bytes_.find(lineEnd_, at_);
        if (end == bytes_.npos) {
            return false;
        }
        TextLines line(bytes_.substr(at_, end - at_));
        line.next();
        words_ = line.words();
        at_ = end + lineEnd_.size();
        ++number_;
        return true;
    }

    const std::vector<std::string_view>& words() const { return words_; }
    std::size_t number() const { return number_; }
    std::size_t at() const { return at_; }

private:
    std::string_view bytes_;
    std::string_view lineEnd_;
    std::size_t at_ = 0;
    std::size_t number_ = 0;
    std::vector<std::string_view> words_;
};

PlyFormat parseFormat(const std::vector<std::string_view>& words, const std::string& file)
{
    if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
        if (words[1] == "ascii") {
            return PlyFormat::ascii;
        }
        if (words[1] == "binary_little_endian") {
            return PlyFormat::littleEndian;
        }
        if (words[1] == "binary_big_endian") {
            return PlyFormat::bigEndian;
        }
    }
    refuseMesh(file,
               "the PLY header's second entry is not \"format ascii 1.0\" or one of the binary "
               "formats 1.0; export the file again");
}

PlyProperty parseProperty(const std::vector<std::string_view>& words, std::size_t line,
                          const std::string& file)
{
    PlyProperty property;
    property.isList = words.size() == 5 && words[1] == "list";
    if (!property.isList && words.size() != 3) {
        refuseMesh(file, "line {} of the PLY header is no property with a type and a name", line);
    }
    const std::string_view typeWord = words[words.size() - 2];
    const auto type = parseType(typeWord);
    const auto countType = property.isList ? parseType(words[2]) : PlyType::uint8;
    if (!type || !countType) {
        refuseMesh(file,
                   "line {} of the PLY header names the unknown type {}; export the file "
                   "again with float coordinates and int indices",
                   line, quoteWord(type ? words[2] : typeWord));
    }
    property.type = *type;
    property.countType = *countType;
    property.name = words.back();
    return property;
}

PlyElement parseElement(const std::vector<std::string_view>& words, std::size_t line,
                        const std::string& file)
{
    const auto count = words.size() == 3 ? parseInteger(words[2]) : std::nullopt;
    if (!count || *count < 0) {
        refuseMesh(file, "line {} of the PLY header is no element with a name and a count", line);
    }
    return {std::string(words[1]), static_cast<std::uint64_t>(*count), {}};
}

void checkVertex(const PlyElement& vertex, const std::string& file)
{
    if (vertex.count == 0) {
        refuseMesh(file, "the PLY file has no vertices");
    }
    for (const PlyProperty& property : vertex.properties) {
        if (property.isList) {
            refuseMesh(file, "the PLY vertices have a list, {}; export the file again without it",
                       quoteWord(property.name));
        }
    }
    for (const std::string name : {"x", "y", "z"}) {
        const auto count = std::count_if(vertex.properties.begin(), vertex.properties.end(),
                                         [&](const PlyProperty& p) { return p.name == name; });
        if (count != 1) {
            refuseMesh(file, "the PLY vertices have {} properties {}, where one is needed", count,
                       name);
        }
    }
}

void checkFace(const PlyElement& face, const std::string& file)
{
    if (face.count == 0) {
        refuseMesh(file, "the PLY file has points but no faces; export a surface, not a cloud");
    }
    const auto lists = std::count_if(face.properties.begin(), face.properties.end(), isIndexList);
    if (lists != 1) {
        refuseMesh(file,
                   "the PLY faces have {} lists vertex_indices, where one of integers is needed; "
                   "export the file again",
                   lists);
    }
}

PlyHeader sortElements(std::vector<PlyElement> elements, const std::string& file)
{
    for (const PlyElement& element : elements) {
        if (element.name == "tristrips") {
            refuseMesh(file, "the PLY file holds triangle strips; export it again with faces");
        }
    }
    if (elements.size() < 2 || elements[0].name != "vertex" || elements[1].name != "face") {
        refuseMesh(file,
                   "the PLY header does not declare vertices and then faces before all else; "
                   "export the file again as a mesh");
    }
    PlyHeader header;
    header.facesAreLast = std::all_of(elements.begin() + 2, elements.end(),
                                      [](const PlyElement& e) { return e.count == 0; });
    const auto repeated =
        std::find_if(elements.begin() + 2, elements.end(),
                     [](const PlyElement& e) { return e.name == "vertex" || e.name == "face"; });
    if (repeated != elements.end()) {
        refuseMesh(file, "the PLY header declares two {} elements; export the file again",
                   repeated->name);
    }
    header.vertex = std::move(elements[0]);
    header.face = std::move(elements[1]);
    checkVertex(header.vertex, file);
    checkFace(header.face, file);
    return header;
}

}  // namespace

std::size_t sizeOf(PlyType type)
{
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            return 8;
    }
    throw InternalError("unknown PLY type");
}

bool isInteger(PlyType type)
{
    return type != PlyType::float32 && type != PlyType::float64;
}

bool isIndexList(const PlyProperty& property)
{
    return property.isList && isInteger(property.type) && isInteger(property.countType) &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

PlyHeader readPlyHeader(std::string_view bytes, const std::string& file)
{
    HeaderLines lines(bytes);
    if (!lines.next() || lines.words().size() != 1 || lines.words()[0] != "ply") {
        refuseMesh(file, "the file does not begin with a line \"ply\"; it is no PLY file");
    }
    std::optional<PlyFormat> format;
    std::vector<PlyElement> elements;
    while (lines.next()) {
        const std::vector<std::string_view>& words = lines.words();
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
            continue;
        }
        if (!format) {
            format = parseFormat(words, file);
        } else if (words[0] == "element") {
            elements.push_back(parseElement(words, lines.number(), file));
        } else if (words[0] == "property" && !elements.empty()) {
            elements.back().properties.push_back(parseProperty(words, lines.number(), file));
        } else if (words[0] == "end_header" && words.size() == 1) {
            PlyHeader header = sortElements(std::move(elements), file);
            header.format = *format;
            header.bodyAt = lines.at();
            return header;
        } else {
            refuseMesh(file, "line {} of the PLY header, {}, has no meaning; export the file again",
                       lines.number(), quoteWord(words[0]));
        }
    }
    refuseMesh(file, "the PLY header does not end in a line \"end_header\"; the file is cut short");
}

}  // namespace sandflow
