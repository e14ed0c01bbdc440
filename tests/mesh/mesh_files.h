#pragma once

#include "core/errors.h"
#include "mesh/load_mesh.h"
#include "mesh/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

/// The same box as a file of every format, and what loading a file in memory gives.
namespace sandflow {

inline const Vec3 kBoxMin(-1.0, 2.0, 0.5);
inline const Vec3 kBoxMax(1.0, 5.0, 4.5);
inline constexpr double kBoxVolume = 2.0 * 3.0 * 4.0;

inline TriangleMesh makeTestBox()
{
    return makeBoxMesh(kBoxMin, kBoxMax);
}

template <typename Number>
void putNumber(std::string& bytes, Number number, bool bigEndian = false)
{
    std::array<char, sizeof number> raw{};
    std::memcpy(raw.data(), &number, sizeof number);
    if (bigEndian) {
        std::reverse(raw.begin(), raw.end());
    }
    bytes.append(raw.data(), raw.size());
}

inline std::string writePly(const TriangleMesh& mesh)
{
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        mesh.points.size(), mesh.triangles.size());
    for (const Vec3& p : mesh.points) {
        text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }
    for (const auto& t : mesh.triangles) {
        text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    }
    return text;
}

/// Coordinates in double, extra properties before, between and behind those that count.
inline std::string writeBinaryPly(const TriangleMesh& mesh, bool bigEndian = false)
{
    std::string bytes = fmt::format(
        "ply\nformat binary_{}_endian 1.0\nelement vertex {}\nproperty uchar red\n"
        "property double x\nproperty short curvature\nproperty double y\nproperty double z\n"
        "property float nx\nelement face {}\nproperty uchar flags\n"
        "property list uint8 int32 vertex_index\nproperty list uchar float texcoord\n"
        "element edge 1\nproperty int vertex1\nend_header\n",
        bigEndian ? "big" : "little", mesh.points.size(), mesh.triangles.size());
    for (const Vec3& p : mesh.points) {
        bytes += '\x7f';
        putNumber(bytes, p.x(), bigEndian);
        putNumber(bytes, std::int16_t{-3}, bigEndian);
        putNumber(bytes, p.y(), bigEndian);
        putNumber(bytes, p.z(), bigEndian);
        putNumber(bytes, 0.5f, bigEndian);
    }
    for (const auto& t : mesh.triangles) {
        bytes += '\x01';
        bytes += '\x03';
        for (const std::uint32_t corner : t) {
            putNumber(bytes, corner, bigEndian);
        }
        bytes += '\x02';
        putNumber(bytes, 0.25f, bigEndian);
        putNumber(bytes, 0.75f, bigEndian);
    }
    putNumber(bytes, 0, bigEndian);
    return bytes;
}

/// As scanners write it: float coordinates and triangles, nothing else.
inline std::string writePlainPly(const TriangleMesh& mesh)
{
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        mesh.points.size(), mesh.triangles.size());
    for (const Vec3& p : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            putNumber(bytes, static_cast<float>(p[axis]));
        }
    }
    for (const auto& t : mesh.triangles) {
        bytes += '\x03';
        for (const std::uint32_t corner : t) {
            putNumber(bytes, corner);
        }
    }
    return bytes;
}

inline std::string writeObj(const TriangleMesh& mesh)
{
    std::string text = "# a box\nmtllib box.mtl\no box\n";
    for (const Vec3& p : mesh.points) {
        text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    }
    text += "vn 0 0 1\nvt 0.5 0.5\nusemtl stone\ns off\n";
    for (const auto& t : mesh.triangles) {
        text += fmt::format("f {}/1/1 {}//1 {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

inline std::string writeOff(const TriangleMesh& mesh)
{
    std::string text =
        fmt::format("OFF # a box\n{} {} 0\n\n", mesh.points.size(), mesh.triangles.size());
    for (const Vec3& p : mesh.points) {
        text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }
    for (const auto& t : mesh.triangles) {
        text += fmt::format("3 {} {} {} 0.5 0.5 0.5\n", t[0], t[1], t[2]);
    }
    return text;
}

inline std::string writeStl(const TriangleMesh& mesh)
{
    std::string text = "solid a box\n";
    for (const auto& t : mesh.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t corner : t) {
            const Vec3& p = mesh.points[corner];
            text += fmt::format("vertex {:e} {:e} {:e}\n", p.x(), p.y(), p.z());
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid a box\n";
}

inline std::string writeBinaryStl(const TriangleMesh& mesh)
{
    std::string bytes = "solid, though binary";
    bytes.resize(80, ' ');
    putNumber(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        bytes.append(12, '\0');
        for (const std::uint32_t corner : t) {
            for (int axis = 0; axis < 3; ++axis) {
                putNumber(bytes, static_cast<float>(mesh.points[corner][axis]));
            }
        }
        bytes.append(2, '\0');
    }
    return bytes;
}

/// Points, then indices, as a glTF buffer.
inline std::string gltfBuffer(const TriangleMesh& mesh)
{
    std::string bytes;
    for (const Vec3& p : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            putNumber(bytes, static_cast<float>(p[axis]));
        }
    }
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t corner : t) {
            putNumber(bytes, static_cast<std::uint16_t>(corner));
        }
    }
    return bytes;
}

/// `nodes` as the JSON list of them, of which the scene shows the first; `uri` as the member of the
/// buffer, with a comma before it.
inline std::string gltfJson(const TriangleMesh& mesh, const std::string& nodes = R"({"mesh":0})",
                            const std::string& uri = "")
{
    const std::size_t points = mesh.points.size();
    const std::size_t corners = 3 * mesh.triangles.size();
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":{}}},)"
        R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[{{"byteLength":{}{}}}]}})",
        nodes, points, corners, 12 * points, 12 * points, 2 * corners, 12 * points + 2 * corners,
        uri);
}

