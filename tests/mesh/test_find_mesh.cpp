#include "io/temp_folder.h"
#include "mesh/find_mesh.h"

namespace sandflow {
namespace {

/// Sets the search path for the time of a test.
class SearchPath {
public:
    explicit SearchPath(const std::string& value)
    {
        ::setenv("SANDFLOW_MESH_PATH", value.c_str(), 1);
    }
    ~SearchPath() { ::unsetenv("SANDFLOW_MESH_PATH"); }
};

TEST(FindMesh, LooksInTheSceneFolderThenOnThePathThenInTheProject)
{
    const SearchPath path("/first:/second::");
    const std::vector<std::filesystem::path> expected = {
        "/scene/models/a.ply",  "/first/models/a.ply", "/first/a.ply",
        "/second/models/a.ply", "/second/a.ply",       SANDFLOW_SOURCE_DIR "/meshes/a.ply"};
    EXPECT_EQ(listMeshPlaces("models/a.ply", "/scene"), expected);
    const std::vector<std::filesystem::path> plain = {
        "/scene/a.ply", "/first/a.ply", "/second/a.ply", SANDFLOW_SOURCE_DIR "/meshes/a.ply"};
    EXPECT_EQ(listMeshPlaces("a.ply", "/scene"), plain);
    EXPECT_EQ(listMeshPlaces("/x/a.ply", "/scene"), std::vector<std::filesystem::path>{"/x/a.ply"});
}

TEST(FindMesh, TheFirstPlaceWithAFileWins)
{
    const TempFolder folder;
    std::filesystem::create_directories(folder.file("scene/a.ply"));  // a folder is no file
    std::filesystem::create_directories(folder.file("path/models"));
    const SearchPath path(folder.file("none") + ":" + folder.file("path"));
    EXPECT_EQ(findMesh("models/a.ply", folder.file("scene")), std::nullopt);
    EXPECT_EQ(findMesh("a.ply", folder.file("scene")), std::nullopt);
    spill(folder.file("path/a.ply"), "x");
    EXPECT_EQ(findMesh("a.ply", folder.file("scene")), folder.file("path/a.ply"));
    EXPECT_EQ(findMesh("models/a.ply", folder.file("scene")), folder.file("path/a.ply"));
    spill(folder.file("path/models/a.ply"), "x");
    EXPECT_EQ(findMesh("models/a.ply", folder.file("scene")), folder.file("path/models/a.ply"));
    std::filesystem::remove(folder.file("scene/a.ply"));
    spill(folder.file("scene/a.ply"), "x");
    EXPECT_EQ(findMesh("a.ply", folder.file("scene")), folder.file("scene/a.ply"));
    EXPECT_EQ(findMesh(folder.file("path/a.ply"), folder.file("scene")), folder.file("path/a.ply"));
    EXPECT_EQ(findMesh(folder.file("path/b.ply"), folder.file("scene")), std::nullopt);
}

TEST(FindMesh, WithoutAPathTheProjectsFolderIsLeft)
{
    ::unsetenv("SANDFLOW_MESH_PATH");
    EXPECT_EQ(findMesh("anything/README.md", "/none"),
              std::filesystem::path(SANDFLOW_SOURCE_DIR "/meshes/README.md"));
}

}  // namespace
}  // namespace sandflow
