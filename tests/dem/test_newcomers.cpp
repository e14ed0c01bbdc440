#include "dem/contact_coefficients.h"
#include "dem/dem.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace sandflow {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
constexpr double kStep = 1e-4;

DemSetup makeSetup()
{
    DemSetup setup;
    setup.law.stiffness = 3000.0;
    setup.law.damping = 0.3;
    setup.law.friction = 0.5;
    setup.law.tangentialRatio = 2.0 / 7.0;
    setup.law.tangentialDamping = 0.5;
    Primitive floor;
    floor.kind = Primitive::Kind::halfSpace;
    floor.axis = Vec3::UnitZ();
    floor.rough = true;
    setup.primitives = {floor};
    return setup;
}

/// One layer of a square jet: 6 x 6 grains a little off their places.
void addLayer(Dem<float>& dem, std::mt19937& random, std::uint32_t& id)
{
    std::uniform_real_distribution<double> jitter(-0.0005, 0.0005);
    for (int k = 0; k < 36; ++k) {
        const double x = 0.012 * (k % 6) + jitter(random), y = 0.012 * (k / 6) + jitter(random);
        dem.addMobile(Vec3(x, y, 0.25), Vec3(0.0, 0.0, -1.6), Vec3::Zero(), 0.005, ++id);
    }
}

/// Pairs of ids that overlap, each once, by trying all.
std::set<Pair> overlapping(const Dem<float>& dem)
{
    std::vector<GrainRecord<float>> all = dem.mobile().record;
    const std::size_t mobile = all.size();
    all.insert(all.end(), dem.boundary().records().begin(), dem.boundary().records().end());
    std::set<Pair> out;
    for (std::size_t a = 0; a < mobile; ++a) {
        for (std::size_t b = a + 1; b < all.size(); ++b) {
            const double dx = all[a].x - all[b].x, dy = all[a].y - all[b].y,
                         dz = all[a].z - all[b].z;
            const double radii =
                static_cast<double>(all[a].radius) + static_cast<double>(all[b].radius);
            if (dx * dx + dy * dy + dz * dz < radii * radii) {
                out.insert(std::minmax(all[a].id, all[b].id));
            }
        }
    }
    return out;
}

/// Pairs of ids in the lists; a pair of two chunks must stand in both.
std::multiset<Pair> listed(const Dem<float>& dem)
{
    std::multiset<Pair> out;
    const auto& mobile = dem.mobile().record;
    for (std::size_t c = 0; c < dem.lists().chunks().size(); ++c) {
        const auto& chunk = dem.lists().chunks()[c];
        const GrainRecord<float>* grain = mobile.data() + c * kChunkSize;
        for (const std::uint32_t p : chunk.own) {
            out.insert(std::minmax(grain[own_pair::lowerOf(p)].id, grain[own_pair::higherOf(p)].id));
        }
        for (std::size_t q = 0; q < chunk.foreign.size(); ++q) {
            const std::uint32_t f = chunk.foreign[q];
            const bool fixed =
                partner::sourceOf(f) == static_cast<std::uint32_t>(PartnerSource::boundary);
            const auto& source = fixed ? dem.boundary().records() : mobile;
            out.insert(std::minmax(grain[slot_offset::slotOf(chunk.foreignSlot[q])].id,
                                   source[partner::indexOf(f)].id));
        }
    }
    return out;
}

TEST(Newcomers, AreListedWithAllTheyTouchAndForceNoRebuild)
{
    Dem<float> dem(makeSetup());
    std::mt19937 random(5);
    std::uint32_t id = 0;
    std::uint64_t layers = 0, touching = 0;
    for (int step = 0; step < 4000; ++step) {
        if (step % 80 == 0) {  // 12.8 mm apart
            addLayer(dem, random, id);
            ++layers;
        }
        if (!dem.listsHold()) {
            dem.recordContacts();
            dem.rebuild(0.0, kStep);
        }
        dem.step(kStep, false);
        if (step % 40 != 39) {
            continue;
        }
        const std::multiset<Pair> pairs = listed(dem);
        for (const Pair& pair : overlapping(dem)) {
            const std::size_t times = pairs.count(pair);
            ASSERT_TRUE(times == 1 || times == 2)
                << "step " << step << ": grains " << pair.first << " and " << pair.second
                << " overlap and are listed " << times << " times";
            ++touching;
        }
    }
    EXPECT_EQ(dem.mobile().size(), 36 * layers);
    EXPECT_GT(touching, 10000u);
    EXPECT_LT(dem.deepestOverlap(), 0.3 * 0.005);
}

TEST(Newcomers, InAQuietSceneForceNoRebuild)
{
    Dem<float> dem(makeSetup());
    std::mt19937 random(5);
    std::uint32_t id = 0;
    addLayer(dem, random, id);
    dem.recordContacts();
    dem.rebuild(0.0, kStep);
    for (int step = 0; step < 160; ++step) {
        if (step % 80 == 40) {
            addLayer(dem, random, id);
            EXPECT_TRUE(dem.listsHold());
        }
        if (!dem.listsHold()) {
            dem.rebuild(0.0, kStep);
        }
        dem.step(kStep, false);
    }
    EXPECT_EQ(dem.mobile().size(), 108u);
    EXPECT_LE(dem.rebuilds(), 4u) << "what falls uses up its ball, what comes in does not";
}

}  // namespace
}  // namespace sandflow
