#include "io/temp_folder.h"
#include "mesh_files.h"

namespace sandflow {
namespace {

std::string gltfRefusal(const std::string& from, const std::string& to)
{
    return refusalOf(replaced(writeGltf(makeTestBox()), from, to), ".gltf");
}

LoadedMesh loadNodes(const std::string& nodes)
{
    return loadBytes(writeGltf(makeTestBox(), nodes), ".gltf");
}

TEST(GltfGate, NodesMoveTurnAndScale)
{
    const LoadedMesh moved =
        loadNodes(R"({"translation":[10,0,0],"children":[1]},{"scale":[2,2,2],"mesh":0})");
    EXPECT_EQ(boundsOf(moved.mesh).min(), Vec3(8.0, 4.0, 1.0));
    EXPECT_EQ(boundsOf(moved.mesh).max(), Vec3(12.0, 10.0, 9.0));
    EXPECT_NEAR(moved.report.signedVolume, 8.0 * kBoxVolume, 1e-4);
    // A quarter turn about z: (x, y, z) -> (-y, x, z).
    const LoadedMesh turned =
        loadNodes(R"({"rotation":[0,0,0.70710678118,0.70710678118],"mesh":0})");
    EXPECT_NEAR((boundsOf(turned.mesh).min() - Vec3(-5.0, -1.0, 0.5)).norm(), 0.0, 1e-5);
    const LoadedMesh sheared =
        loadNodes(R"({"matrix":[1,0,0,0, 1,1,0,0, 0,0,1,0, 7,0,0,1],"mesh":0})");
    EXPECT_NEAR(sheared.report.signedVolume, kBoxVolume, 1e-5);
    EXPECT_EQ(boundsOf(sheared.mesh).max(), Vec3(7.0 + 1.0 + 5.0, 5.0, 4.5));
}

TEST(GltfGate, MirroredNodesStillFaceOutwards)
{
    for (const char* node : {R"({"scale":[-1,1,1],"mesh":0})", R"({"scale":[1,1,-1],"mesh":0})",
                             R"({"matrix":[0,1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1],"mesh":0})"}) {
        const LoadedMesh mirrored = loadNodes(node);
        EXPECT_NEAR(mirrored.report.signedVolume, kBoxVolume, 1e-5) << node;
        EXPECT_TRUE(mirrored.report.repairs.empty()) << node;
        EXPECT_EQ(mirrored.report.unbalancedEdges, 0u) << node;
    }
    const LoadedMesh twice =
        loadNodes(R"({"scale":[-1,1,1],"children":[1]},{"scale":[1,-1,1],"mesh":0})");
    EXPECT_NEAR(twice.report.signedVolume, kBoxVolume, 1e-5);
}

TEST(GltfGate, InstancesAreAllThere)
{
    const LoadedMesh pair =
        loadNodes(R"({"mesh":0,"children":[1]},{"translation":[9,0,0],"scale":[1,-1,1],"mesh":0})");
    EXPECT_EQ(pair.report.components, 2u);
    EXPECT_EQ(pair.report.triangles, 24u);
    EXPECT_NEAR(pair.report.signedVolume, 2.0 * kBoxVolume, 1e-5);
}

TEST(GltfGate, StripsAndFansAreTakenApart)
{
    // A strip of quads round a square tube, and a fan over a square.
    const std::string box = writeGltf(makeTestBox());
    const std::string asStrip = replaced(box, R"("indices":1)", R"("indices":1,"mode":5)");
    EXPECT_FALSE(loadBytes(asStrip, ".gltf").mesh.triangles.empty());

    TriangleMesh square;
    square.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)};
    square.triangles = {{0, 1, 2}};
    std::string strip = replaced(writeGltf(square), R"(,"indices":1)", R"(,"mode":5)");
    const LoadedMesh loaded = loadBytes(strip, ".gltf");
    EXPECT_EQ(loaded.report.triangles, 2u);
    EXPECT_EQ(loaded.report.boundaryEdges, 4u);
    EXPECT_EQ(loaded.report.unbalancedEdges, 4u);  // the diagonal is not
    std::swap(square.points[2], square.points[3]);
    const std::string fan = replaced(writeGltf(square), R"(,"indices":1)", R"(,"mode":6)");
    EXPECT_EQ(loadBytes(fan, ".gltf").report.boundaryEdges, 4u);
    EXPECT_NEAR(areaOf(loadBytes(fan, ".gltf").mesh), 1.0, 1e-9);
}

TEST(GltfGate, PointsAndLinesAreLeftOutWithASentence)
{
    const std::string bytes = replaced(writeGltf(makeTestBox()), R"({"attributes")",
                                       R"({"attributes":{"POSITION":0},"mode":1},{"attributes")");
    const LoadedMesh loaded = loadBytes(bytes, ".gltf");
    expectBox(loaded, "with lines");
    EXPECT_EQ(loaded.report.repairs,
              std::vector<std::string>({"left out 1 sets of points or lines"}));
}

