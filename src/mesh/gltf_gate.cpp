#include "mesh/gltf_buffers.h"
#include "mesh/mesh_gates.h"
#include "mesh/refuse_mesh.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <set>

namespace sandflow {
namespace {

constexpr int kMaxNodeDepth = 256;
/// Corners and points that instances may make of fewer in the file: 100 MB or so.
constexpr std::uint64_t kMaxInstancedNumbers = 6'000'000;
/// Nodes, and parts of meshes: assimp spends kilobytes on each.
constexpr std::size_t kMaxParts = 20'000;
/// Bytes that parts which share their numbers may make of fewer in the file.
constexpr std::size_t kMaxSharedBytes = 100'000'000;

/// The two chunks of a GLB file; of a text file the whole and nothing.
struct GltfChunks {
    std::string_view json;
    std::string_view binary;
};

std::uint32_t wordAt(std::string_view bytes, std::size_t at)
{
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

/// Magic, version, length; then chunks of length, type, bytes.
GltfChunks splitChunks(std::string_view bytes, const std::string& file)
{
    constexpr std::uint32_t kJson = 0x4e4f534a;
    constexpr std::uint32_t kBinary = 0x004e4942;
    if (!bytes.starts_with("glTF")) {
        return {withoutMark(bytes), {}};
    }
    if (bytes.size() < 20 || wordAt(bytes, 4) != 2) {
        refuseMesh(file, "the file is no GLB of version 2; export it again");
    }
    if (wordAt(bytes, 8) != bytes.size() || wordAt(bytes, 12) > bytes.size() - 20 ||
        wordAt(bytes, 16) != kJson) {
        refuseMesh(file,
                   "the GLB file declares {} bytes and has {}, or its first chunk is no JSON; it "
                   "is damaged or cut short, copy or export it again",
                   wordAt(bytes, 8), bytes.size());
    }
    GltfChunks chunks{bytes.substr(20, wordAt(bytes, 12)), {}};
    const std::size_t next = 20 + chunks.json.size();
    if (bytes.size() - next >= 8 && wordAt(bytes, next + 4) == kBinary) {
        if (wordAt(bytes, next) > bytes.size() - next - 8) {
            refuseMesh(file,
                       "the binary chunk of the GLB file is cut short; copy or export it again");
        }
        chunks.binary = bytes.substr(next + 8, wordAt(bytes, next));
    }
    return chunks;
}

JsonValue parseRoot(std::string_view json, const std::string& file)
{
    try {
        JsonValue root = parseJson(json);
        const JsonValue* asset = root.find("asset");
        const JsonValue* version = asset != nullptr ? asset->find("version") : nullptr;
        if (version == nullptr || !version->text.starts_with("2.")) {
            refuseMesh(file, "the file does not name itself glTF 2; export it as glTF 2.0");
        }
        return root;
    } catch (const JsonError& error) {
        refuseMesh(file, "the file is not the JSON of glTF: {}; export it again", error.what());
    }
}

/// Extensions that change the look, not the shape.
bool isLook(std::string_view extension)
{
    return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_") ||
           extension.starts_with("KHR_lights_") || extension.starts_with("EXT_texture_");
}

/// What became of a mesh of the file.
struct ReadMesh {
    std::size_t index = 0;  ///< in the clean copy
    std::uint64_t triangles = 0;
    std::uint64_t numbers = 0;  ///< corners and points
    std::uint64_t faceSum = 0;
};

class GltfGate {
public:
    GltfGate(const JsonValue& root, std::string_view binaryChunk, const std::string& file,
             const ReadSibling& read)
        : root_(root), file_(file), buffers_(root, binaryChunk, file, read)
    {
    }

    CleanCopy pass()
    {
        checkExtensions();
        const JsonValue& scene =
            gltfItem(root_, "scenes", gltfIndex(root_, "scene", 0, file_), file_);
        const std::vector<std::size_t> roots = readNodes(scene.find("nodes"), 0);
        if (copy_.faces == 0) {
            refuseMesh(file_, "the scene of the glTF file has no triangles; export a surface");
        }
        copy_.fileName = "clean.gltf";
        copy_.bytes = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],)"
            R"("meshes":[{}],"accessors":[{}],"bufferViews":[{}],)"
            R"("buffers":[{{"byteLength":{},"uri":"{}"}}]}})",
            fmt::join(roots, ","), fmt::join(nodes_, ","), fmt::join(meshes_, ","),
            fmt::join(accessors_, ","), fmt::join(views_, ","), copy_.buffer.size(),
            CleanCopy::kBufferName);
        if (leftOut_ > 0) {
            copy_.repairs.push_back(fmt::format("left out {} sets of points or lines", leftOut_));
        }
        if (moving_) {
            copy_.repairs.push_back("took moving parts as they stand before they move");
        }
        return std::move(copy_);
    }

private:
    void checkExtensions()
    {
        if (const JsonValue* required = root_.find("extensionsRequired")) {
            for (const JsonValue& extension : required->items) {
                if (!isLook(extension.text)) {
                    refuseMesh(file_,
                               "the glTF file needs the extension {}; export it without "
                               "compression or other extensions",
                               quoteWord(extension.text));
                }
            }
        }
        moving_ = root_.find("skins") != nullptr || root_.find("animations") != nullptr;
    }

