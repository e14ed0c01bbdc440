#include "app/bench_bed.h"

#include "core/errors.h"
#include "core/stage_clock.h"
#include "dem/restitution.h"
#include "emit/settled_packing.h"
#include "io/atomic_file.h"
#include "io/number_text.h"
#include "measure/run_table.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

constexpr double kWallHeight = 1e3;          // m: higher than any bed
constexpr double kStillEnergy = 1e-3;        // of m g d, mean per grain
constexpr std::uint64_t kJudgedEvery = 250;  // steps
constexpr std::uint64_t kMostSteps = 40000;

double meanEnergy(const Dem<float>& dem)
{
    double sum = 0.0;
    for (const GrainRecord<float>& g : dem.mobile().record) {
        const double v2 = double{g.vx} * g.vx + double{g.vy} * g.vy + double{g.vz} * g.vz;
        sum += 0.5 * v2 / static_cast<double>(g.inverseMass);
    }
    return sum / static_cast<double>(dem.mobile().size());
}

}  // namespace

DemSetup makeBenchSetup(bool rolling)
{
    DemSetup setup;
    setup.judged = false;
    setup.meanRadius = setup.largestRadius = bench::kRadius;
    setup.density = bench::kDensity;
    setup.skin = 0.2;  // 1 mm, as good as any here and what the decks of the other codes use
    ContactCoefficients& law = setup.law;
    law.law = NormalLaw::linear;
    law.clipAttraction = false;
    law.stiffness = 1300.0;
    law.damping = solveDamping(NormalLaw::linear, law.clipAttraction, 0.3);
    law.friction = 0.5;
    law.tangentialRatio = 2.0 / 7.0;
    law.tangentialDamping = 0.5;
    if (rolling) {
        law.rollingFriction = 0.1;
        law.rollingStiffness = law.tangentialRatio;
    }
    SolidSpec box;
    box.shape = SolidShape::box;
    box.hollow = true;
    box.floor = true;
    box.max = Vec3(bench::kBoxEdge, bench::kBoxEdge, kWallHeight);
    setup.primitives = buildPrimitives(box, 0);
    return setup;
}

Bed makeBed(std::size_t grains)
{
    Bed bed;
    StageClock clock(bed.secondsToMake);
    GrainSpec spec;
    spec.radius = bench::kRadius;
    spec.sizeSpread = 0.0;
    spec.density = bench::kDensity;
    const std::vector<NewGrain> packed =
        packBox(Vec3::Zero(), Vec3(bench::kBoxEdge, bench::kBoxEdge, kWallHeight),
                static_cast<std::int64_t>(grains), spec, 1, 0);

    Dem<float> dem(makeBenchSetup(true));
    dem.recordContacts();
    std::uint32_t id = 0;
    for (const NewGrain& grain : packed) {
        dem.addMobile(grain.position, Vec3::Zero(), Vec3::Zero(), grain.radius, ++id);
    }
    dem.rebuild(0.0, bench::kStep);
    const double still = kStillEnergy * dem.massOf(bench::kRadius) * kGravity * 2 * bench::kRadius;
    while (bed.settlingSteps == 0 || meanEnergy(dem) > still) {
        if (bed.settlingSteps == kMostSteps) {
            throw PhysicsError(
                fmt::format("the bed of {} grains did not come to rest within {} steps; try fewer",
                            grains, kMostSteps));
        }
        for (std::uint64_t k = 0; k < kJudgedEvery; ++k) {
            if (!dem.listsHold()) {
                dem.recordContacts();
                dem.rebuild(0.0, bench::kStep);
            }
            dem.step(bench::kStep, false);
        }
        bed.settlingSteps += kJudgedEvery;
    }

    bed.centre.resize(packed.size());
    for (const GrainRecord<float>& g : dem.mobile().record) {
        bed.centre[g.id - 1] = Vec3(g.x, g.y, g.z);
    }
    return bed;
}

Bed readBed(const std::string& path)
{
    Bed bed;
    const RunTable table = RunTable::read(path);
    const std::vector<double>&id = table.column("id"), &x = table.column("x"),
          &y = table.column("y"), &z = table.column("z");
    if (table.rowCount() == 0) {
        throw InputError(fmt::format("{}: holds no grain", path));
    }
    std::vector<std::size_t> order(table.rowCount());
    for (std::size_t n = 0; n < order.size(); ++n) {
        order[n] = n;
    }
    std::sort(order.begin(), order.end(),
              [&id](std::size_t a, std::size_t b) { return id[a] < id[b]; });
    for (std::size_t n = 0; n < order.size(); ++n) {
        const std::size_t k = order[n];
        if (n > 0 && id[k] == id[order[n - 1]]) {
            throw InputError(fmt::format("{}: grain {} is there twice", path, id[k]));
        }
        const Vec3 p(x[k], y[k], z[k]);
        const bool isInside = p.allFinite() && p.minCoeff() >= 0.0 && p.z() <= kWallHeight &&
                              std::max(p.x(), p.y()) <= bench::kBoxEdge;
        if (!isInside) {
            throw InputError(
                fmt::format("{}: grain {} at ({:.4g}, {:.4g}, {:.4g}) m is outside "
                            "the box of {} x {} m",
                            path, id[k], p.x(), p.y(), p.z(), bench::kBoxEdge, bench::kBoxEdge));
        }
        bed.centre.push_back(p);
    }
    return bed;
}

void writeBed(const std::string& path, const Bed& bed)
{
    std::string text = "id,x,y,z\n";
    for (std::size_t k = 0; k < bed.centre.size(); ++k) {
        appendNumber(text, k + 1);
        for (int axis = 0; axis < 3; ++axis) {
            text += ',';
            appendNumber(text, bed.centre[k][axis]);
        }
        text += '\n';
    }
    writeFileAtomically(path, text);
}

}  // namespace sandflow
