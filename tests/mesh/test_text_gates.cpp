#include "mesh_files.h"

namespace sandflow {
namespace {

std::string objRefusal(const std::string& from, const std::string& to)
{
    return refusalOf(replaced(writeObj(makeTestBox()), from, to), ".obj");
}

std::string offRefusal(const std::string& from, const std::string& to)
{
    return refusalOf(replaced(writeOff(makeTestBox()), from, to), ".off");
}

std::string stlRefusal(const std::string& from, const std::string& to)
{
    return refusalOf(replaced(writeStl(makeTestBox()), from, to), ".stl");
}

TEST(ObjGate, ReadsWhatOthersWrite)
{
    const std::string obj = writeObj(makeTestBox());
    expectBox(
        loadBytes("\xef\xbb\xbf" + replaced(obj, "# a box\nmtllib box.mtl\no box\n", ""), ".obj"),
        "mark before the first vertex");
    expectBox(loadBytes(replaced(obj, "v 1 2 0.5\n", "v 1 2 0.5 1\n"), ".obj"), "weight 1");
    expectBox(loadBytes(replaced(obj, "v 1 2 0.5\n", "v 1 2 0.5 0.1 0.2 0.3\n"), ".obj"), "colour");
    expectBox(loadBytes(replaced(obj, "v 1 2 0.5\n", "  v +1 \\\n2. .5 # corner\n"), ".obj"),
              "continued line, comment, signs");
    const LoadedMesh loaded = loadBytes(obj + "p 1\nl 1 2\n", ".obj");
    expectBox(loaded, "points and lines");
    EXPECT_EQ(loaded.report.repairs, std::vector<std::string>({"left out 2 points and lines"}));
}

TEST(ObjGate, DefectsAreRefusedWithTheirLine)
{
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1/1/1 9//1 2\n"),
              "line 17: face 2 names vertex 9, but there are only 8; the file is damaged or cut "
              "short, copy or export it again");
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1/1/1 0//1 2\n"),
              "line 17: face 2 names vertex 0, which does not exist; repair the file");
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1/1/1 -9//1 2\n"),
              "line 17: face 2 names vertex -9, which does not exist; repair the file");
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1/1/1 2\n"),
              "line 17: face 2 has 2 corners, allowed are 3 to 256; repair or split it");
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1/1/1 4.5 2\n"),
              "line 17: \"4.5\" is no corner of a face; repair the file");
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1 2 4 3\n"),
              "");  // a fine quad, though it now overlaps
    EXPECT_EQ(objRefusal("f 1/1/1 4//1 2\n", "f 1 4 2 3\n"),
              "line 17: face 2 with 4 corners crosses itself; split it into triangles in a "
              "modelling program");
    EXPECT_EQ(objRefusal("v 1 2 0.5\n", "v 1 2\n"),
              "line 5: vertex 2 is not x y z; repair the file");
    EXPECT_EQ(objRefusal("v 1 2 0.5\n", "v 1 2 0.5.5\n"),
              "line 5: vertex 2 is not x y z; repair the file");
    EXPECT_EQ(objRefusal("v 1 2 0.5\n", "v 1 2 0.5 2\n"),
              "line 5: vertex 2 has the weight 2; export the file without weights");
    EXPECT_EQ(objRefusal("v 1 2 0.5\n", "v nan 2 0.5\n"),
              "line 5: vertex 2 has the coordinates (nan, 2, 0.5), which are not finite in single "
              "precision; repair the file");
    EXPECT_EQ(objRefusal("s off\n", "cstype bezier\n"),
              "line 15 begins with \"cstype\", which is no OBJ statement for polygons; export the "
              "file again as polygons");
    EXPECT_EQ(refusalOf("v 0 0 0\n", ".obj"), "the OBJ file has no faces; export a surface");
    EXPECT_EQ(refusalOf("# nothing\n", ".obj"), "the OBJ file has no vertices");
}

/// assimp takes any cut file for a whole one.
TEST(ObjGate, CutFilesAreRefusedOrReported)
{
    const std::string obj = writeObj(makeTestBox());
    for (std::size_t size = 1; size < obj.size(); ++size) {
        std::vector<std::string> told;
        std::size_t rim = 0;
        try {
            const LoadedMesh loaded = loadBytes(obj.substr(0, size), ".obj");
            told = loaded.report.repairs;
            rim = loaded.report.boundaryEdges;
        } catch (const InputError&) {
            continue;
        }
        EXPECT_TRUE(rim > 0 || !told.empty()) << size;
    }
}

TEST(OffGate, ReadsWhatOthersWrite)
{
    const std::string off = writeOff(makeTestBox());
    expectBox(loadBytes(replaced(off, "OFF # a box\n8 12 0", "OFF 8 12 18"), ".off"), "one line");
    std::string coloured = replaced(off, "OFF", "COFF");
    expectBox(loadBytes(replaced(coloured, "\n1 2 0.5\n", "\n1 2 0.5 255 0 0 255\n"), ".off"),
              "COFF");
    expectBox(loadBytes(replaced(off, "OFF", "STCNOFF"), ".off"), "STCNOFF");
}