    /// Copies the nodes of a list with all below them; returns their indices in the copy.
    std::vector<std::size_t> readNodes(const JsonValue* list, int depth)
    {
        std::vector<std::size_t> indices;
        if (list == nullptr) {
            return indices;
        }
        if (depth > kMaxNodeDepth) {
            refuseMesh(file_, "the nodes of the glTF file are nested more than {} deep; flatten it",
                       kMaxNodeDepth);
        }
        for (const JsonValue& item : list->items) {
            const auto index = item.asIndex();
            if (!index) {
                refuseMesh(file_, "a list of nodes in the glTF file holds no index; repair it");
            }
            const JsonValue& node = gltfItem(root_, "nodes", *index, file_);
            // A node with two parents could stand for a billion of them.
            if (!seen_.insert(*index).second) {
                refuseMesh(file_,
                           "node {} of the glTF file has two parents or is its own; repair the "
                           "file",
                           *index);
            }
            indices.push_back(readNode(node, *index, depth));
        }
        return indices;
    }

    std::size_t readNode(const JsonValue& node, std::size_t index, int depth)
    {
        std::string text = fmt::format(R"("matrix":[{}])", fmt::join(readMatrix(node, index), ","));
        if (node.find("mesh") != nullptr) {
            const ReadMesh& read = readMesh(gltfIndex(node, "mesh", 0, file_));
            if (read.triangles > 0) {
                text += fmt::format(R"(,"mesh":{})", read.index);
                place(read);
            }
        }
        const std::vector<std::size_t> children = readNodes(node.find("children"), depth + 1);
        if (!children.empty()) {
            text += fmt::format(R"(,"children":[{}])", fmt::join(children, ","));
        }
        nodes_.push_back("{" + text + "}");
        checkParts(nodes_.size());
        return nodes_.size() - 1;
    }

    /// Counts a node's triangles.
    void place(const ReadMesh& mesh)
    {
        copy_.faces += mesh.triangles;
        copy_.faceSum += mesh.faceSum;
        placedNumbers_ += mesh.numbers;
        if (placedNumbers_ > std::max(kMaxInstancedNumbers, storedNumbers_)) {
            refuseMesh(file_,
                       "the nodes of the glTF file show its meshes so often that there are "
                       "more than {} corners and points; reduce it",
                       kMaxInstancedNumbers);
        }
    }

    void checkParts(std::size_t count) const
    {
        if (count > kMaxParts) {
            refuseMesh(file_, "the glTF file has more than {} nodes or parts of meshes; join them",
                       kMaxParts);
        }
    }