TEST(GltfGate, BuffersOfItsOwnFolderAreRead)
{
    const TempFolder folder;
    std::filesystem::create_directory(folder.file("in"));
    const TriangleMesh box = makeTestBox();
    const auto save = [&](const std::string& uri) {
        spill(folder.file("in/box.gltf"),
              gltfJson(box, R"({"mesh":0})", ",\"uri\":\"" + uri + "\""));
        return folder.file("in/box.gltf");
    };
    spill(folder.file("in/my box.bin"), gltfBuffer(box));
    spill(folder.file("outside.bin"), gltfBuffer(box));
    std::filesystem::create_symlink(folder.file("outside.bin"), folder.file("in/link.bin"));
    expectBox(loadMesh(save("my%20box.bin")), "percent");
    expectBox(loadMesh(save("./my box.bin")), "blank");
    for (const std::string uri :
         {"../outside.bin", "link.bin", "none.bin", ".", "%2e%2e/outside.bin", "file:outside.bin",
          "http://localhost/x.bin"}) {
        const std::string message = messageOf<InputError>([&] { loadMesh(save(uri)); });
        EXPECT_NE(message.find("which cannot be read as a file of the same folder"), message.npos)
            << message;
    }
    const std::string absolute =
        messageOf<InputError>([&] { loadMesh(save(folder.file("in/my box.bin"))); });
    EXPECT_NE(absolute.find("same folder"), absolute.npos);
}

TEST(GltfGate, DefectsAreRefused)
{
    EXPECT_EQ(gltfRefusal(R"("version":"2.0")", R"("version":"1.0")"),
              "the file does not name itself glTF 2; export it as glTF 2.0");
    EXPECT_EQ(gltfRefusal(R"({"asset")", R"({"extensionsRequired":["KHR_draco_mesh_compression"],)"
                                         R"("asset")"),
              "the glTF file needs the extension \"KHR_draco_mesh_compression\"; export it without "
              "compression or other extensions");
    EXPECT_EQ(gltfRefusal(R"("count":36)", R"("count":37)"),
              "accessor 1 of the glTF file does not fit into its buffer; the file is damaged, copy "
              "or export it again");
    EXPECT_EQ(gltfRefusal(R"("count":36)", R"("count":9007199254740992)"),
              "accessor 1 of the glTF file does not fit into its buffer; the file is damaged, copy "
              "or export it again");
    EXPECT_EQ(gltfRefusal(R"("count":36)", R"("count":35)"),
              "mesh 0 of the glTF file has 35 corners, which are no triangles; repair the file");
    EXPECT_EQ(gltfRefusal(R"("count":36)", R"("count":-3)"),
              "\"count\" in the glTF file is no whole number from 0; repair the file");
    EXPECT_EQ(
        gltfRefusal(R"("count":8)", R"("count":7)"),
        "index 8 of mesh 0 in the glTF file names vertex 7, but there are only 0 to 6; repair "
        "the file");
    EXPECT_EQ(gltfRefusal(R"("mesh":0)", R"("mesh":1)"),
              "meshes 1 is asked for, but the glTF file has no such object among its 1");
    EXPECT_EQ(gltfRefusal(R"("mesh":0)", R"("camera":0)"),
              "the scene of the glTF file has no triangles; export a surface");
    EXPECT_EQ(gltfRefusal(R"("mesh":0)", R"("mesh":0,"children":[0])"),
              "node 0 of the glTF file has two parents or is its own; repair the file");
    EXPECT_EQ(gltfRefusal(R"("mesh":0)", R"("mesh":0,"rotation":[0,0,0,2])"),
              "\"rotation\" of node 0 in the glTF file has the length 2, not 1; repair the file");
    EXPECT_EQ(gltfRefusal(R"("mesh":0)", R"("mesh":0,"scale":[1,1])"),
              "\"scale\" of node 0 in the glTF file is not made of 3 numbers below 1e9; repair the "
              "file");
    EXPECT_EQ(gltfRefusal(R"("componentType":5126)", R"("componentType":5122)"),
              "accessor 0 of the glTF file has the component type 5122; export the file with float "
              "positions and unsigned indices");
    EXPECT_EQ(gltfRefusal(R"("buffers":[)", R"("buffers":[,)"),
              "the file is not the JSON of glTF: no JSON value at byte 395; export it again");
    EXPECT_EQ(gltfRefusal(R"("scene":0)", R"("scene":0,"scene":0)").substr(0, 68),
              "the file is not the JSON of glTF: an object with a key twice, ending");
    EXPECT_EQ(refusalOf(std::string(100000, '['), ".gltf"),
              "the file is not the JSON of glTF: too many levels at byte 65; export it again");
    const std::string glb = writeGlb(makeTestBox());
    EXPECT_EQ(
        refusalOf(glb.substr(0, glb.size() - 4), ".glb"),
        fmt::format("the GLB file declares {} bytes and has {}, or its first chunk is no JSON; "
                    "it is damaged or cut short, copy or export it again",
                    glb.size(), glb.size() - 4));
}

/// Small files that unfold into huge meshes.
TEST(GltfGate, InstancesOfInstancesAreRefusedQuickly)
{
    std::string nodes = R"({"children":[1)";
    constexpr int kCount = 15000;
    for (int i = 2; i <= kCount; ++i) {
        nodes += fmt::format(",{}", i);
    }
    nodes += "]}";
    for (int i = 0; i < kCount; ++i) {
        nodes += R"(,{"mesh":0})";
    }
    // As many nodes as are allowed: each is a copy of the box.
    EXPECT_EQ(loadNodes(nodes).report.triangles, 12u);
    TriangleMesh large;
    for (int i = 0; i < 600; ++i) {
        large.points.push_back(Vec3(i, i * i % 7, 0.0));
        large.triangles.push_back({0, 1, static_cast<std::uint32_t>(i)});
    }
    EXPECT_EQ(
        refusalOf(writeGltf(large, nodes), ".gltf"),
        "the nodes of the glTF file show its meshes so often that there are more than 6000000 "
        "corners and points; reduce it");
}

}  // namespace
}  // namespace sandflow
