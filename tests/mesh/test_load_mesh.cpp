#include "io/temp_folder.h"
#include "mesh_files.h"

#include <sys/stat.h>

#include <ctime>

namespace sandflow {
namespace {

/// Of processor time: other tests may run beside this one.
double secondsSince(std::clock_t start)
{
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(LoadMesh, EveryFormatGivesTheSameBoxWithoutAWarning)
{
    for (const MeshFile& file : writeAllFormats(makeTestBox())) {
        const LoadedMesh loaded = loadBytes(file.bytes, file.extension);
        expectBox(loaded, file.name);
        EXPECT_TRUE(loaded.report.repairs.empty())
            << file.name << ": " << loaded.report.repairs.front();
        EXPECT_EQ(contentHashOf(loaded.mesh),
                  contentHashOf(loadBytes(file.bytes, file.extension).mesh))
            << file.name;
    }
}

TEST(LoadMesh, LineEndsBlanksAndEndingsMayVary)
{
    for (const MeshFile& file : writeAllFormats(makeTestBox())) {
        if (file.bytes.find('\0') != file.bytes.npos || file.extension == ".gltf") {
            continue;
        }
        expectBox(loadBytes(replacedAll(file.bytes, "\n", "\r\n"), file.extension), "CR LF");
        expectBox(loadBytes(replacedAll(file.bytes, "\n", "\r"), file.extension), "CR");
        expectBox(loadBytes(replacedAll(file.bytes, "\n", "\n\n"), file.extension), "blank lines");
        expectBox(loadBytes(replacedAll(file.bytes, " ", " \t "), file.extension), "blanks");
    }
    // A binary body may begin with the byte of a line feed.
    const std::string plain = writePlainPly(makeTestBox());
    const std::size_t body = plain.find("end_header\n") + 11;
    expectBox(
        loadBytes(replacedAll(plain.substr(0, body), "\n", "\r\n") + plain.substr(body), ".ply"),
        "CR LF before binary");
    expectBox(loadBytes(writePly(makeTestBox()), ".PLY"), "upper case");
    expectBox(loadBytes(writeGlb(makeTestBox()), ".Glb"), "mixed case");
}

TEST(LoadMesh, PathsMayHaveBlanksAndAnyLetters)
{
    const TempFolder folder;
    std::filesystem::create_directory(folder.file("Sand förm 砂"));
    for (const MeshFile& file : writeAllFormats(makeTestBox())) {
        const std::string path = folder.file("Sand förm 砂/große Kiste" + file.extension);
        spill(path, file.bytes);
        expectBox(loadMesh(path), file.name);
    }
}

/// 2 x 3 x 4 box out of six quads.
TEST(LoadMesh, QuadsAreSplit)
{
    std::string obj;
    for (const Vec3& p : makeTestBox().points) {
        obj += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    }
    obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf -6 -2 -1 -5\nf 1 5 7 3\nf 2 4 8 6\n";
    expectBox(loadBytes(obj, ".obj"), "quads");
}

/// A prism over an L of area 3 and height 1, its two L's as one polygon each.
TEST(LoadMesh, ConcavePolygonsAreSplit)
{
    std::string off = "OFF 12 8 0\n";
    for (const int z : {0, 1}) {
        for (const char* corner : {"0 0", "2 0", "2 1", "1 1", "1 2", "0 2"}) {
            off += fmt::format("{} {}\n", corner, z);
        }
    }
    off += "6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n";
    for (int k = 0; k < 6; ++k) {
        const int next = (k + 1) % 6;
        off += fmt::format("4 {} {} {} {}\n", k, next, 6 + next, 6 + k);
    }
    const LoadedMesh loaded = loadBytes(off, ".off");
    EXPECT_NEAR(loaded.report.signedVolume, 3.0, 1e-6);
    EXPECT_EQ(loaded.report.triangles, 20u);
    EXPECT_EQ(loaded.report.unbalancedEdges, 0u);
    // The L and its sides, not the convex hull: 2 * 3 + 8.
    EXPECT_NEAR(areaOf(loaded.mesh), 14.0, 1e-6);
}

/// More corners than assimp's OFF reader takes, and as many as are allowed.
TEST(LoadMesh, PolygonsWithManyCornersAreSplit)
{
    for (const int corners : {10, 256}) {
        std::string off = fmt::format("OFF\n{} 1 0\n", corners);
        std::string face = fmt::format("{}", corners);
        for (int k = 0; k < corners; ++k) {
            const double angle = 2.0 * kPi * k / corners;
            off += fmt::format("{} {} 0\n", std::cos(angle), std::sin(angle));
            face += fmt::format(" {}", k);
        }
        const LoadedMesh loaded = loadBytes(off + face + "\n", ".off");
        EXPECT_EQ(loaded.report.triangles, static_cast<std::size_t>(corners - 2));
        EXPECT_NEAR(areaOf(loaded.mesh), 0.5 * corners * std::sin(2.0 * kPi / corners), 1e-5);
        EXPECT_EQ(loaded.report.boundaryEdges, static_cast<std::size_t>(corners));
        EXPECT_NEAR(loaded.report.largestHole, std::sqrt(8.0), corners == 10 ? 0.3 : 1e-3);
    }
}

TEST(LoadMesh, TheFileMustBeARegularFileOfAKnownKind)
{
    const TempFolder folder;
    const auto refusal = [&](const std::string& name) {
        return messageOf<InputError>([&] { loadMesh(folder.file(name)); });
    };
    EXPECT_EQ(refusal("none.ply"), folder.file("none.ply") + ": there is no such file");
    spill(folder.file("empty.ply"), "");
    EXPECT_EQ(refusal("empty.ply"), folder.file("empty.ply") +
                                        ": it has 0 bytes, allowed are 1 to 250000000; export the "
                                        "mesh again");
    spill(folder.file("box.3ds"), "x");
    EXPECT_EQ(refusal("box.3ds"), folder.file("box.3ds") +
                                      ": its ending is none of .ply, .obj, .stl, .off, .gltf and "
                                      ".glb; convert it to one of these");
    std::filesystem::create_directory(folder.file("folder.ply"));
    EXPECT_EQ(refusal("folder.ply"), folder.file("folder.ply") +
                                         ": it is not a regular file but a folder, a pipe or a "
                                         "device");
    ASSERT_EQ(::mkfifo(folder.file("pipe.ply").c_str(), 0600), 0);
    EXPECT_EQ(refusal("pipe.ply"), folder.file("pipe.ply") +
                                       ": it is not a regular file but a folder, a pipe or a "
                                       "device");
    std::filesystem::create_symlink(folder.file("loop.ply"), folder.file("loop.ply"));
    EXPECT_EQ(refusal("loop.ply"), folder.file("loop.ply") + ": there is no such file");
    {
        std::ofstream huge(folder.file("huge.ply"), std::ios::binary);
        huge.seekp(250'000'000);
        huge.put('x');  // a sparse file: nothing much is written
    }
    EXPECT_EQ(refusal("huge.ply"), folder.file("huge.ply") +
                                       ": it has 250000001 bytes, allowed are 1 to 250000000; "
                                       "reduce the mesh");
    // The superuser may read any file.
    if (::geteuid() != 0) {
        spill(folder.file("secret.ply"), writePly(makeTestBox()));
        ::chmod(folder.file("secret.ply").c_str(), 0);
        EXPECT_EQ(refusal("secret.ply"), folder.file("secret.ply") +
                                             ": it cannot be read (Permission denied); check its "
                                             "permissions");
    }
}

/// Polygons of 256 corners on a double spiral, the worst for cutting off ears.
std::string writeSpirals(int faces)
{
    std::string off = fmt::format("OFF\n256 {} 0\n", faces);
    std::string face = "256";
    for (int k = 0; k < 256; ++k) {
        const int along = k < 128 ? k : 255 - k;
        const double angle = 0.3 * along;
        const double radius = 1.0 + 0.05 * along + (k < 128 ? 0.0 : 0.2);
        off += fmt::format("{} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
        face += fmt::format(" {}", k);
    }
    for (int f = 0; f < faces; ++f) {
        off += face + "\n";
    }
    return off;
}

TEST(LoadMesh, SpiralPolygonsTakeNoLongerThanOthersOrAreRefused)
{
    const std::string some = writeSpirals(300), many = writeSpirals(9000);
    std::clock_t start = std::clock();
    EXPECT_EQ(refusalOf(some, ".off"), "");
    EXPECT_LT(secondsSince(start), kLongestLoad);
    start = std::clock();
    EXPECT_NE(refusalOf(many, ".off").find("too many corners"), std::string::npos);
    EXPECT_LT(secondsSince(start), kLongestLoad);
}

}  // namespace
}  // namespace sandflow
