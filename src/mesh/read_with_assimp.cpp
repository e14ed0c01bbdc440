#include "mesh/read_with_assimp.h"

#include "mesh/refuse_mesh.h"

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
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
        return name == copy_.fileName           ? &copy_.bytes
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
    visitMeshes(scene, [&](const aiMesh& mesh, const Eigen::Affine3d&) {
        for (unsigned f = 0; f < mesh.mNumFaces && valid; ++f) {
            const aiFace& face = mesh.mFaces[f];
            valid = face.mNumIndices == 3 &&
                    std::all_of(face.mIndices, face.mIndices + 3,
                                [&](unsigned index) { return index < mesh.mNumVertices; });
            if (valid) {
                std::array<Vec3f, 3> corners;
                for (std::size_t k = 0; k < 3; ++k) {
                    const aiVector3D& v = mesh.mVertices[face.mIndices[k]];
                    corners[k] = {v.x, v.y, v.z};
                }
                ++faces;
                faceSum += hashOfFace(corners);
            }
        }
    });
    return valid && faces == copy.faces && faceSum == copy.faceSum;
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
    const aiScene* scene = importer.ReadFile(copy.fileName, 0);
    if (scene == nullptr || scene->mNumMeshes == 0) {
        refuseMesh(file, "assimp cannot read it ({}); convert it to binary PLY",
                   importer.GetErrorString());
    }
    if (!agrees(*scene, copy)) {
        refuseMesh(file, "assimp sees other faces in it than there are; convert it to binary PLY");
    }
    // The copy holds nothing but triangles, so there is nothing to split or sort; the walk over the
    // nodes below does in double, and with mirrors, what PreTransformVertices would do.
    scene = importer.ApplyPostProcessing(aiProcess_ValidateDataStructure);
    if (scene == nullptr) {
        refuseMesh(file, "assimp finds it malformed ({}); convert it to binary PLY",
                   importer.GetErrorString());
    }
    TriangleMesh result;
    visitMeshes(*scene, [&](const aiMesh& mesh, const Eigen::Affine3d& transform) {
        appendMesh(mesh, transform, result);
    });
    return result;
}

}  // namespace sandflow
