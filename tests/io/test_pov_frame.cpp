#include "core/errors.h"
#include "io/pov_frame.h"
#include "sample_snapshot.h"
#include "temp_folder.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <locale>

namespace sandflow {
namespace {

Snapshot makeUnitScene()
{
    Snapshot snapshot;
    snapshot.frame = 42;
    snapshot.meanRadius = 1.0;
    return snapshot;
}

/// The one sphere of a frame with one grain at (x, 0, 0) of radius 1.
std::string drawAt(double x)
{
    Snapshot snapshot = makeUnitScene();
    addGrain(snapshot, 1, Vec3(x, 0.0, 0.0));
    const std::string text = formatPovFrame(snapshot, {});
    const std::size_t begin = text.find("sphere");
    return text.substr(begin, text.find('\n', begin) - begin);
}

std::size_t countOf(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

TEST(PovFrame, writesTheAxesOfPovRayInMeanRadii)
{
    Snapshot snapshot;
    snapshot.frame = 42;
    snapshot.meanRadius = 0.005;
    addGrain(snapshot, 7, Vec3(0.0615505, -0.0425, 0.02035));
    snapshot.radius[0] = 0.00515F;
    EXPECT_EQ(formatPovFrame(snapshot, {}),
              "// frame 42, 1 grains, lengths in mean grain radii\nobject{\n"
              "sphere{<12.31,4.07,-8.5>,1.03}\nGrainTexture(" +
                  std::to_string(chooseColourFamily(7)) + ")}\n");
}

TEST(PovFrame, trimsZerosAndNeverWritesMinusZero)
{
    EXPECT_EQ(drawAt(0.0), "sphere{<0,0,0>,1}");
    EXPECT_EQ(drawAt(-0.0), "sphere{<0,0,0>,1}");
    EXPECT_EQ(drawAt(-0.0004), "sphere{<0,0,0>,1}");
    EXPECT_EQ(drawAt(0.0005), "sphere{<.001,0,0>,1}");
    EXPECT_EQ(drawAt(-0.0006), "sphere{<-.001,0,0>,1}");
    EXPECT_EQ(drawAt(0.5), "sphere{<.5,0,0>,1}");
    EXPECT_EQ(drawAt(-3.25), "sphere{<-3.25,0,0>,1}");
    EXPECT_EQ(drawAt(10.07), "sphere{<10.07,0,0>,1}");
    EXPECT_EQ(drawAt(100.0), "sphere{<100,0,0>,1}");
    EXPECT_EQ(drawAt(0.9996), "sphere{<1,0,0>,1}");
    EXPECT_EQ(drawAt(-999999999999.0), "sphere{<-999999999999,0,0>,1}");
}

TEST(PovFrame, roundsEveryCoordinateToTheNearestThousandth)
{
    Snapshot heap = makeHeap(5000);
    PovFrameOptions options;
    options.allGrains = true;
    const std::string text = formatPovFrame(heap, options);
    // Grains appear by colour family and, within it, by id.
    std::vector<std::vector<std::size_t>> order(kColourFamilies);
    for (std::size_t i = 0; i < heap.size(); ++i) {
        order[static_cast<std::size_t>(chooseColourFamily(heap.id[i]))].push_back(i);
    }
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (const auto& family : order) {
        for (std::size_t i : family) {
            at = text.data() + text.find('<', static_cast<std::size_t>(at - text.data()));
            const Vec3& p = heap.position[i];
            for (double expected : {p.x(), p.z(), p.y(), static_cast<double>(heap.radius[i])}) {
                while (at < end && *at != '-' && *at != '.' && (*at < '0' || *at > '9')) {
                    ++at;
                }
                double value = 0.0;
                at = std::from_chars(at, end, value).ptr;
                ASSERT_NEAR(value, expected / heap.meanRadius, 0.000501) << "grain " << i;
            }
        }
    }
    EXPECT_EQ(countOf(text, "sphere{"), 5000u);
}

TEST(PovFrame, leavesBuriedGrainsOutUnlessAsked)
{
    TempFolder folder;
    const Snapshot heap = makeHeap(400);
    EXPECT_EQ(writePovFrame(folder.file("a.inc"), heap, {}), 300u);
    EXPECT_EQ(countOf(slurp(folder.file("a.inc")), "sphere{"), 300u);
    PovFrameOptions all;
    all.allGrains = true;
    EXPECT_EQ(writePovFrame(folder.file("b.inc"), heap, all), 400u);
    EXPECT_EQ(countOf(slurp(folder.file("b.inc")), "sphere{"), 400u);
    EXPECT_EQ(folder.countEntries(), 2u);
    // Those behind glass are seen: half of the buried ones.
    std::vector<double> x;
    for (std::size_t i = 0; i < heap.position.size(); ++i) {
        if (heap.state[i] == GrainState::buried) {
            x.push_back(heap.position[i].x());
        }
    }
    std::sort(x.begin(), x.end());
    PovFrameOptions pane;
    pane.isSeen = [&](const Vec3& p) { return p.x() < x[50]; };
    EXPECT_EQ(writePovFrame(folder.file("c.inc"), heap, pane),
              300u + static_cast<std::size_t>(
                         std::lower_bound(x.begin(), x.end(), x[50]) - x.begin()));
}

TEST(PovFrame, coloursByState)
{
    PovFrameOptions options;
    options.allGrains = true;
    options.colourBy = GrainColour::state;
    const std::string text = formatPovFrame(makeHeap(40), options);
    for (int state = 0; state < 4; ++state) {
        EXPECT_EQ(countOf(text, "StateTexture(" + std::to_string(state) + ")}"), 1u);
    }
    EXPECT_EQ(countOf(text, "union{"), 4u);
}

TEST(PovFrame, writesAFrameWithoutGrains)
{
    EXPECT_EQ(formatPovFrame(makeUnitScene(), {}),
              "// frame 42, 0 grains, lengths in mean grain radii\n");
}

TEST(PovFrame, refusesWhatCannotBeDrawn)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (double bad : {nan, infinity, -infinity, 1e12, -1e300}) {
        EXPECT_THROW(drawAt(bad), InternalError) << bad;
    }
    Snapshot snapshot = makeUnitScene();
    addGrain(snapshot, 1, Vec3::Zero());
    snapshot.radius[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(formatPovFrame(snapshot, {}), InternalError);
    for (double bad : {0.0, -1.0, nan, infinity}) {
        Snapshot scaleless;
        scaleless.meanRadius = bad;
        EXPECT_THROW(formatPovFrame(scaleless, {}), InternalError) << bad;
    }
}

TEST(PovFrame, keepsTheOldFrameWhenTheNewOneIsBroken)
{
    TempFolder folder;
    spill(folder.file("a.inc"), "old");
    Snapshot snapshot = makeUnitScene();
    addGrain(snapshot, 1, Vec3(std::nan(""), 0.0, 0.0));
    EXPECT_THROW(writePovFrame(folder.file("a.inc"), snapshot, {}), InternalError);
    EXPECT_EQ(slurp(folder.file("a.inc")), "old");
}

TEST(PovFrame, spreadsNeighbouringIdsOverAllFamilies)
{
    std::array<int, kColourFamilies> count{};
    int sameAsNext = 0;
    constexpr int n = 24'000;
    for (std::uint32_t id = 0; id < n; ++id) {
        const int family = chooseColourFamily(id);
        ASSERT_GE(family, 0);
        ASSERT_LT(family, kColourFamilies);
        ++count[static_cast<std::size_t>(family)];
        sameAsNext += family == chooseColourFamily(id + 1) ? 1 : 0;
    }
    // 1000 expected, standard deviation 31.
    for (int c : count) {
        EXPECT_NEAR(c, 1000, 160);
    }
    EXPECT_NEAR(sameAsNext, 1000, 160);
}

/// A locale as in Germany, whether or not the machine has one installed.
class DecimalComma : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(PovFrame, isTheSameWhereTheDecimalSignIsAComma)
{
    const Snapshot heap = makeHeap(2000);
    const std::string expected = formatPovFrame(heap, {});
    const std::locale old = std::locale::global(std::locale(std::locale(), new DecimalComma));
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    const std::string text = formatPovFrame(heap, {});
    std::locale::global(old);
    EXPECT_EQ(text, expected);
    EXPECT_EQ(text.substr(0, 21), "// frame 2, 1500 grai");
}

}  // namespace
}  // namespace sandflow