    std::vector<double> readNumbers(const JsonValue& node, std::string_view key,
                                    std::vector<double> fallback, std::size_t index) const
    {
        const JsonValue* list = node.find(key);
        if (list == nullptr) {
            return fallback;
        }
        std::vector<double> numbers;
        for (const JsonValue& item : list->items) {
            // Beyond this, products of a few of them would not be finite in single precision.
            constexpr double kLargest = 1e9;
            if (item.kind != JsonValue::Kind::number || !(std::abs(item.number) <= kLargest)) {
                break;
            }
            numbers.push_back(item.number);
        }
        if (numbers.size() != fallback.size() || list->items.size() != fallback.size()) {
            refuseMesh(file_,
                       "\"{}\" of node {} in the glTF file is not made of {} numbers below 1e9; "
                       "repair the file",
                       key, index, fallback.size());
        }
        return numbers;
    }

    /// Column by column, as the format has it.
    std::vector<double> readMatrix(const JsonValue& node, std::size_t index) const
    {
        const std::vector<double> matrix =
            readNumbers(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, index);
        if (matrix[3] != 0.0 || matrix[7] != 0.0 || matrix[11] != 0.0 || matrix[15] != 1.0) {
            refuseMesh(file_, "\"matrix\" of node {} in the glTF file is a projection; repair it",
                       index);
        }
        if (node.find("matrix") != nullptr) {
            return matrix;
        }
        const std::vector<double> t = readNumbers(node, "translation", {0, 0, 0}, index);
        const std::vector<double> r = readNumbers(node, "rotation", {0, 0, 0, 1}, index);
        const std::vector<double> s = readNumbers(node, "scale", {1, 1, 1}, index);
        const Eigen::Quaterniond rotation(r[3], r[0], r[1], r[2]);
        constexpr double kTolerance = 0.01;  // of the length 1 that the format demands
        if (!(std::abs(rotation.norm() - 1.0) < kTolerance)) {
            refuseMesh(file_,
                       "\"rotation\" of node {} in the glTF file has the length {}, not 1; "
                       "repair the file",
                       index, rotation.norm());
        }
        Eigen::Affine3d affine = Eigen::Affine3d::Identity();
        affine.linear() =
            rotation.normalized().toRotationMatrix() * Vec3(s[0], s[1], s[2]).asDiagonal();
        affine.translation() = Vec3(t[0], t[1], t[2]);
        return {affine.matrix().data(), affine.matrix().data() + 16};
    }

    const ReadMesh& readMesh(std::size_t index)
    {
        const auto [found, isNew] = read_.try_emplace(index);
        if (!isNew) {
            return found->second;
        }
        ReadMesh& mesh = found->second;
        std::vector<std::string> primitives;
        if (const JsonValue* list = gltfItem(root_, "meshes", index, file_).find("primitives")) {
            for (const JsonValue& primitive : list->items) {
                readPrimitive(primitive, index, mesh, primitives);
            }
        }
        storedNumbers_ += mesh.numbers;
        if (mesh.triangles > 0) {
            mesh.index = meshes_.size();
            meshes_.push_back(fmt::format(R"({{"primitives":[{}]}})", fmt::join(primitives, ",")));
        }
        return mesh;
    }

