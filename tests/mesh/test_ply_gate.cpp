#include "mesh_files.h"

namespace sandflow {
namespace {

/// What replacing `from` by `to` in the text PLY of the box leads to.
std::string refusalWith(const std::string& from, const std::string& to)
{
    return refusalOf(replaced(writePly(makeTestBox()), from, to), ".ply");
}

TEST(PlyGate, HeadersThatAreNoneAreRefused)
{
    EXPECT_EQ(refusalWith("ply\n", "plx\n"),
              "the file does not begin with a line \"ply\"; it is no PLY file");
    EXPECT_EQ(refusalWith("ascii 1.0", "ascii 2.0"),
              "the PLY header's second entry is not \"format ascii 1.0\" or one of the binary "
              "formats 1.0; export the file again");
    EXPECT_EQ(
        refusalWith("property float y", "property quad y"),
        "line 6 of the PLY header names the unknown type \"quad\"; export the file again with "
        "float coordinates and int indices");
    EXPECT_EQ(refusalWith("property float y", "property float"),
              "line 6 of the PLY header is no property with a type and a name");
    EXPECT_EQ(refusalWith("element face 12", "element face twelve"),
              "line 8 of the PLY header is no element with a name and a count");
    EXPECT_EQ(refusalWith("element face 12", "element face -1"),
              "line 8 of the PLY header is no element with a name and a count");
    EXPECT_EQ(refusalWith("comment made", "remark made"),
              "line 3 of the PLY header, \"remark\", has no meaning; export the file again");
    const std::string cut =
        "the PLY header does not end in a line \"end_header\"; the file is cut short";
    EXPECT_EQ(refusalWith("end_header\n", "end_header"),
              "line 10 of the PLY header, \"end_header-1\", has no meaning; export the file again");
    const std::string whole = writePly(makeTestBox());
    for (std::size_t size = 4; size < whole.find("end_header\n") + 11; ++size) {
        EXPECT_EQ(refusalOf(whole.substr(0, size), ".ply"), cut) << size;
    }
}

TEST(PlyGate, ElementsThatAreNoMeshAreRefused)
{
    EXPECT_EQ(refusalWith("element vertex", "element point"),
              "the PLY header does not declare vertices and then faces before all else; export the "
              "file again as a mesh");
    EXPECT_EQ(refusalWith("element face", "element tristrips"),
              "the PLY file holds triangle strips; export it again with faces");
    EXPECT_EQ(refusalWith("end_header", "element face 1\nproperty int a\nend_header"),
              "the PLY header declares two face elements; export the file again");
    EXPECT_EQ(refusalWith("element vertex 8", "element vertex 0"), "the PLY file has no vertices");
    EXPECT_EQ(refusalWith("element face 12", "element face 0"),
              "the PLY file has points but no faces; export a surface, not a cloud");
    EXPECT_EQ(refusalWith("property float z", "property float w"),
              "the PLY vertices have 0 properties z, where one is needed");
    EXPECT_EQ(refusalWith("property float z", "property float x\nproperty float z"),
              "the PLY vertices have 2 properties x, where one is needed");
    EXPECT_EQ(refusalWith("property float z", "property float z\nproperty list int int k"),
              "the PLY vertices have a list, \"k\"; export the file again without it");
    EXPECT_EQ(refusalWith("list uchar int vertex_indices", "list uchar float vertex_indices"),
              "the PLY faces have 0 lists vertex_indices, where one of integers is needed; export "
              "the file again");
}

TEST(PlyGate, BadNumbersAreRefusedWithTheirPlace)
{
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\nnan 2 0.5\n"),
              "vertex 1 has the coordinates (nan, 2, 0.5), which are not finite in single "
              "precision; repair the file");
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 -inf 0.5\n"),
              "vertex 1 has the coordinates (1, -inf, 0.5), which are not finite in single "
              "precision; repair the file");
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 2 1e39\n"),
              "vertex 1 has the coordinates (1, 2, 1e+39), which are not finite in single "
              "precision; repair the file");
    const std::string incomplete =
        " is incomplete or no number; the file is damaged or cut short, copy or export it again";
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 2\n"), "vertex 1 of 8" + incomplete);
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 2 0x5\n"), "vertex 1 of 8" + incomplete);
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 2 0,5\n"), "vertex 1 of 8" + incomplete);
    EXPECT_EQ(refusalWith("\n1 2 0.5\n", "\n1 2 0.5 7\n"),
              "vertex 1 has more numbers than the header declares");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n3 0 3.0 1\n"), "face 1 of 12" + incomplete);
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n3 0 3 8\n"),
              "face 1 names vertex 8, but there are only 0 to 7; repair the file");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n3 0 3 -1\n"),
              "face 1 names vertex -1, but there are only 0 to 7; repair the file");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n3 0 3 4294967296\n"),
              "face 1 names vertex 4294967296, but there are only 0 to 7; repair the file");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n0\n"),
              "face 1 has 0 corners, allowed are 3 to 256; repair or split it");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n2 0 3\n"),
              "face 1 has 2 corners, allowed are 3 to 256; repair or split it");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n4000000000 0 3 1\n"),
              "face 1 has 4000000000 corners, allowed are 3 to 256; repair or split it");
    EXPECT_EQ(refusalWith("\n3 0 3 1\n", "\n4 0 3 1 2\n"),
              "face 1 with 4 corners crosses itself; split it into triangles in a modelling "
              "program");
}

