#include "core/errors.h"
#include "io/frame_log.h"
#include "temp_folder.h"

namespace sandflow {
namespace {

/// Every member another value, so that a swapped column shows.
FrameRow makeRow(std::uint64_t frame)
{
    FrameRow row;
    row.frame = frame;
    row.time = 0.1;
    row.wall = 0.25;
    row.steps = 167;
    row.dtMin = 1e-4;
    row.dtMean = 2.5e-4;
    row.emitted = 100;
    row.mobile = 40;
    row.asleep = 10;
    row.interface = 30;
    row.buried = 28;
    row.exited = 2;
    row.exported = 70;
    row.maxOverlap = 0.125;
    row.kineticEnergy = 3.5;
    row.surfaceFlowTime = 1.5;
    row.transferTime = 2.5;
    row.rebuildTime = 4.5;
    row.forcesTime = 5.5;
    row.emitTime = 6.5;
    row.outputTime = 7.5;
    return row;
}

const std::string kHeader =
    "frame,time_s,wall_s,steps,dt_min_s,dt_mean_s,emitted,mobile,asleep,interface,buried,exited,"
    "exported,max_overlap_r,kinetic_energy_j,t_surface_flow_s,t_transfer_s,t_rebuild_s,t_forces_s,"
    "t_emit_s,t_output_s\n";

std::string rowText(int frame)
{
    return std::to_string(frame) +
           ",0.1,0.25,167,1e-04,0.00025,100,40,10,30,28,2,70,0.125,3.5,1.5,2.5,4.5,5.5,6.5,7.5\n";
}

TEST(FrameLog, hasEveryRowInTheFileAtOnce)
{
    TempFolder folder;
    const std::string path = folder.file("frames.csv");
    FrameLog log(path);
    EXPECT_EQ(slurp(path), kHeader);
    log.append(makeRow(1));
    EXPECT_EQ(slurp(path), kHeader + rowText(1));
    log.append(makeRow(2));
    EXPECT_EQ(slurp(path), kHeader + rowText(1) + rowText(2));
}

TEST(FrameLog, readsItsRowsBack)
{
    TempFolder folder;
    const std::string path = folder.file("frames.csv");
    FrameLog log(path);
    FrameRow row = makeRow(12345);
    row.time = 1.0 / 3.0;
    log.append(row);
    const auto rows = readFrameLog(path);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].frame, 12345u);
    EXPECT_EQ(rows[0].time, 1.0 / 3.0);
    EXPECT_EQ(rows[0].exported, 70u);
    EXPECT_EQ(rows[0].outputTime, 7.5);
}

TEST(FrameLog, dropsTheRowsThatAResumedRunWritesAgain)
{
    TempFolder folder;
    const std::string path = folder.file("frames.csv");
    // Frame 3 came after the checkpoint; frame 4 was being written when the program was killed.
    spill(path, kHeader + rowText(1) + rowText(2) + rowText(3) + "4,0.1,0.2");
    FrameLog log(path, 2);
    EXPECT_EQ(slurp(path), kHeader + rowText(1) + rowText(2));
    log.append(makeRow(3));
    EXPECT_EQ(slurp(path), kHeader + rowText(1) + rowText(2) + rowText(3));
}

TEST(FrameLog, refusesOtherFiles)
{
    TempFolder folder;
    const std::string path = folder.file("frames.csv");
    const auto read = [&] { readFrameLog(path); };
    spill(path, "");
    EXPECT_EQ(messageOf<InputError>(read), path + " is not a frame log: it has no header");
    spill(path, "frame,time\n1,2\n");
    EXPECT_EQ(messageOf<InputError>(read),
              path + " is not a frame log of this version: its columns differ");
    spill(path, kHeader + rowText(1) + "2,3\n");
    EXPECT_EQ(messageOf<InputError>(read), path + ":3: not a row of 21 numbers");
    std::string longer = rowText(1);
    longer.insert(longer.size() - 1, ",8");
    spill(path, kHeader + longer);
    EXPECT_EQ(messageOf<InputError>(read), path + ":2: not a row of 21 numbers");
}

TEST(FrameLog, reportsAMissingFolder)
{
    TempFolder folder;
    EXPECT_THROW(FrameLog(folder.file("none/frames.csv")), SystemError);
}

}  // namespace
}  // namespace sandflow
