#include "measure/packing.h"

#include "measure/grain_grid.h"
#include "measure/settled.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sandflow {
namespace {

constexpr double kTouchingGap = 0.02;  // of the mean diameter of the pair
constexpr double kSlow = 0.01;         // m/s; a free grain stays below it for 2 ms at most
constexpr std::int64_t kChunk = 1024;  // grains; fixed, so that sums do not depend on threads

/// The part of the figures that one chunk of grains adds.
struct PartialSum {
    std::size_t contacts = 0;
    double overlap = 0.0;
    double maxOverlap = 0.0;
    std::size_t floatingFrozen = 0;
    std::size_t floatingSlow = 0;
};

void addGrain(const Snapshot& snapshot, const GrainGrid& grid, const FloorHeight& floor,
              std::size_t n, PartialSum& sum)
{
    const Vec3& p = snapshot.position[n];
    const double radius = snapshot.radius[n];
    bool nearAny = false;
    grid.visitNear(n, [&](std::size_t other) {
        const double otherRadius = snapshot.radius[other];
        const double touching = radius + otherRadius;
        const double reach = (1.0 + kTouchingGap) * touching;
        const double square = (p - snapshot.position[other]).squaredNorm();
        if (square > reach * reach) {
            return true;
        }
        nearAny = true;
        const double overlap = touching - std::sqrt(square);
        if (n < other && overlap > 0.0) {  // each pair once
            const double relative = overlap / std::min(radius, otherRadius);
            ++sum.contacts;
            sum.overlap += relative;
            sum.maxOverlap = std::max(sum.maxOverlap, relative);
        }
        return true;
    });
    if (nearAny || p.z() - radius - floor(p.x(), p.y()) <= SettledRule{}.widestGap * radius) {
        return;
    }
    const GrainState state = snapshot.state[n];
    if (state == GrainState::interface || state == GrainState::buried) {
        ++sum.floatingFrozen;
    } else if (snapshot.velocity[n].cast<double>().norm() < kSlow) {
        ++sum.floatingSlow;
    }
}

}  // namespace

PackingFigures measurePacking(const Snapshot& snapshot, double floorZ)
{
    return measurePacking(snapshot, levelFloor(floorZ));
}

PackingFigures measurePacking(const Snapshot& snapshot, const FloorHeight& floor)
{
    PackingFigures figures;
    figures.grains = snapshot.size();
    if (snapshot.size() == 0) {
        return figures;
    }
    const GrainGrid grid(snapshot, 2.0 * (1.0 + kTouchingGap) * findLargestRadius(snapshot));
    const auto count = static_cast<std::int64_t>(snapshot.size());
    const std::int64_t chunkCount = (count + kChunk - 1) / kChunk;
    std::vector<PartialSum> partial(static_cast<std::size_t>(chunkCount));
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t c = 0; c < chunkCount; ++c) {
        for (std::int64_t n = c * kChunk; n < std::min(count, (c + 1) * kChunk); ++n) {
            addGrain(snapshot, grid, floor, static_cast<std::size_t>(n), partial[c]);
        }
    }

    double overlap = 0.0;
    for (const PartialSum& sum : partial) {
        figures.contacts += sum.contacts;
        overlap += sum.overlap;
        figures.maxOverlap = std::max(figures.maxOverlap, sum.maxOverlap);
        figures.floatingFrozen += sum.floatingFrozen;
        figures.floatingSlow += sum.floatingSlow;
    }
    figures.meanCoordination =
        2.0 * static_cast<double>(figures.contacts) / static_cast<double>(figures.grains);
    figures.meanOverlap =
        figures.contacts > 0 ? overlap / static_cast<double>(figures.contacts) : 0.0;
    return figures;
}

}  // namespace sandflow