TEST(PlyGate, CutAndOverlongFilesAreRefused)
{
    const std::string text = writePly(makeTestBox());
    const std::size_t body = text.find("end_header\n") + 11;
    for (std::size_t size = body; size + 2 < text.size(); ++size) {
        EXPECT_NE(refusalOf(text.substr(0, size), ".ply").find("cut short"), std::string::npos)
            << size;
    }
    // All that a cut there can hide is more digits of the last number.
    EXPECT_EQ(loadBytes(text.substr(0, text.size() - 1), ".ply").report.repairs,
              std::vector<std::string>(
                  {"its last line has no line break: the file may have been cut short"}));
    EXPECT_EQ(refusalWith("element face 12", "element face 11"),
              "more data follows the 11 faces that the header declares; export the file again");
    const std::string plain = writePlainPly(makeTestBox());
    for (std::size_t size = plain.find("end_header\n") + 11; size < plain.size(); ++size) {
        EXPECT_NE(refusalOf(plain.substr(0, size), ".ply").find("cut short"), std::string::npos)
            << size;
    }
    EXPECT_EQ(refusalOf(plain + "x", ".ply"),
              "more data follows the 12 faces that the header declares; export the file again");
    expectBox(loadBytes(plain + "\n", ".ply"), "a line feed at the end");
}

/// Neither memory nor time for what is only declared.
TEST(PlyGate, HugeDeclaredCountsCostNothing)
{
    EXPECT_EQ(refusalWith("element vertex 8", "element vertex 4000000000000"),
              "vertex 8 has more numbers than the header declares");
    EXPECT_EQ(refusalWith("element face 12", "element face 9000000000000000000"),
              "face 12 of 9000000000000000000 is incomplete or no number; the file is damaged or "
              "cut short, copy or export it again");
    EXPECT_EQ(refusalWith("element face 12", "element face 99999999999999999999"),
              "line 8 of the PLY header is no element with a name and a count");
    std::string plain = writePlainPly(makeTestBox());
    plain = replaced(plain, "element vertex 8", "element vertex 2000000000");
    EXPECT_EQ(refusalOf(plain, ".ply"),
              "vertex 21 of 2000000000 is incomplete or no number; the file is damaged or cut "
              "short, copy or export it again");
}

}  // namespace
}  // namespace sandflow
