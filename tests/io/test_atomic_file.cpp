#include "core/errors.h"
#include "io/atomic_file.h"
#include "temp_folder.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

namespace sandflow {
namespace {

/// Makes every file of the process end at `bytes`, as a full disk would, while it is in scope.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : oldHandler_(std::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, oldHandler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_{};
    void (*oldHandler_)(int);
};

TEST(AtomicFile, replacesAFileOnlyWhenItIsWhole)
{
    TempFolder folder;
    const std::string path = folder.file("a.inc");
    writeFileAtomically(path, "old");
    {
        AtomicFile file(path);
        file.write("new and ");
        file.write("longer");
        EXPECT_EQ(slurp(path), "old");
        file.commit(Durability::synced);
        EXPECT_EQ(slurp(path), "new and longer");
    }
    EXPECT_EQ(slurp(path), "new and longer");
    EXPECT_EQ(folder.countEntries(), 1u);
}

TEST(AtomicFile, leavesNothingBehindWithoutCommit)
{
    TempFolder folder;
    {
        AtomicFile file(folder.file("a.inc"));
        file.write("half");
        EXPECT_EQ(folder.countEntries(), 1u);
    }
    EXPECT_EQ(folder.countEntries(), 0u);
}

TEST(AtomicFile, writesOverWhatAKilledProgramLeft)
{
    TempFolder folder;
    spill(folder.file("a.inc.tmp"), std::string(1000, 'x'));
    writeFileAtomically(folder.file("a.inc"), "short");
    EXPECT_EQ(slurp(folder.file("a.inc")), "short");
    EXPECT_EQ(folder.countEntries(), 1u);
}

TEST(AtomicFile, keepsTheOldFileWhenTheDiskFillsUp)
{
    TempFolder folder;
    const std::string path = folder.file("a.inc");
    writeFileAtomically(path, "old");
    const std::string message = [&] {
        FileSizeLimit limit(4096);
        return messageOf<SystemError>(
            [&] { writeFileAtomically(path, std::string(100'000, 'x')); });
    }();
    EXPECT_EQ(message, "cannot write " + path + ": File too large");
    EXPECT_EQ(slurp(path), "old");
    EXPECT_EQ(folder.countEntries(), 1u);
}

TEST(AtomicFile, reportsAFullDevice)
{
    const std::string message =
        messageOf<SystemError>([] { writeFileAtomically("/dev/full", "x"); });
    EXPECT_EQ(message, "cannot write /dev/full: No space left on device");
    struct stat status {};
    ASSERT_EQ(::stat("/dev/full", &status), 0);
    EXPECT_TRUE(S_ISCHR(status.st_mode)) << "the device was replaced by a file";
}

TEST(AtomicFile, reportsAMissingFolder)
{
    TempFolder folder;
    const std::string path = folder.file("none/a.inc");
    EXPECT_EQ(messageOf<SystemError>([&] { writeFileAtomically(path, "x"); }),
              "cannot open " + path + ": No such file or directory");
}

TEST(AtomicFile, removesTheTemporaryWhenTheNameIsTaken)
{
    TempFolder folder;
    const std::string path = folder.file("a");
    std::filesystem::create_directory(path);
    EXPECT_EQ(messageOf<SystemError>([&] { writeFileAtomically(path, "x"); }),
              "cannot name " + path + ": Is a directory");
    EXPECT_EQ(folder.countEntries(), 1u);
}

TEST(AtomicFile, reportsAFolderItMayNotWriteTo)
{
    TempFolder folder;
    ::chmod(folder.path().c_str(), 0500);
    const std::string path = folder.file("a");
    // Root may write everywhere, so the attempt is made as nobody.
    const bool isRoot = ::geteuid() == 0;
    constexpr uid_t kNobody = 65534;
    if (isRoot) {
        ASSERT_EQ(::seteuid(kNobody), 0);
    }
    const std::string message = messageOf<SystemError>([&] { writeFileAtomically(path, "x"); });
    if (isRoot) {
        ASSERT_EQ(::seteuid(0), 0);
    }
    EXPECT_EQ(message, "cannot open " + path + ": Permission denied");
}

TEST(AtomicFile, refusesToBeUsedAfterCommit)
{
    TempFolder folder;
    AtomicFile file(folder.file("a"));
    file.commit();
    EXPECT_THROW(file.write("x"), InternalError);
    EXPECT_THROW(file.commit(), InternalError);
}

TEST(ReadWholeFile, returnsEveryByte)
{
    TempFolder folder;
    const std::string content("a\0b\nc\r\n", 7);
    spill(folder.file("a"), content);
    EXPECT_EQ(readWholeFile(folder.file("a")), content);
}

TEST(ReadWholeFile, refusesWhatIsNoFile)
{
    TempFolder folder;
    const std::string pipe = folder.file("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(messageOf<InputError>([&] { readWholeFile(pipe); }),
              pipe + " is not a regular file");
    EXPECT_EQ(messageOf<InputError>([&] { readWholeFile(folder.path()); }),
              folder.path() + " is not a regular file");
    EXPECT_EQ(messageOf<InputError>([&] { readWholeFile(folder.file("none")); }),
              "cannot open " + folder.file("none") + ": No such file or directory");
}

}  // namespace
}  // namespace sandflow
