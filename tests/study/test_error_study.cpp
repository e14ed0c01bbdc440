#include "core/errors.h"
#include "io/temp_folder.h"
#include "scene/read_scene.h"
#include "solver/scenes.h"
#include "study/error_study.h"
#include "study/trial_csv.h"

#include <algorithm>

namespace sandflow {
namespace {

const SceneFloor kLevel = [](const Scene&, double) { return levelFloor(0.0); };
const ErrorTrialWatcher kNobody = [](const ErrorTrial&, std::size_t, std::size_t) {};

/// 40 grains that have hardly landed when it ends.
class ErrorStudyRun : public ::testing::Test {
protected:
    ErrorStudyRun()
    {
        spill(temp_.file("tiny.toml"),
              "[time]\n"
              "duration = 0.2\n"
              "[[solids]]\n"
              "shape = \"plane\"\n"
              "[[emitters]]\n"
              "kind = \"jet\"\n"
              "count = 40\n"
              "rate = 1000\n"
              "position = [0, 0, 0.05]\n"
              "radius = 0.03\n"
              "speed = 1.0\n");
        plan_.scenePath = temp_.file("tiny.toml");
        plan_.seeds = 1;
        plan_.quick = true;
        plan_.reference = {1.0, 0.8};
    }

    TempFolder temp_;
    ErrorStudyPlan plan_;
};

TEST_F(ErrorStudyRun, EveryTrialIsWrittenAndReadBack)
{
    std::vector<ErrorTrial> seen;
    plan_.seeds = 2;
    const std::string folder = temp_.file("study");
    runErrorStudy(plan_, folder, kLevel,
                  [&](const ErrorTrial& trial, std::size_t done, std::size_t planned) {
                      seen.push_back(trial);
                      EXPECT_EQ(done, seen.size());
                      EXPECT_LE(done, planned);
                      // The row is there before the next trial starts.
                      EXPECT_EQ(readErrorTrials(folder + "/trials.csv").size(), done);
                  });
    const ErrorStudyRecord record = readErrorStudies({folder}, kLevel);
    ASSERT_EQ(record.trials.size(), seen.size());
    EXPECT_EQ(record.referencePairs.size(), 1u);
    for (std::size_t k = 0; k < seen.size(); ++k) {
        EXPECT_EQ(errorTrialFields(record.trials[k]), errorTrialFields(seen[k]));
        EXPECT_EQ(record.trials[k].setting.overrides, seen[k].setting.overrides);
    }
    EXPECT_TRUE(seen.front().isReference());
    EXPECT_TRUE(seen[1].isDefault());
    EXPECT_EQ(seen.front().seed, 1u);
    EXPECT_EQ(seen.back().seed, 2u);
}

/// With a reference that is the same scene in mode dem, the setting "dem" has no error at all.
TEST_F(ErrorStudyRun, ErrorsAreAgainstTheReferenceOfTheSameSeed)
{
    plan_.overrides = {"contact.stiffness=5000"};  // the reference writes the number out: make it
    plan_.seeds = 2;                               // the same number
    std::size_t compared = 0;
    runErrorStudy(plan_, temp_.file("study"), kLevel,
                  [&](const ErrorTrial& trial, std::size_t, std::size_t) {
                      if (trial.setting.approximation == "method") {
                          EXPECT_EQ(trial.errors.radial, 0.0) << trial.seed;
                          EXPECT_EQ(trial.errors.cells, 0.0) << trial.seed;
                          ++compared;
                      }
                  });
    EXPECT_EQ(compared, 2u);
}

TEST_F(ErrorStudyRun, SeedsMayBeStudiedApartAndPutTogether)
{
    runErrorStudy(plan_, temp_.file("one"), kLevel, kNobody);
    plan_.overrides = {"seed=2"};
    runErrorStudy(plan_, temp_.file("two"), kLevel, kNobody);
    const auto both = readErrorStudies({temp_.file("one"), temp_.file("two")}, kLevel);
    EXPECT_EQ(both.referencePairs.size(), 1u);
    EXPECT_EQ(both.trials.front().seed, 1u);
    EXPECT_EQ(both.trials.back().seed, 2u);

    const std::string twice = messageOf<InputError>(
        [&] { readErrorStudies({temp_.file("one"), temp_.file("one")}, kLevel); });
    EXPECT_NE(twice.find("seed 1"), std::string::npos) << twice;

    plan_.overrides = {"seed=3", "contact.friction=0.4"};
    runErrorStudy(plan_, temp_.file("three"), kLevel, kNobody);
    const std::string mixed = messageOf<InputError>(
        [&] { readErrorStudies({temp_.file("one"), temp_.file("three")}, kLevel); });
    EXPECT_NE(mixed.find("different scenes"), std::string::npos) << mixed;
}

TEST_F(ErrorStudyRun, ARefusedSceneLeavesNoFolder)
{
    plan_.overrides = {"mode=dem"};
    EXPECT_THROW(runErrorStudy(plan_, temp_.file("study"), kLevel, kNobody), InputError);
    plan_.overrides = {"contact.max_overlap=0.001", "contact.stiffness=10"};
    EXPECT_THROW(runErrorStudy(plan_, temp_.file("study"), kLevel, kNobody), InputError);
    EXPECT_FALSE(std::filesystem::exists(temp_.file("study")));
}

/// How many grains fit through an opening is a matter of chance too: at some rate one seed can run
/// and the next cannot.
TEST_F(ErrorStudyRun, ASeedThatIsRefusedIsSaidBeforeAnythingRuns)
{
    const auto overridesFor = [](int rate, int seed) {
        return std::vector<std::string>{fmt::format("emitters[0].rate={}", rate),
                                        fmt::format("seed={}", seed)};
    };
    const auto largestRate = [&](int seed) {
        int fits = 1, doesNot = 1'000'000;
        while (doesNot - fits > 1) {
            const int rate = (fits + doesNot) / 2;
            try {
                planRun(readScene(plan_.scenePath, overridesFor(rate, seed)));
                fits = rate;
            } catch (const InputError&) {
                doesNot = rate;
            }
        }
        return fits;
    };
    int seed = 1;
    while (seed < 10 && largestRate(seed) <= largestRate(seed + 1)) {
        ++seed;
    }
    ASSERT_LT(seed, 10);
    plan_.overrides = overridesFor(largestRate(seed), seed);
    plan_.seeds = 2;
    const std::string message = messageOf<InputError>(
        [&] { runErrorStudy(plan_, temp_.file("study"), kLevel, kNobody); });
    EXPECT_NE(message.find(fmt::format("with seed {}: ", seed + 1)), std::string::npos) << message;
    EXPECT_FALSE(std::filesystem::exists(temp_.file("study")));
}

TEST(ErrorTrials, AnInterruptedRowIsLeftOut)
{
    const TempFolder temp;
    ErrorTrial trial;
    trial.setting = {"stiffness", "x 0.4", {"contact.stiffness=400", "contact.max_overlap=0.75"}};
    trial.end = TrialEnd::broke;
    trial.message = "grain 3, \"spout\": gone";
    const std::string line = formatCsvLine(errorTrialFields(trial));
    spill(temp.file("t.csv"), formatCsvLine(errorTrialColumns()) + line + line.substr(0, 20));
    const std::vector<ErrorTrial> trials = readErrorTrials(temp.file("t.csv"));
    ASSERT_EQ(trials.size(), 1u);
    EXPECT_EQ(trials[0].setting.overrides, trial.setting.overrides);
    EXPECT_EQ(trials[0].message, trial.message);
    EXPECT_FALSE(trials[0].errors.reposeDeg.has_value());
}

TEST(ErrorTrials, AForeignTableIsRefusedWithItsPlace)
{
    const TempFolder temp;
    spill(temp.file("other.csv"), "a,b\n1,2\n");
    EXPECT_THROW(readErrorTrials(temp.file("other.csv")), InputError);
    EXPECT_THROW(readErrorTrials(temp.file("missing.csv")), InputError);

    std::vector<std::string> fields = errorTrialFields(ErrorTrial{});
    fields[2] = "one";  // the seed
    spill(temp.file("t.csv"), formatCsvLine(errorTrialColumns()) + formatCsvLine(fields));
    const std::string message =
        messageOf<InputError>([&] { readErrorTrials(temp.file("t.csv")); });
    EXPECT_NE(message.find("t.csv:2: seed"), std::string::npos) << message;
}

}  // namespace
}  // namespace sandflow