    void readPrimitive(const JsonValue& primitive, std::size_t meshIndex, ReadMesh& mesh,
                       std::vector<std::string>& primitives)
    {
        const std::size_t mode = gltfIndex(primitive, "mode", 4, file_);
        if (mode < 4) {
            ++leftOut_;
            return;
        }
        const JsonValue* attributes = primitive.find("attributes");
        if (mode > 6 || attributes == nullptr || attributes->find("POSITION") == nullptr) {
            refuseMesh(file_,
                       "mesh {} of the glTF file has a part without positions, or of the "
                       "unknown mode {}; repair the file",
                       meshIndex, mode);
        }
        const std::vector<Vec3f> points =
            buffers_.readPoints(gltfIndex(*attributes, "POSITION", 0, file_));
        const std::vector<std::uint32_t> corners =
            readTriangles(primitive, mode, points.size(), meshIndex);
        if (corners.empty()) {
            return;
        }
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            mesh.faceSum +=
                hashOfFace({points[corners[i]], points[corners[i + 1]], points[corners[i + 2]]});
        }
        mesh.triangles += corners.size() / 3;
        mesh.numbers += corners.size() + points.size();
        checkParts(accessors_.size() / 2);
        const std::size_t position = writeAccessor(points.data(), points.size(), 5126, "VEC3");
        const std::size_t indices = writeAccessor(corners.data(), corners.size(), 5125, "SCALAR");
        primitives.push_back(fmt::format(
            R"({{"attributes":{{"POSITION":{}}},"indices":{},"mode":4}})", position, indices));
    }

    /// The corners of triangles, three each; strips and fans are taken apart.
    std::vector<std::uint32_t> readTriangles(const JsonValue& primitive, std::size_t mode,
                                             std::size_t points, std::size_t meshIndex) const
    {
        std::vector<std::uint32_t> list;
        if (primitive.find("indices") != nullptr) {
            list = buffers_.readIndices(gltfIndex(primitive, "indices", 0, file_));
        } else {
            for (std::size_t i = 0; i < points; ++i) {
                list.push_back(static_cast<std::uint32_t>(i));
            }
        }
        const auto bad = std::find_if(list.begin(), list.end(),
                                      [&](std::uint32_t index) { return index >= points; });
        if (bad != list.end()) {
            refuseMesh(file_,
                       "index {} of mesh {} in the glTF file names vertex {}, but there are "
                       "only 0 to {}; repair the file",
                       bad - list.begin(), meshIndex, *bad, points - 1);
        }
        if (list.size() < 3 || (mode == 4 && list.size() % 3 != 0)) {
            refuseMesh(file_,
                       "mesh {} of the glTF file has {} corners, which are no triangles; "
                       "repair the file",
                       meshIndex, list.size());
        }
        if (mode == 4) {
            return list;
        }
        std::vector<std::uint32_t> corners;
        for (std::size_t i = 0; i + 2 < list.size(); ++i) {
            // Every second triangle of a strip runs the other way.
            const std::size_t odd = i % 2;
            const std::uint32_t first = mode == 5 ? list[i] : list[0];
            const std::size_t second = mode == 5 ? i + 1 + odd : i + 1;
            const std::size_t third = mode == 5 ? i + 2 - odd : i + 2;
            corners.insert(corners.end(), {first, list[second], list[third]});
        }
        return corners;
    }

    template <typename Element>
    std::size_t writeAccessor(const Element* data, std::size_t count, int componentType,
                              std::string_view type)
    {
        const std::size_t size = count * sizeof(Element);
        if (copy_.buffer.size() + size > std::max(kMaxSharedBytes, 4 * buffers_.size())) {
            refuseMesh(file_,
                       "the meshes of the glTF file share their numbers so often that they have "
                       "more than {} bytes; reduce it",
                       kMaxSharedBytes);
        }
        views_.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                                     copy_.buffer.size(), size));
        copy_.buffer.append(reinterpret_cast<const char*>(data), size);
        accessors_.push_back(fmt::format(
            R"({{"bufferView":{},"byteOffset":0,"componentType":{},"count":{},"type":"{}"}})",
            views_.size() - 1, componentType, count, type));
        return accessors_.size() - 1;
    }

    const JsonValue& root_;
    const std::string& file_;
    GltfBuffers buffers_;
    CleanCopy copy_;
    std::set<std::size_t> seen_;            ///< nodes of the file
    std::map<std::size_t, ReadMesh> read_;  ///< meshes of the file
    std::uint64_t storedNumbers_ = 0;       ///< corners and points in those meshes
    std::uint64_t placedNumbers_ = 0;       ///< the same, once for every node with them
    std::size_t leftOut_ = 0;               ///< sets of points or lines
    bool moving_ = false;
    // The clean copy's objects, as text.
    std::vector<std::string> nodes_;
    std::vector<std::string> meshes_;
    std::vector<std::string> accessors_;
    std::vector<std::string> views_;
};

}  // namespace

CleanCopy passGltf(std::string_view bytes, const std::string& file, const ReadSibling& read)
{
    const GltfChunks chunks = splitChunks(bytes, file);
    const JsonValue root = parseRoot(chunks.json, file);
    return GltfGate(root, chunks.binary, file, read).pass();
}

}  // namespace sandflow
