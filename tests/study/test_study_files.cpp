#include "core/errors.h"
#include "io/temp_folder.h"
#include "study/gnuplot.h"
#include "study/study_folder.h"
#include "study/text_table.h"
#include "study/trial_csv.h"

namespace sandflow {
namespace {

TEST(StudyFolder, IsMadeWithItsParents)
{
    const TempFolder temp;
    makeStudyFolder(temp.file("a/b"));
    EXPECT_TRUE(std::filesystem::is_directory(temp.file("a/b")));
}

TEST(StudyFolder, IsNeverWrittenOver)
{
    const TempFolder temp;
    spill(temp.file("taken"), "");
    for (const std::string& path : {temp.path(), temp.file("taken")}) {
        const std::string message = messageOf<InputError>([&] { makeStudyFolder(path); });
        EXPECT_NE(message.find(path), std::string::npos) << message;
    }
}

TEST(StudyFolder, BelowAFileItCannotBe)
{
    const TempFolder temp;
    spill(temp.file("file"), "");
    const std::string path = temp.file("file") + "/study";
    const std::string message = messageOf<SystemError>([&] { makeStudyFolder(path); });
    EXPECT_NE(message.find(path), std::string::npos) << message;
}

TEST(TrialCsv, QuotesWhatNeedsIt)
{
    EXPECT_EQ(formatCsvLine({"a", "b,c", "say \"no\"", ""}), "a,\"b,c\",\"say \"\"no\"\"\",\n");
}

TEST(TrialCsv, RowsAreThereAtOnce)
{
    const TempFolder temp;
    TrialCsv csv(temp.file("t.csv"), {"name", "value"});
    EXPECT_EQ(slurp(temp.file("t.csv")), "name,value\n");
    csv.append({"one", csvNumber(0.1)});
    EXPECT_EQ(slurp(temp.file("t.csv")), "name,value\none,0.1\n");
    csv.append({"two", csvNumber(1e-9)});
    EXPECT_EQ(slurp(temp.file("t.csv")), "name,value\none,0.1\ntwo,1e-09\n");
}

TEST(TrialCsv, ARowHasOneFieldPerColumn)
{
    const TempFolder temp;
    TrialCsv csv(temp.file("t.csv"), {"name", "value"});
    EXPECT_THROW(csv.append({"one"}), InternalError);
}

TEST(TrialCsv, ADiskThatRefusesIsNamed)
{
    const std::string path = "/dev/full";
    const std::string message =
        messageOf<SystemError>([&] { TrialCsv csv(path, {"name", "value"}); });
    EXPECT_NE(message.find(path), std::string::npos) << message;
}

TEST(TextTable, ColumnsAreAsWideAsTheirLongestEntry)
{
    EXPECT_EQ(formatTable({"name", "x"}, {{"a", "1.5"}, {"longer", "12"}, {"short"}}),
              "name      x\n"
              "a       1.5\n"
              "longer   12\n"
              "short\n");
}

TEST(Gnuplot, DrawsWhatTheScriptSays)
{
    const TempFolder temp;
    plotWithGnuplot(temp.file("p.gp"), "set terminal pngcairo size 80,60\nset output " +
                                           gnuplotQuoted(temp.file("p.png")) + "\nplot x\n");
    EXPECT_EQ(slurp(temp.file("p.png")).substr(1, 3), "PNG");
}

TEST(Gnuplot, AScriptItDoesNotLikeIsNamed)
{
    const TempFolder temp;
    const std::string message =
        messageOf<SystemError>([&] { plotWithGnuplot(temp.file("p.gp"), "plod x\n"); });
    EXPECT_NE(message.find(temp.file("p.gp")), std::string::npos) << message;
}

/// A folder of programs in which gnuplot is not.
class WithoutGnuplot : public ::testing::Test {
protected:
    WithoutGnuplot() : path_(std::getenv("PATH")) { ::setenv("PATH", temp_.path().c_str(), 1); }
    ~WithoutGnuplot() override { ::setenv("PATH", path_.c_str(), 1); }

    TempFolder temp_;

private:
    std::string path_;
};

TEST_F(WithoutGnuplot, SaysHowToGetIt)
{
    const std::string early = messageOf<SystemError>([] { requireGnuplot(); });
    EXPECT_NE(early.find("apt-get install gnuplot-nox"), std::string::npos) << early;
    const std::string late =
        messageOf<SystemError>([&] { plotWithGnuplot(temp_.file("p.gp"), "plot x\n"); });
    EXPECT_EQ(late, early);
}

}  // namespace
}  // namespace sandflow
