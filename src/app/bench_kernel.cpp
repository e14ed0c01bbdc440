#include "app/bench_kernel.h"

#include "app/busy_neighbours.h"
#include "core/stage_clock.h"

#include <algorithm>
#include <memory>
#include <omp.h>

namespace sandflow {
namespace {

template <class Real>
void renewLists(Dem<Real>& dem)
{
    dem.recordContacts();
    dem.rebuild(0.0, bench::kStep);
}

template <class Real>
KernelTiming timeSteps(Dem<Real>& dem, int steps)
{
    KernelTiming timing;
    for (int k = 0; k < steps; ++k) {
        if (!dem.listsHold()) {
            StageClock clock(timing.rebuildSeconds);
            renewLists(dem);
            ++timing.rebuilds;
        }
        StageClock clock(timing.stepSeconds);
        dem.step(bench::kStep, false);
    }
    return timing;
}

template <class Real>
double sumKineticEnergy(const Dem<Real>& dem)
{
    double sum = 0.0;
    for (const GrainRecord<Real>& g : dem.mobile().record) {
        const Vec3 v(static_cast<double>(g.vx), static_cast<double>(g.vy),
                     static_cast<double>(g.vz));
        sum += 0.5 * v.squaredNorm() / static_cast<double>(g.inverseMass);
    }
    return sum;
}

/// Mean number of partners that push on a grain, from one more step.
template <class Real>
double countContacts(Dem<Real>& dem)
{
    if (!dem.listsHold()) {
        renewLists(dem);
    }
    dem.step(bench::kStep, true);
    double sum = 0.0;
    for (const GrainLoad& load : dem.mobile().load) {
        sum += static_cast<double>(load.contacts);
    }
    return sum / static_cast<double>(dem.mobile().size());
}

/// The bed after the steps of the warm-up.
template <class Real>
std::unique_ptr<Dem<Real>> startBench(const Bed& bed, const KernelBenchOptions& options)
{
    auto dem = std::make_unique<Dem<Real>>(makeBenchSetup(options.rolling));
    dem->mobile().reserve(bed.centre.size());
    std::uint32_t id = 0;
    for (const Vec3& centre : bed.centre) {
        dem->addMobile(centre, Vec3::Zero(), Vec3::Zero(), bench::kRadius, ++id);
    }
    timeSteps(*dem, options.warmup);
    dem->resetExtremes();
    return dem;
}

template <class Real>
KernelBenchResult benchWith(const Bed& bed, const KernelBenchOptions& options)
{
    KernelBenchResult result;
    result.grains = bed.centre.size();
    result.steps = options.steps;
    result.threads = omp_get_max_threads();
    const auto count = static_cast<double>(result.grains);
    const auto mpsOf = [&](double seconds) { return 1e-6 * count * options.steps / seconds; };

    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        const std::unique_ptr<Dem<Real>> started = startBench<Real>(bed, options);
        Dem<Real>& dem = *started;
        result.repeats.push_back(timeSteps(dem, options.steps));
        if (repeat + 1 == options.repeats) {
            result.kineticEnergy = sumKineticEnergy(dem);
            result.bytesPerGrain = static_cast<double>(dem.bytes()) / count;
            result.pairsPerGrain = static_cast<double>(dem.listedPairs()) / count;
            result.deepestOverlap = dem.deepestOverlap() / bench::kRadius;
            result.contactsPerGrain = countContacts(dem);
        }
    }
    const auto total = [](const KernelTiming& t) { return t.stepSeconds + t.rebuildSeconds; };
    const auto sort = [&](std::vector<KernelTiming>& timings) {
        std::sort(timings.begin(), timings.end(), [&](const KernelTiming& a, const KernelTiming& b) {
            return total(a) < total(b);
        });
    };
    if (options.busy > 0) {
        const BusyNeighbours neighbours(options.busy);
        std::vector<KernelTiming> timings;
        for (int repeat = 0; repeat < options.repeats; ++repeat) {
            const std::unique_ptr<Dem<Real>> dem = startBench<Real>(bed, options);
            timings.push_back(timeSteps(*dem, options.steps));
        }
        sort(timings);
        result.mpsBusy = mpsOf(total(timings[timings.size() / 2]));
    }
    std::vector<KernelTiming> sorted = result.repeats;
    sort(sorted);
    const KernelTiming& median = sorted[sorted.size() / 2];
    result.mps = mpsOf(total(median));
    result.mpsHigh = mpsOf(total(sorted.front()));
    result.mpsLow = mpsOf(total(sorted.back()));
    result.mpsWithoutRebuilds = mpsOf(median.stepSeconds);
    result.rebuilds = median.rebuilds;
    result.rebuildShare = median.rebuildSeconds / total(median);
    return result;
}

}  // namespace

KernelBenchResult benchKernel(const Bed& bed, const KernelBenchOptions& options)
{
    return options.real64 ? benchWith<double>(bed, options) : benchWith<float>(bed, options);
}

}  // namespace sandflow