TEST(OffGate, DefectsAreRefusedWithTheirPlace)
{
    EXPECT_EQ(offRefusal("OFF", "4OFF"),
              "the file begins with \"4OFF\", not with OFF in one of its forms for three "
              "dimensions; export it again");
    EXPECT_EQ(offRefusal("8 12 0", "8"),
              "line 2 does not give the numbers of vertices, faces and edges of an OFF file in "
              "text; export it again");
    EXPECT_EQ(offRefusal("8 12 0", "8 0 0"),
              "the OFF file has 8 vertices and 0 faces; export a surface");
    EXPECT_EQ(offRefusal("3 0 3 1 ", "3 0 8 1 "),
              "face 1 (line 13) names vertex 8, but there are only 0 to 7; repair the file");
    EXPECT_EQ(
        offRefusal("3 0 3 1 0.5 0.5 0.5\n", "3 0 3\n"),
        "face 1 of 12 (line 13) is incomplete or no number; the file is damaged or cut short, "
        "copy or export it again");
    EXPECT_EQ(offRefusal("3 0 3 1 ", "2 0 3 1 "),
              "face 1 (line 13) has 2 corners, allowed are 3 to 256; repair or split it");
    EXPECT_EQ(offRefusal("\n1 2 0.5\n", "\n1 2\n"),
              "vertex 1 of 8 (line 5) is not x y z; the file is damaged or cut short, copy or "
              "export it again");
    EXPECT_EQ(offRefusal("\n1 2 0.5\n", "\n1 inf 0.5\n"),
              "vertex 1 (line 5) has the coordinates (1, inf, 0.5), which are not finite in single "
              "precision; repair the file");
    EXPECT_EQ(offRefusal("8 12 0", "8 11 0"),
              "line 23 follows the 11 faces that the header declares; export the file again");
    EXPECT_EQ(offRefusal("8 12 0", "8 2000000000 0"),
              "face 12 of 2000000000 (line 23) is incomplete or no number; the file is damaged or "
              "cut short, copy or export it again");
}

TEST(StlGate, ReadsWhatOthersWrite)
{
    const std::string stl = writeStl(makeTestBox());
    expectBox(loadBytes(replacedAll(stl, "vertex", "VERTEX"), ".stl"), "upper case");
    const std::size_t half = stl.find("endfacet\n", stl.size() / 2) + 9;
    expectBox(
        loadBytes(stl.substr(0, half) + "endsolid\nsolid second\n" + stl.substr(half), ".stl"),
        "two solids");
    std::string binary = writeBinaryStl(makeTestBox());
    binary.replace(0, 10, "COLOR=abcd");
    expectBox(loadBytes(binary, ".stl"), "with a colour");
}

TEST(StlGate, DefectsAreRefusedWithTheirPlace)
{
    const std::string binary = writeBinaryStl(makeTestBox());
    EXPECT_EQ(refusalOf(replaced(binary, "solid, though", "a box, though"), ".stl"), "");
    EXPECT_EQ(refusalOf(binary.substr(0, 500), ".stl"),
              "the binary STL file declares 12 triangles, which need 684 bytes, but has 500; it is "
              "damaged or cut short, copy or export it again");
    EXPECT_EQ(refusalOf(binary + "x", ".stl"),
              "the binary STL file declares 12 triangles, which need 684 bytes, but has 685; it is "
              "damaged or cut short, copy or export it again");
    std::string huge = binary;
    huge.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_EQ(refusalOf(huge, ".stl"),
              "the binary STL file declares 4294967295 triangles, which need 214748364834 bytes, "
              "but has 684; it is damaged or cut short, copy or export it again");
    std::string spoilt = binary;
    spoilt.replace(84 + 50 + 12, 4, std::string("\0\0\xc0\x7f", 4));
    EXPECT_EQ(refusalOf(spoilt, ".stl"),
              "triangle 2 of 12 has a coordinate that is not finite; repair the file");
    EXPECT_EQ(refusalOf("nonsense", ".stl"),
              "the file has 8 bytes and does not begin with \"solid\"; it is no STL file");
    EXPECT_EQ(stlRefusal("endsolid a box\n", ""),
              "the STL file ends after 12 triangles without \"endsolid\"; it is cut short, copy or "
              "export it again");
    EXPECT_EQ(stlRefusal("endloop\n", "vertex 0 0 0\nendloop\n"),
              "line 7 begins with \"vertex\" and has 4 words, where STL needs \"endloop\" and 1 "
              "words in all; repair or export the file again");
    EXPECT_EQ(stlRefusal("outer loop\nvertex -1.000000e+00", "outer loop\nvertex one"),
              "line 4: \"one\" is no coordinate; repair the file");
    EXPECT_EQ(stlRefusal("outer loop\nvertex -1.000000e+00", "outer loop\nvertex -1e40"),
              "triangle 1 (before line 8) has a coordinate that is not finite in single precision; "
              "repair the file");
    EXPECT_EQ(refusalOf("solid empty\nendsolid\n", ".stl"), "the STL file has no triangles");
}

}  // namespace
}  // namespace sandflow
