#include "mesh/gltf_buffers.h"

#include "mesh/refuse_mesh.h"
#include "mesh/text_lines.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace sandflow {
namespace {

// Component types, by their numbers in the format.
constexpr std::size_t kUint8 = 5121;
constexpr std::size_t kUint16 = 5123;
constexpr std::size_t kUint32 = 5125;
constexpr std::size_t kFloat = 5126;

std::size_t componentSize(std::size_t componentType)
{
    return componentType == kUint8 ? 1 : componentType == kUint16 ? 2 : 4;
}

/// Empty if the text is not base64.
std::optional<std::string> decodeBase64(std::string_view text)
{
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::int8_t, 256> valueOf{};
    valueOf.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
        valueOf[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
    }
    const std::size_t padding = text.size() - (text.find_last_not_of('=') + 1);
    if (padding > 2) {
        return std::nullopt;
    }
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int filled = 0;
    for (const char c : text.substr(0, text.size() - padding)) {
        const int value = valueOf[static_cast<unsigned char>(c)];
        if (value < 0) {
            return std::nullopt;
        }
        bits = (bits << 6) | static_cast<std::uint32_t>(value);
        filled += 6;
        if (filled >= 8) {
            filled -= 8;
            bytes += static_cast<char>((bits >> filled) & 0xff);
        }
    }
    return bytes;
}

/// "My%20mesh.bin" -> "My mesh.bin"
std::string decodePercent(std::string_view uri)
{
    constexpr std::string_view kHex = "0123456789abcdef0123456789ABCDEF";
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const std::size_t high = i + 2 < uri.size() ? kHex.find(uri[i + 1]) : kHex.npos;
        const std::size_t low = i + 2 < uri.size() ? kHex.find(uri[i + 2]) : kHex.npos;
        if (uri[i] == '%' && high != kHex.npos && low != kHex.npos) {
            name += static_cast<char>(16 * (high % 16) + low % 16);
            i += 2;
        } else {
            name += uri[i];
        }
    }
    return name;
}

}  // namespace

const JsonValue& gltfItem(const JsonValue& root, std::string_view array, std::size_t index,
                          const std::string& file)
{
    const JsonValue* items = root.find(array);
    const std::size_t count =
        items != nullptr && items->kind == JsonValue::Kind::array ? items->items.size() : 0;
    if (index >= count || items->items[index].kind != JsonValue::Kind::object) {
        refuseMesh(file, "{} {} is asked for, but the glTF file has no such object among its {}",
                   array, index, count);
    }
    return items->items[index];
}

std::size_t gltfIndex(const JsonValue& object, std::string_view key, std::size_t fallback,
                      const std::string& file)
{
    const JsonValue* value = object.find(key);
    if (value == nullptr) {
        return fallback;
    }
    const auto index = value->asIndex();
    if (!index) {
        refuseMesh(file, "\"{}\" in the glTF file is no whole number from 0; repair the file", key);
    }
    return *index;
}

GltfBuffers::GltfBuffers(const JsonValue& root, std::string_view binaryChunk,
                         const std::string& file, const ReadSibling& read)
    : root_(root), file_(file), binaryChunk_(binaryChunk)
{
    const JsonValue* buffers = root.find("buffers");
    const std::size_t count =
        buffers != nullptr && buffers->kind == JsonValue::Kind::array ? buffers->items.size() : 0;
    for (std::size_t i = 0; i < count; ++i) {
        buffers_.push_back(loadBuffer(gltfItem(root, "buffers", i, file), i, read));
        // A small file may name a large one over and over.
        constexpr std::size_t kMostBytes = 250'000'000;
        size_ += buffers_.back().size();
        if (size_ > kMostBytes) {
            refuseMesh(file, "the buffers of the glTF file have more than 250 MB; reduce the mesh");
        }
    }
}

