#include "core/errors.h"
#include "io/frame_log.h"
#include "io/run_folder.h"
#include "io/state_file.h"
#include "sample_snapshot.h"
#include "temp_folder.h"

namespace sandflow {
namespace {

TEST(RunFolder, makesAFolderWithItsParents)
{
    TempFolder folder;
    const RunFolder run(folder.file("runs/floor"), FolderUse::fresh);
    EXPECT_EQ(slurp(run.frameLogPath()), frameLogHeader() + "\n");
    EXPECT_EQ(run.framePath(42), folder.file("runs/floor/frame_000042.inc"));
    EXPECT_EQ(run.statePath(42), folder.file("runs/floor/state_000042.bin"));
    EXPECT_EQ(run.framePath(1234567), folder.file("runs/floor/frame_1234567.inc"));
}

TEST(RunFolder, refusesAFolderThatHoldsARun)
{
    TempFolder folder;
    RunFolder(folder.path(), FolderUse::fresh);
    EXPECT_EQ(messageOf<InputError>([&] { RunFolder(folder.path(), FolderUse::fresh); }),
              folder.path() +
                  " already holds a run: choose another folder, or use --resume or --force");
}

TEST(RunFolder, acceptsAFolderWithOtherThings)
{
    TempFolder folder;
    spill(folder.file("notes.txt"), "mine");
    EXPECT_NO_THROW(RunFolder(folder.path(), FolderUse::fresh));
}

TEST(RunFolder, forceRemovesOnlyWhatARunWrote)
{
    TempFolder folder;
    RunFolder(folder.path(), FolderUse::fresh);
    const std::string ours[] = {"scene.toml", "summary.json", "checkpoint.bin", "state_last.bin",
                                "state_000007.bin", "frame_000007.inc", "frame_1000000.inc",
                                "frame_000008.inc.tmp", "scene.pov", "scene.ini",
                                "run_scene.inc", "solid_3.inc", "materials.inc", "lights.inc"};
    const std::string theirs[] = {"notes.txt", "scene.png", "scene007.png", "frame_7.inc",
                                  "frame_00000a.inc", "frame_000007.inc.bak", "state_0000007.bin",
                                  "my_scene.toml", "frame_-00007.inc"};
    for (const auto& name : ours) {
        spill(folder.file(name), "old");
    }
    for (const auto& name : theirs) {
        spill(folder.file(name), "keep");
    }
    std::filesystem::create_directory(folder.file("frame_000009.inc"));
    const RunFolder run(folder.path(), FolderUse::force);
    for (const auto& name : ours) {
        EXPECT_FALSE(std::filesystem::exists(folder.file(name))) << name;
    }
    for (const auto& name : theirs) {
        EXPECT_EQ(slurp(folder.file(name)), "keep") << name;
    }
    EXPECT_TRUE(std::filesystem::is_directory(folder.file("frame_000009.inc")));
    EXPECT_TRUE(std::filesystem::exists(run.frameLogPath()));
}

TEST(RunFolder, neverTouchesAUsersOwnScene)
{
    TempFolder folder;
    spill(folder.file("scene.toml"), "mine");
    for (FolderUse use : {FolderUse::fresh, FolderUse::force}) {
        EXPECT_EQ(messageOf<InputError>([&] { RunFolder(folder.path(), use); }),
                  folder.path() + " holds scene.toml but no run, and a run would overwrite it: "
                                  "choose another folder");
    }
    EXPECT_EQ(slurp(folder.file("scene.toml")), "mine");
    EXPECT_EQ(folder.countEntries(), 1u);
}

TEST(RunFolder, resumesAndReadsOnlyARun)
{
    TempFolder folder;
    for (FolderUse use : {FolderUse::resume, FolderUse::read}) {
        EXPECT_EQ(messageOf<InputError>([&] { RunFolder(folder.path(), use); }),
                  folder.path() + " holds no run: there is no frames.csv in it");
        EXPECT_THROW(RunFolder(folder.file("none"), use), InputError);
    }
    EXPECT_EQ(folder.countEntries(), 0u);
    const RunFolder run(folder.path(), FolderUse::fresh);
    spill(run.framePath(1), "grains");
    EXPECT_NO_THROW(RunFolder(folder.path(), FolderUse::resume));
    EXPECT_EQ(slurp(run.framePath(1)), "grains");
}

TEST(RunFolder, reportsWhatCannotBeAFolder)
{
    TempFolder folder;
    spill(folder.file("file"), "x");
    EXPECT_EQ(messageOf<InputError>([&] { RunFolder(folder.file("file"), FolderUse::fresh); }),
              folder.file("file") + " is not a folder");
    EXPECT_THROW(RunFolder(folder.file("file/below"), FolderUse::fresh), SystemError);
}

TEST(RunFolder, findsStates)
{
    TempFolder folder;
    const RunFolder run(folder.path(), FolderUse::fresh);
    EXPECT_EQ(messageOf<InputError>([&] { run.findState(std::nullopt); }),
              folder.path() + " holds no state yet: no frame was finished");
    Snapshot last = makeHeap(10);
    last.frame = 9;
    writeState(run.lastStatePath(), last);
    spill(run.statePath(4), "");
    EXPECT_EQ(run.findState(std::nullopt), run.lastStatePath());
    EXPECT_EQ(run.findState(9), run.lastStatePath());
    EXPECT_EQ(run.findState(4), run.statePath(4));
    EXPECT_EQ(messageOf<InputError>([&] { run.findState(5); }),
              folder.path() + " kept no state of frame 5; its last frame is 9 (a run with "
                              "--keep-states keeps all)");
}

TEST(RunFolder, dropsTheFramesThatAResumedRunWritesAgain)
{
    TempFolder folder;
    const RunFolder run(folder.path(), FolderUse::fresh);
    for (std::uint64_t frame : {1, 2, 3}) {
        spill(run.framePath(frame), "");
        spill(run.statePath(frame), "");
    }
    run.removeFramesAfter(2);
    EXPECT_TRUE(std::filesystem::exists(run.framePath(2)));
    EXPECT_TRUE(std::filesystem::exists(run.statePath(2)));
    EXPECT_FALSE(std::filesystem::exists(run.framePath(3)));
    EXPECT_FALSE(std::filesystem::exists(run.statePath(3)));
    EXPECT_TRUE(std::filesystem::exists(run.frameLogPath()));
}

TEST(RunFolder, writesTheSummary)
{
    TempFolder folder;
    const RunFolder run(folder.path(), FolderUse::fresh);
    JsonWriter json;
    json.beginObject().member("frames", 3).endObject();
    run.writeSummary(json);
    EXPECT_EQ(slurp(run.summaryPath()), "{\n  \"frames\": 3\n}\n");
}

}  // namespace
}  // namespace sandflow
