#include "core/errors.h"
#include "io/export.h"
#include "sample_snapshot.h"
#include "temp_folder.h"

#include <fcntl.h>

#include <charconv>
#include <cstring>
#include <sstream>

namespace sandflow {
namespace {

std::vector<std::string> splitLine(const std::string& line, char separator)
{
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, separator);) {
        fields.push_back(field);
    }
    return fields;
}

template <typename Number>
Number parse(const std::string& text)
{
    Number number{};
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    EXPECT_TRUE(result.ec == std::errc{} && result.ptr == text.data() + text.size()) << text;
    return number;
}

TEST(ExportCsv, readsBackAsTheSameGrains)
{
    TempFolder folder;
    const Snapshot heap = makeHeap(401);
    exportSnapshot(heap, ExportFormat::csv, folder.file("heap.csv"));
    std::istringstream in(slurp(folder.file("heap.csv")));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "id,x,y,z,radius,vx,vy,vz,state");
    const std::string names[] = {"mobile", "asleep", "interface", "buried"};
    std::size_t i = 0;
    for (; std::getline(in, line); ++i) {
        const auto field = splitLine(line, ',');
        ASSERT_EQ(field.size(), 9u) << line;
        ASSERT_LT(i, heap.size());
        EXPECT_EQ(parse<std::uint32_t>(field[0]), heap.id[i]);
        for (int axis = 0; axis < 3; ++axis) {
            const auto column = static_cast<std::size_t>(axis);
            EXPECT_EQ(parse<double>(field[1 + column]), heap.position[i][axis]);
            EXPECT_EQ(parse<float>(field[5 + column]), heap.velocity[i][axis]);
        }
        EXPECT_EQ(parse<float>(field[4]), heap.radius[i]);
        EXPECT_EQ(field[8], names[static_cast<std::size_t>(heap.state[i])]);
    }
    EXPECT_EQ(i, heap.size()) << "buried grains belong to an export";
}

TEST(ExportPly, holdsTheBytesItsHeaderAnnounces)
{
    const Snapshot heap = makeHeap(50);
    const std::string bytes = formatSnapshot(heap, ExportFormat::ply);
    EXPECT_EQ(bytes.substr(0, 4), "ply\n");
    EXPECT_NE(bytes.find("\nelement vertex 50\n"), std::string::npos);
    const std::string_view mark = "end_header\n";
    const std::size_t body = bytes.find(mark) + mark.size();
    // double x y z, float radius vx vy vz, uint id, uchar state
    constexpr std::size_t stride = 24 + 16 + 4 + 1;
    ASSERT_EQ(bytes.size() - body, 50 * stride);
    const char* const grain = bytes.data() + body + 8 * stride;
    double z = 0.0;
    float vy = 0.0F;
    std::uint32_t id = 0;
    std::memcpy(&z, grain + 16, sizeof z);
    std::memcpy(&vy, grain + 32, sizeof vy);
    std::memcpy(&id, grain + 40, sizeof id);
    EXPECT_EQ(z, heap.position[8].z());
    EXPECT_EQ(vy, heap.velocity[8].y());
    EXPECT_EQ(id, heap.id[8]);
    EXPECT_EQ(bytes[body + 3 * stride + 44], 3) << "state of the fourth grain: buried";
}

TEST(ExportVtp, opensAndClosesItsElementsAndListsEveryGrain)
{
    const Snapshot heap = makeHeap(20);
    std::istringstream in(formatSnapshot(heap, ExportFormat::vtp));
    std::vector<std::string> open;
    std::vector<std::string> arrays;
    std::size_t lines = 0;
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "<?xml version=\"1.0\"?>");
    while (std::getline(in, line)) {
        if (line.starts_with("</")) {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(line, "</" + open.back() + ">");
            if (open.back() == "DataArray") {
                EXPECT_EQ(lines, 20u) << arrays.back();
            }
            open.pop_back();
        } else if (line.starts_with('<')) {
            open.push_back(line.substr(1, line.find_first_of(" >") - 1));
            if (open.back() == "DataArray") {
                arrays.push_back(line);
                lines = 0;
            }
            if (open.back() == "Piece") {
                EXPECT_NE(line.find("NumberOfPoints=\"20\" NumberOfVerts=\"20\""),
                          std::string::npos);
            }
        } else {
            ++lines;
        }
    }
    EXPECT_TRUE(open.empty());
    EXPECT_EQ(arrays.size(), 7u);
}

TEST(Export, goesToTheStandardOutput)
{
    testing::internal::CaptureStdout();
    Snapshot one;
    one.meanRadius = 0.5;
    addGrain(one, 7, Vec3(0.25, -0.5, 1.0), GrainState::asleep);
    exportSnapshot(one, ExportFormat::csv, "-");
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "id,x,y,z,radius,vx,vy,vz,state\n7,0.25,-0.5,1,0.5,0,0,0,asleep\n");
}

TEST(Export, reportsAFullStandardOutput)
{
    const int kept = ::dup(STDOUT_FILENO);
    const int full = ::open("/dev/full", O_WRONLY);
    ASSERT_GE(full, 0);
    std::fflush(stdout);
    ::dup2(full, STDOUT_FILENO);
    const std::string message = messageOf<SystemError>(
        [] { exportSnapshot(makeHeap(3), ExportFormat::csv, "-"); });
    ::dup2(kept, STDOUT_FILENO);
    ::close(full);
    ::close(kept);
    EXPECT_EQ(message, "cannot write to the standard output: No space left on device");
}

TEST(Export, knowsThreeFormats)
{
    EXPECT_EQ(parseExportFormat("csv"), ExportFormat::csv);
    EXPECT_EQ(parseExportFormat("ply"), ExportFormat::ply);
    EXPECT_EQ(parseExportFormat("vtp"), ExportFormat::vtp);
    EXPECT_EQ(messageOf<InputError>([] { parseExportFormat("CSV"); }),
              "unknown export format \"CSV\": use csv, ply or vtp");
}

}  // namespace
}  // namespace sandflow