std::string GltfBuffers::loadBuffer(const JsonValue& buffer, std::size_t index,
                                    const ReadSibling& read)
{
    const std::size_t length = gltfIndex(buffer, "byteLength", 0, file_);
    const JsonValue* uri = buffer.find("uri");
    std::optional<std::string> bytes;
    if (uri == nullptr) {
        if (index == 0) {
            bytes = binaryChunk_;
        }
    } else if (uri->text.starts_with("data:")) {
        constexpr std::string_view kMark = ";base64,";
        const std::size_t mark = uri->text.find(kMark);
        if (mark != uri->text.npos) {
            bytes = decodeBase64(std::string_view(uri->text).substr(mark + kMark.size()));
        }
    } else {
        const std::string name = decodePercent(uri->text);
        bytes = read(name);
        if (!bytes) {
            refuseMesh(file_,
                       "buffer {} of the glTF file is in {}, which cannot be read as a file of the "
                       "same folder; put it there, or export as .glb",
                       index, quoteWord(name));
        }
    }
    if (!bytes || bytes->size() < length) {
        refuseMesh(file_,
                   "buffer {} of the glTF file declares {} bytes but has {}; it is damaged or cut "
                   "short, copy or export it again",
                   index, length, bytes ? bytes->size() : 0);
    }
    bytes->resize(length);
    return *std::move(bytes);
}

GltfBuffers::Elements GltfBuffers::find(std::size_t index, std::string_view type) const
{
    const JsonValue& accessor = gltfItem(root_, "accessors", index, file_);
    const JsonValue* typeValue = accessor.find("type");
    if (typeValue == nullptr || typeValue->text != type) {
        refuseMesh(file_, "accessor {} of the glTF file is not of type {}; repair the file", index,
                   type);
    }
    if (accessor.find("sparse") != nullptr || accessor.find("bufferView") == nullptr) {
        refuseMesh(file_,
                   "accessor {} of the glTF file is sparse; export the file without sparse "
                   "accessors",
                   index);
    }
    Elements elements{};
    elements.componentType = gltfIndex(accessor, "componentType", 0, file_);
    const bool known = type == "VEC3" ? elements.componentType == kFloat
                                      : elements.componentType == kUint8 ||
                                            elements.componentType == kUint16 ||
                                            elements.componentType == kUint32;
    if (!known) {
        refuseMesh(file_,
                   "accessor {} of the glTF file has the component type {}; export the file with "
                   "float positions and unsigned indices",
                   index, elements.componentType);
    }
    const JsonValue& view =
        gltfItem(root_, "bufferViews", gltfIndex(accessor, "bufferView", 0, file_), file_);
    const std::size_t buffer = gltfIndex(view, "buffer", SIZE_MAX, file_);
    const std::size_t viewAt = gltfIndex(view, "byteOffset", 0, file_);
    const std::size_t viewSize = gltfIndex(view, "byteLength", 0, file_);
    const std::size_t size = componentSize(elements.componentType) * (type == "VEC3" ? 3 : 1);
    const std::size_t at = gltfIndex(accessor, "byteOffset", 0, file_);
    elements.count = gltfIndex(accessor, "count", 0, file_);
    elements.stride = gltfIndex(view, "byteStride", size, file_);
    // None of the terms exceeds 2^53, so the sums do not overflow; the product is a division.
    const bool viewFits = buffer < buffers_.size() && viewAt + viewSize <= buffers_[buffer].size();
    const bool fits = viewFits && elements.count > 0 && elements.stride >= size &&
                      at + size <= viewSize &&
                      elements.count - 1 <= (viewSize - at - size) / elements.stride;
    if (!fits) {
        refuseMesh(file_,
                   "accessor {} of the glTF file does not fit into its buffer; the file is "
                   "damaged, copy or export it again",
                   index);
    }
    elements.first = buffers_[buffer].data() + viewAt + at;
    return elements;
}

std::vector<Vec3f> GltfBuffers::readPoints(std::size_t accessor) const
{
    const Elements elements = find(accessor, "VEC3");
    std::vector<Vec3f> points(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i) {
        std::memcpy(points[i].data(), elements.first + i * elements.stride, sizeof(Vec3f));
        if (!points[i].allFinite()) {
            refuseMesh(file_, "vertex {} of accessor {} is not finite; repair the file", i,
                       accessor);
        }
    }
    return points;
}

std::vector<std::uint32_t> GltfBuffers::readIndices(std::size_t accessor) const
{
    const Elements elements = find(accessor, "SCALAR");
    const std::size_t size = componentSize(elements.componentType);
    std::vector<std::uint32_t> indices(elements.count, 0);
    for (std::size_t i = 0; i < elements.count; ++i) {
        std::memcpy(&indices[i], elements.first + i * elements.stride, size);
    }
    return indices;
}

}  // namespace sandflow
