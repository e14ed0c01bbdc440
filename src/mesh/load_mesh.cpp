#include "mesh/load_mesh.h"

#include "mesh/mesh_gates.h"
#include "mesh/read_with_assimp.h"
#include "mesh/refuse_mesh.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <new>
#include <optional>
#include <system_error>

namespace sandflow {
namespace {

// Loading stays below 1 GB of memory: a triangle takes 200 to 400 bytes on the way.
constexpr std::uintmax_t kMaxFileSize = 250'000'000;  ///< bytes
constexpr std::uint64_t kMostFaces = 2'000'000;

std::string lowerExtension(std::string extension)
{
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

/// Opening a FIFO would wait for ever, a device might never end: only regular files are opened.
std::string readRegularFile(const std::filesystem::path& path)
{
    const std::string name = path.string();
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        refuseMesh(name, "there is no such file");
    }
    if (!std::filesystem::is_regular_file(status)) {
        refuseMesh(name, "it is not a regular file but a folder, a pipe or a device");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size == 0 || size > kMaxFileSize) {
        refuseMesh(name, "it has {} bytes, allowed are 1 to {}; {}", error ? 0 : size, kMaxFileSize,
                   size == 0 ? "export the mesh again" : "reduce the mesh");
    }
    std::ifstream in(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size))) {
        refuseMesh(name, "it cannot be read ({}); check its permissions",
                   std::generic_category().message(errno));
    }
    return bytes;
}

/// A file beside the mesh. Names that lead elsewhere are not followed.
std::optional<std::string> readSibling(const std::filesystem::path& folder, const std::string& name)
{
    const std::filesystem::path relative(name);
    const bool leadsAway = relative.is_absolute() || name.find('\0') != name.npos ||
                           name.find(':') != name.npos ||
                           std::find(relative.begin(), relative.end(), "..") != relative.end();
    if (name.empty() || leadsAway) {
        return std::nullopt;
    }
    try {
        // A link in the folder must not lead out of it either.
        std::error_code error;
        const std::filesystem::path home = std::filesystem::canonical(folder, error);
        const std::filesystem::path target = std::filesystem::canonical(folder / relative, error);
        const auto [homeEnd, targetAt] =
            std::mismatch(home.begin(), home.end(), target.begin(), target.end());
        static_cast<void>(targetAt);
        if (error || homeEnd != home.end()) {
            return std::nullopt;
        }
        return readRegularFile(target);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

CleanCopy passGate(std::string_view bytes, const std::string& extension, const std::string& name,
                   const ReadSibling& read)
{
    const std::string lower = lowerExtension(extension);
    if (lower == ".ply") {
        return passPly(bytes, name);
    }
    if (lower == ".obj") {
        return passObj(bytes, name);
    }
    if (lower == ".off") {
        return passOff(bytes, name);
    }
    if (lower == ".stl") {
        return passStl(bytes, name);
    }
    if (lower == ".gltf" || lower == ".glb") {
        return passGltf(bytes, name, read);
    }
    refuseMesh(name,
               "its ending is none of .ply, .obj, .stl, .off, .gltf and .glb; convert it to one of "
               "these");
}

LoadedMesh load(std::string_view bytes, const std::string& extension, const std::string& name,
                const ReadSibling& read)
{
    try {
        LoadedMesh loaded;
        const CleanCopy copy = passGate(bytes, extension, name, read);
        if (copy.faces > kMostFaces) {
            refuseMesh(name, "it has {} faces, allowed are {}; reduce the mesh", copy.faces,
                       kMostFaces);
        }
        loaded.mesh = readWithAssimp(copy, name);
        loaded.report = cleanMesh(loaded.mesh, name);
        loaded.report.repairs.insert(loaded.report.repairs.begin(), copy.repairs.begin(),
                                     copy.repairs.end());
        return loaded;
    } catch (const std::bad_alloc&) {
        throw SystemError(name + ": there is not enough memory to load the mesh");
    }
}

}  // namespace

LoadedMesh loadMesh(const std::filesystem::path& path)
{
    // Refuse a wrong ending before all of it is read.
    const std::string extension = lowerExtension(path.extension().string());
    constexpr std::array kEndings = {".ply", ".obj", ".stl", ".off", ".gltf", ".glb"};
    const bool known = std::find(kEndings.begin(), kEndings.end(), extension) != kEndings.end();
    const std::string bytes = known ? readRegularFile(path) : std::string();
    return load(bytes, extension, path.string(), [&](const std::string& name) {
        return readSibling(path.has_parent_path() ? path.parent_path() : ".", name);
    });
}

LoadedMesh loadMeshFromMemory(std::string_view bytes, const std::string& extension,
                              const std::string& name)
{
    return load(bytes, extension, name,
                [](const std::string&) { return std::optional<std::string>(); });
}

}  // namespace sandflow