inline std::string encodeBase64(const std::string& bytes)
{
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits =
                bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kDigits[(bits >> (18 - 6 * k)) & 63];
        }
    }
    return text;
}

inline std::string writeGltf(const TriangleMesh& mesh, const std::string& nodes = R"({"mesh":0})")
{
    return gltfJson(
        mesh, nodes,
        R"(,"uri":"data:application/octet-stream;base64,)" + encodeBase64(gltfBuffer(mesh)) + "\"");
}

inline std::string writeGlb(const TriangleMesh& mesh, const std::string& nodes = R"({"mesh":0})")
{
    std::string json = gltfJson(mesh, nodes);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string buffer = gltfBuffer(mesh);
    std::string bytes = "glTF";
    putNumber(bytes, 2u);
    putNumber(bytes, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
    putNumber(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    putNumber(bytes, static_cast<std::uint32_t>(buffer.size()));
    return bytes + std::string("BIN\0", 4) + buffer;
}

/// What a load may take, s of processor time; builds that check themselves are slower.
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
inline constexpr double kLongestLoad = 2.0;
#else
inline constexpr double kLongestLoad = 100.0;
#endif

struct MeshFile {
    std::string name;
    std::string extension;
    std::string bytes;
};

/// A mesh in every format and variant.
inline std::vector<MeshFile> writeAllFormats(const TriangleMesh& mesh)
{
    return {{"text PLY", ".ply", writePly(mesh)},
            {"little-endian PLY", ".ply", writeBinaryPly(mesh)},
            {"big-endian PLY", ".ply", writeBinaryPly(mesh, true)},
            {"plain PLY", ".ply", writePlainPly(mesh)},
            {"OBJ", ".obj", writeObj(mesh)},
            {"OFF", ".off", writeOff(mesh)},
            {"text STL", ".stl", writeStl(mesh)},
            {"binary STL", ".stl", writeBinaryStl(mesh)},
            {"glTF", ".gltf", writeGltf(mesh)},
            {"GLB", ".glb", writeGlb(mesh)}};
}

inline LoadedMesh loadBytes(const std::string& bytes, const std::string& extension)
{
    return loadMeshFromMemory(bytes, extension, "m" + extension);
}

/// The sentence with which a file is refused, without its name; empty if it is loaded.
inline std::string refusalOf(const std::string& bytes, const std::string& extension)
{
    try {
        loadBytes(bytes, extension);
    } catch (const InputError& error) {
        const std::string message = error.what();
        const std::string prefix = "m" + extension + ": ";
        EXPECT_TRUE(message.starts_with(prefix)) << message;
        EXPECT_EQ(message.find('\n'), message.npos) << message;
        return message.substr(prefix.size());
    }
    return "";
}

/// A text with its first `from` replaced by `to`; the test fails if there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return at == text.npos ? text : text.replace(at, from.size(), to);
}

inline std::string replacedAll(std::string text, const std::string& from, const std::string& to)
{
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

/// Whether a loaded mesh is the box, whatever the order of its points and triangles.
inline void expectBox(const LoadedMesh& loaded, const std::string& what)
{
    const MeshReport& report = loaded.report;
    EXPECT_EQ(report.points, 8u) << what;
    EXPECT_EQ(report.triangles, 12u) << what;
    EXPECT_EQ(report.components, 1u) << what;
    EXPECT_EQ(report.boundaryEdges, 0u) << what;
    EXPECT_EQ(report.nonManifoldEdges, 0u) << what;
    EXPECT_EQ(report.unbalancedEdges, 0u) << what;
    EXPECT_EQ(report.largestHole, 0.0) << what;
    EXPECT_NEAR(report.signedVolume, kBoxVolume, 1e-6) << what;
    EXPECT_NEAR(signedVolumeOf(loaded.mesh), kBoxVolume, 1e-6) << what;
    EXPECT_EQ(boundsOf(loaded.mesh).min(), kBoxMin) << what;
    EXPECT_EQ(boundsOf(loaded.mesh).max(), kBoxMax) << what;
    EXPECT_EQ(loaded.mesh.points.size(), 8u) << what;
    EXPECT_EQ(loaded.mesh.triangles.size(), 12u) << what;
}

}  // namespace sandflow
