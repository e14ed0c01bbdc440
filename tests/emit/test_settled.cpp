#include <Eigen/LU>
#include <algorithm>

#include "emit_support.h"

namespace sandflow {
namespace {

using testing::contains;
using testing::emitAll;
using testing::forEachPair;
using testing::makeScene;
using testing::refusalOf;
using testing::smallestGap;

constexpr double kTouch = 1e-9;  // m

EmitterSpec makeFill(const Vec3& size, std::int64_t count)
{
    EmitterSpec fill;
    fill.kind = EmitterKind::fill;
    fill.name = "bed";
    fill.count = count;
    fill.min = Vec3(1.0, -2.0, 0.1);
    fill.max = fill.min + size;
    return fill;
}

EmitterSpec makePile(double slope, std::int64_t count)
{
    EmitterSpec pile;
    pile.kind = EmitterKind::pile;
    pile.count = count;
    pile.position = Vec3(0.3, 0.4, -0.2);
    pile.slopeAngle = slope;
    return pile;
}

/// True when pushes >= 0 along some three of the normals (from support to grain) carry a weight.
bool carriesWeight(const std::vector<Vec3>& normals)
{
    for (std::size_t a = 0; a < normals.size(); ++a) {
        if (normals[a].z() > 1.0 - 1e-12) {
            return true;
        }
        for (std::size_t b = a + 1; b < normals.size(); ++b) {
            for (std::size_t c = b + 1; c < normals.size(); ++c) {
                Eigen::Matrix3d m;
                m << normals[a], normals[b], normals[c];
                if (std::abs(m.determinant()) > 1e-10 &&
                    (m.inverse() * Vec3::UnitZ()).minCoeff() > -1e-6) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// Grains that would move without friction, given the floor and, when walled, the box's walls.
int countUnsupported(const std::vector<NewGrain>& grains, double floor, const EmitterSpec* box)
{
    std::vector<std::vector<Vec3>> normals(grains.size());
    forEachPair(grains, kTouch, [&](std::size_t a, std::size_t b, double) {
        const Vec3 normal = (grains[b].position - grains[a].position).normalized();
        normals[b].push_back(normal);
        normals[a].push_back(-normal);
    });
    int unsupported = 0;
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Vec3& p = grains[k].position;
        const double touch = grains[k].radius + kTouch;
        if (p.z() - floor < touch) {
            normals[k].push_back(Vec3::UnitZ());
        }
        for (int axis = 0; box != nullptr && axis < 2; ++axis) {
            if (p[axis] - box->min[axis] < touch) {
                normals[k].push_back(Vec3::Unit(axis));
            }
            if (box->max[axis] - p[axis] < touch) {
                normals[k].push_back(-Vec3::Unit(axis));
            }
        }
        unsupported += carriesWeight(normals[k]) ? 0 : 1;
    }
    return unsupported;
}

void expectInsideBox(const std::vector<NewGrain>& grains, const EmitterSpec& box, double floor)
{
    for (const NewGrain& grain : grains) {
        Vec3 low = grain.position - box.min;
        low.z() = grain.position.z() - floor;
        ASSERT_GE(low.minCoeff(), grain.radius - kTouch);
        ASSERT_GE((box.max - grain.position).minCoeff(), grain.radius - kTouch);
        ASSERT_TRUE(grain.settled);
        ASSERT_EQ(grain.velocity, Vec3::Zero());
    }
}

/// Share of the volume taken inside the box shrunk by `margin` on all sides, by grain centres.
double solidFraction(const std::vector<NewGrain>& grains, const Vec3& min, const Vec3& max)
{
    double volume = 0.0;
    for (const NewGrain& grain : grains) {
        if ((grain.position - min).minCoeff() >= 0.0 && (max - grain.position).minCoeff() > 0.0) {
            volume += 4.0 / 3.0 * kPi * std::pow(grain.radius, 3);
        }
    }
    return volume / (max - min).prod();
}

TEST(Fill, FullBoxIsASupportedPackingWithoutOverlap)
{
    const EmitterSpec spec = makeFill(Vec3(0.3, 0.25, 0.2), 0);
    const auto fill = makeEmitter(makeScene(spec), 0);
    const std::int64_t planned = fill->planned();
    const std::vector<NewGrain> grains = emitAll(*fill);
    EXPECT_EQ(static_cast<std::int64_t>(grains.size()), planned);
    expectInsideBox(grains, spec, spec.min.z());
    EXPECT_GE(smallestGap(grains, 0.0), -1e-9);
    EXPECT_EQ(countUnsupported(grains, spec.min.z(), &spec), 0);

    // Dropped and rolled spheres fill 0.58 to 0.60 away from walls (Visscher & Bolsterli 1972).
    const Vec3 margin = Vec3::Constant(0.03);
    const double inside = solidFraction(grains, spec.min + margin, spec.max - margin);
    EXPECT_GT(inside, 0.56);
    EXPECT_LT(inside, 0.61);
    // Full up to the top: the last layer too.
    const double whole = solidFraction(grains, spec.min, spec.max);
    EXPECT_GT(whole, 0.51);
}

TEST(Fill, RadiiKeepTheirDistribution)
{
    // A filler that replaced what does not fit by smaller grains would shift the mean.
    const std::vector<NewGrain> grains =
        emitAll(*makeEmitter(makeScene(makeFill(Vec3(0.2, 0.2, 0.1), 0)), 0));
    double sum = 0.0;
    for (const NewGrain& grain : grains) {
        sum += grain.radius;
    }
    const auto n = static_cast<double>(grains.size());
    EXPECT_NEAR(sum / n, 0.005, 4.0 * 0.005 * 0.08 / std::sqrt(3.0 * n));
}

TEST(Fill, PartialFillLiesLevel)
{
    const EmitterSpec spec = makeFill(Vec3(0.2, 0.2, 1.0), 4000);
    const std::vector<NewGrain> grains = emitAll(*makeEmitter(makeScene(spec), 0));
    ASSERT_EQ(grains.size(), 4000U);
    EXPECT_EQ(countUnsupported(grains, spec.min.z(), &spec), 0);
    // Highest grain of each 5 x 5 patch.
    std::vector<double> top(25, 0.0);
    for (const NewGrain& grain : grains) {
        const Vec3 p = (grain.position - spec.min) / 0.04;
        double& height =
            top.at(static_cast<std::size_t>(static_cast<int>(p.x()) + 5 * static_cast<int>(p.y())));
        height = std::max(height, grain.position.z() - spec.min.z());
    }
    const auto [low, high] = std::minmax_element(top.begin(), top.end());
    EXPECT_LT(*high - *low, 0.015);  // one and a half diameters
}

TEST(Fill, OtherSizesAndNarrowBoxesHoldTogetherToo)
{
    for (const double spread : {0.0, 0.3, 0.6}) {
        for (const Vec3& size :
             {Vec3(0.1, 0.1, 0.1), Vec3(0.017, 0.1, 0.1), Vec3(0.017, 0.018, 0.2)}) {
            const EmitterSpec spec = makeFill(size, 0);
            Scene scene = makeScene(spec);
            scene.grains.sizeSpread = spread;
            const std::vector<NewGrain> grains = emitAll(*makeEmitter(scene, 0));
            EXPECT_GT(solidFraction(grains, spec.min, spec.max), 0.3)
                << "spread " << spread << ", " << size.transpose();
            expectInsideBox(grains, spec, spec.min.z());
            EXPECT_GE(smallestGap(grains, 0.0), -1e-9);
            EXPECT_EQ(countUnsupported(grains, spec.min.z(), &spec), 0);
        }
    }
}

TEST(Fill, StandsOnTheBumpsOfARoughFloor)
{
    const EmitterSpec spec = makeFill(Vec3(0.1, 0.1, 0.1), 0);
    Scene scene = makeScene(spec);
    SolidSpec plane;
    plane.point = Vec3(0.0, 0.0, 0.1);
    plane.rough = true;
    scene.solids.push_back(plane);
    const std::vector<NewGrain> grains = emitAll(*makeEmitter(scene, 0));
    // Bumps are spheres of the mean radius centred 0.6 of it below the plane.
    expectInsideBox(grains, spec, 0.1 + 0.002);
    EXPECT_EQ(countUnsupported(grains, 0.1 + 0.002, &spec), 0);
}

TEST(Fill, CountThatDoesNotFitNamesTheMostThatDo)
{
    const auto full = makeEmitter(makeScene(makeFill(Vec3(0.1, 0.1, 0.1), 0)), 0);
    const std::int64_t most = full->planned();
    EXPECT_EQ(refusalOf(makeScene(makeFill(Vec3(0.1, 0.1, 0.1), most))), "");
    const std::string refusal = refusalOf(makeScene(makeFill(Vec3(0.1, 0.1, 0.1), most + 1)));
    EXPECT_TRUE(contains(refusal, fmt::format("scenes/some.toml: emitters[0] (\"bed\"): {} grains "
                                              "do not fit into the box, at most {} do",
                                              most + 1, most)))
        << refusal;
    EXPECT_TRUE(contains(refusalOf(makeScene(makeFill(Vec3(0.1, 0.1, 0.1), 1000000))),
                         "times the volume of the box"));
    EXPECT_TRUE(contains(refusalOf(makeScene(makeFill(Vec3(0.1, 0.01, 0.1), 0))), "along y"));
    EXPECT_TRUE(contains(refusalOf(makeScene(makeFill(Vec3(1e5, 1e5, 0.1), 10))), "wide"));
}

TEST(Pile, IsASupportedConeInsideItsSlope)
{
    for (const double slope : {15.0, 25.0, 35.0, 50.0}) {
        const EmitterSpec spec = makePile(slope, 10000);
        const std::vector<NewGrain> grains = emitAll(*makeEmitter(makeScene(spec), 0));
        ASSERT_EQ(grains.size(), 10000U);
        EXPECT_GE(smallestGap(grains, 0.0), -1e-9);
        EXPECT_EQ(countUnsupported(grains, spec.position.z(), nullptr), 0);

        // The tightest cone of that slope about all grains; its own volume tells the fraction.
        const double tangent = std::tan(slope * kPi / 180.0);
        const double cosine = std::cos(slope * kPi / 180.0);
        double apex = 0.0;
        double volume = 0.0;
        double top = 0.0;
        for (const NewGrain& grain : grains) {
            const Vec3 p = grain.position - spec.position;
            EXPECT_GE(p.z(), grain.radius - kTouch);
            EXPECT_TRUE(grain.settled);
            apex = std::max(apex, p.z() + p.head<2>().norm() * tangent + grain.radius / cosine);
            top = std::max(top, p.z() + grain.radius);
            volume += 4.0 / 3.0 * kPi * std::pow(grain.radius, 3);
        }
        const double fraction = volume / (kPi * std::pow(apex, 3) / (3.0 * tangent * tangent));
        EXPECT_GT(fraction, 0.45) << slope;
        EXPECT_LT(fraction, 0.58) << slope;
        // The tip is there, but for the last grains, which have nothing to lie on.
        EXPECT_GT(top, apex - 2.5 * 0.01 / cosine) << slope;

        // The face follows the slope: highest grain in annuli between a quarter and three quarters
        // of the base, lengths in diameters.
        const double base = apex / tangent;
        for (int ring = 0; ring < 4; ++ring) {
            const double inner = base * (0.25 + 0.125 * ring);
            double shortfall = apex;
            for (const NewGrain& grain : grains) {
                const Vec3 p = grain.position - spec.position;
                const double rho = p.head<2>().norm();
                if (rho >= inner && rho < inner + 0.125 * base) {
                    shortfall =
                        std::min(shortfall, (apex - p.z() - rho * tangent) * cosine - grain.radius);
                }
            }
            EXPECT_LT(shortfall, 0.005) << slope << " ring " << ring;
        }
    }
}

TEST(Pile, SmallPilesHaveExactlyTheirCount)
{
    for (const std::int64_t count : {1, 2, 3, 10, 100}) {
        const std::vector<NewGrain> grains =
            emitAll(*makeEmitter(makeScene(makePile(25.0, count)), 0));
        EXPECT_EQ(grains.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(countUnsupported(grains, -0.2, nullptr), 0);
    }
}

TEST(Pile, SlopesThatCannotStandAreRefused)
{
    EXPECT_TRUE(contains(refusalOf(makeScene(makePile(70.0, 100))),
                         "emitters[0]: slope_angle must lie between 1 and 50 degrees, not 70"));
    EXPECT_TRUE(contains(refusalOf(makeScene(makePile(0.0, 100))), "slope_angle"));
    EXPECT_TRUE(contains(refusalOf(makeScene(makePile(25.0, 0))), "count must be at least 1"));
}

TEST(Settled, IsTheSameEveryTimeAndAnotherWithAnotherSeed)
{
    for (const EmitterSpec& spec : {makeFill(Vec3(0.1, 0.1, 0.05), 0), makePile(25.0, 500)}) {
        Scene scene = makeScene(spec);
        const std::vector<NewGrain> a = emitAll(*makeEmitter(scene, 0));
        std::vector<NewGrain> b;
        makeEmitter(scene, 0)->emit(0.123, b);  // late: sand at rest stays where it is
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            ASSERT_EQ(a[k].position, b[k].position);
            ASSERT_EQ(a[k].radius, b[k].radius);
        }
        scene.seed = 5;
        EXPECT_NE(emitAll(*makeEmitter(scene, 0))[0].position, a[0].position);
    }
}

TEST(Settled, ResumesBeforeAndAfterItsMoment)
{
    const Scene scene = makeScene(makeFill(Vec3(0.1, 0.1, 0.05), 0));
    const auto first = makeEmitter(scene, 0);
    const auto second = makeEmitter(scene, 0);
    second->loadState(first->saveState());
    EXPECT_EQ(second->nextTime(), 0.0);
    const std::vector<NewGrain> grains = emitAll(*first);
    EXPECT_EQ(emitAll(*second).size(), grains.size());

    const auto third = makeEmitter(scene, 0);
    third->loadState(first->saveState());
    EXPECT_EQ(third->nextTime(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(third->emitted(), static_cast<std::int64_t>(grains.size()));
    EXPECT_EQ(third->planned(), static_cast<std::int64_t>(grains.size()));
    EXPECT_THROW(third->loadState({1, 2}), InputError);
}

}  // namespace
}  // namespace sandflow
