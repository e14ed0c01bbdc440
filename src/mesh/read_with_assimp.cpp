#include "mesh/read_with_assimp.h"

#include "mesh/refuse_mesh.h"

#include <assimp/Importer.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

namespace sandflow {
namespace {

class MemoryStream : public Assimp::IOStream {
public:
    explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}

    std::size_t Read(void* to, std::size_t size, std::size_t count) override
    {
        const std::size_t items = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
        std::memcpy(to, bytes_.data() + at_, items * size);
        at_ += items * size;
        return items;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override
    {
        const std::size_t from = origin == aiOrigin_SET   ? 0
                                 : origin == aiOrigin_CUR ? at_
                                                          : bytes_.size();
        if (offset > bytes_.size() - from) {
            return aiReturn_FAILURE;
        }
        at_ = from + offset;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return at_; }
    std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

/// The only files that assimp may open: the clean copy and its buffer.
class CopyFiles : public Assimp::IOSystem {
public:
    explicit CopyFiles(const CleanCopy& copy) : copy_(copy) {}

    bool Exists(const char* name) const override { return find(name) != nullptr; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* name, const char*) override
    {
        const std::string* bytes = find(name);
        return bytes == nullptr ? nullptr : new MemoryStream(*bytes);
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    const std::string* find(std::string_view name) const
    {
        name.remove_prefix(name.rfind('/') + 1);  // npos + 1 is 0
        return name == copy_.fileName            ? &copy_.bytes
               : name == CleanCopy::kBufferName ? &copy_.buffer
                                                 : nullptr;
    }

    const CleanCopy& copy_;
};

/// Calls visit(mesh, transform to the root) for every mesh of every node.
template <typename Visit>
void visitMeshes(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent,
                 Visit& visit)
{
    Eigen::Affine3d here;
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column) {
            here.matrix()(row, column) = static_cast<double>(node.mTransformation[row][column]);
        }
    }
    here = parent * here;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        visit(*scene.mMeshes[node.mMeshes[m]], here);
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
        visitMeshes(scene, *node.mChildren[c], here, visit);
    }
}

template <typename Visit>
void visitMeshes(const aiScene& scene, Visit visit)
{
    visitMeshes(scene, *scene.mRootNode, Eigen::Affine3d::Identity(), visit);
}

/// Whether assimp's faces are the gate's. Later steps need valid indices.
bool agrees(const aiScene& scene, const CleanCopy& copy)
{
    std::uint64_t faces = 0;
    std::uint64_t faceSum = 0;
    bool valid = true;
    std::vector<Vec3f> corners;
    visitMeshes(scene, [&](const aiMesh& mesh, const Eigen::Affine3d&) {
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            corners.clear();
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                if (face.mIndices[i] >= mesh.mNumVertices) {
                    valid = false;
                    return;
                }
                const aiVector3D& v = mesh.mVertices[face.mIndices[i]];
                corners.emplace_back(v.x, v.y, v.z);
            }
            ++faces;
            faceSum += hashOfFace(corners);
        }
    });
    return valid && faces == copy.faces && faceSum == copy.faceSum;
}

/// Of every face; nothing if they all are triangles.
std::vector<std::vector<unsigned>> cornersOf(const aiMesh& mesh)
{
    std::vector<std::vector<unsigned>> faces;
    const bool anyPolygon =
        std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                    [](const aiFace& face) { return face.mNumIndices > 3; });
    if (anyPolygon) {
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            faces.emplace_back(face.mIndices, face.mIndices + face.mNumIndices);
        }
    }
    return faces;
}

/// assimp leaves a polygon half split if it finds no ear to cut off. It keeps the order of faces,
/// so n corners must be followed by n - 2 triangles of the same corners.
void checkSplit(const std::vector<std::vector<unsigned>>& polygons, const aiMesh& mesh,
                const std::string& file)
{
    unsigned at = 0;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        const std::vector<unsigned>& polygon = polygons[p];
        for (std::size_t left = polygon.size() - 2; left > 0; --left, ++at) {
            const bool fits =
                at < mesh.mNumFaces &&
                std::all_of(mesh.mFaces[at].mIndices, mesh.mFaces[at].mIndices + 3,
                            [&](unsigned corner) {
                                return std::find(polygon.begin(), polygon.end(), corner) !=
                                       polygon.end();
                            });
            if (!fits) {
                refuseMesh(file,
                           "face {} (from 0) with {} corners crosses itself or is folded; split it "
                           "into triangles in a modelling program",
                           p, polygon.size());
            }
        }
    }
    if (!polygons.empty() && at != mesh.mNumFaces) {
        refuseMesh(file, "its polygons could not be split into triangles; split them in a modelling "
                   "program");
    }
}

void splitPolygons(Assimp::Importer& importer, const std::string& file)
{
    const aiScene* scene = importer.GetScene();
    std::vector<std::vector<std::vector<unsigned>>> polygons;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        polygons.push_back(cornersOf(*scene->mMeshes[m]));
    }
    scene = importer.ApplyPostProcessing(aiProcess_ValidateDataStructure | aiProcess_Triangulate |
                                         aiProcess_SortByPType);
    if (scene == nullptr || scene->mNumMeshes != polygons.size()) {
        refuseMesh(file, "assimp cannot split its polygons into triangles ({}); split them in a "
                   "modelling program",
                   importer.GetErrorString());
    }
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        checkSplit(polygons[m], *scene->mMeshes[m], file);
    }
}

void appendMesh(const aiMesh& mesh, const Eigen::Affine3d& transform, TriangleMesh& result)
{
    const auto first = static_cast<std::uint32_t>(result.points.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& v = mesh.mVertices[i];
        result.points.push_back(transform * Vec3(v.x, v.y, v.z));
    }
    // A mirror turns outside in, so it changes the order of the corners.
    const bool mirrored = transform.linear().determinant() < 0.0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const unsigned* corner = mesh.mFaces[f].mIndices;
        result.triangles.push_back({first + corner[0], first + corner[mirrored ? 2 : 1],
                                    first + corner[mirrored ? 1 : 2]});
    }
}

}  // namespace

TriangleMesh readWithAssimp(const CleanCopy& copy, const std::string& file)
{
    Assimp::Importer importer;
    importer.SetIOHandler(new CopyFiles(copy));  // owned by the importer
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(copy.fileName, 0);
    if (scene == nullptr || scene->mNumMeshes == 0) {
        refuseMesh(file, "assimp cannot read it ({}); convert it to binary PLY",
                   importer.GetErrorString());
    }
    if (!agrees(*scene, copy)) {
        refuseMesh(file, "assimp sees other faces in it than there are; convert it to binary PLY");
    }
    splitPolygons(importer, file);

    TriangleMesh result;
    visitMeshes(*importer.GetScene(), [&](const aiMesh& mesh, const Eigen::Affine3d& transform) {
        appendMesh(mesh, transform, result);
    });
    return result;
}

}  // namespace sandflow
