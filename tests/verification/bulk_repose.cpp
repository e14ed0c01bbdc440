#include "verification/bulk_repose.h"

#include "verification/bulk_sand.h"
#include "verification/verdict.h"

#include <fmt/format.h>

#include <algorithm>

namespace sandflow::verification {

HeapFigures pourHeap(Mode mode, double friction, double rollingFriction, std::uint64_t seed)
{
    Scene scene = makeSandScene("repose", mode, seed);
    scene.contact.friction = friction;
    scene.contact.rollingFriction = rollingFriction;
    scene.time.settle = 1.5;

    SolidSpec floor;
    floor.name = "floor";
    floor.rough = true;
    scene.solids.push_back(floor);

    EmitterSpec spout;
    spout.kind = EmitterKind::jet;
    spout.name = "spout";
    spout.count = 10000;
    spout.rate = 3000.0;  // fits through the opening whatever the seed
    spout.position = Vec3(0.0, 0.0, 0.3);
    spout.radius = 0.05;
    spout.speed = 1.0;
    scene.emitters.push_back(spout);

    const auto simulation = runToEnd(scene, [](const Simulation&, const FrameReport&) {});
    return measureHeap(takeSnapshotOf(*simulation));
}

namespace {

/// Pours of one set of coefficients; a scatter takes at least three.
constexpr int kLeastSeeds = 3;

struct Repose {
    double mean = 0.0;     ///< degrees
    double scatter = 0.0;  ///< degrees, standard deviation of one pour
};

Repose measureRepose(Mode mode, double friction, double rollingFriction, int seeds)
{
    std::vector<double> angles;
    for (int seed = 1; seed <= std::max(seeds, kLeastSeeds); ++seed) {
        const HeapFigures heap =
            pourHeap(mode, friction, rollingFriction, static_cast<std::uint64_t>(seed));
        angles.push_back(heap.reposeDeg.value_or(kNotMeasured));
        tellProgress(fmt::format("mu {}, mu_r {}, {}, seed {}: {:.2f} degrees", friction,
                                 rollingFriction, nameOf(mode), seed, angles.back()));
    }
    return {meanOf(angles), scatterOf(angles)};
}

struct Friction {
    double sliding, rolling;
};

struct ReposeOfBoth {
    Repose dem, flow;
};

/// The angle rises with either coefficient (Zhou et al. 2001).
void addRise(std::vector<Verdict>& rows, const std::string& what, const ReposeOfBoth& low,
             const ReposeOfBoth& high)
{
    addBoth(rows, "rise [deg], " + what, 0.0,
            {high.dem.mean - low.dem.mean, high.flow.mean - low.flow.mean}, Gate::atLeast);
}

std::vector<Verdict> runRepose(const Settings& settings)
{
    // mu = 0.2, 0.5, 0.8 at mu_r = 0.1, then mu_r = 0 and 0.3 at mu = 0.5.
    const Friction frictions[] = {{0.2, 0.1}, {0.5, 0.1}, {0.8, 0.1}, {0.5, 0.0}, {0.5, 0.3}};
    std::vector<Verdict> rows;
    std::vector<ReposeOfBoth> found;
    for (const Friction& f : frictions) {
        ReposeOfBoth both;
        both.dem = measureRepose(Mode::dem, f.sliding, f.rolling, settings.seeds);
        both.flow = measureRepose(Mode::surfaceFlow, f.sliding, f.rolling, settings.seeds);
        found.push_back(both);
        const std::string at = fmt::format("[deg], mu {}/{}", f.sliding, f.rolling);
        addBoth(rows, "repose " + at, both.dem.mean, {both.dem.mean, both.flow.mean}, Gate::report);
        addBoth(rows, "scatter " + at, both.dem.scatter, {both.dem.scatter, both.flow.scatter},
                Gate::report);
    }
    addRise(rows, "mu 0.2 to 0.5", found[0], found[1]);
    addRise(rows, "mu 0.5 to 0.8", found[1], found[2]);
    addRise(rows, "mu_r 0 to 0.1", found[3], found[1]);
    addRise(rows, "mu_r 0.1 to 0.3", found[1], found[4]);
    return rows;
}

const Registration kRepose({"BulkRepose",
                            "repose of a poured heap against mu/mu_r, trends of Zhou 2001", true,
                            runRepose});

}  // namespace
}  // namespace sandflow::verification
