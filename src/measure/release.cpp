#include "measure/release.h"

#include "measure/compare.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

double findFastest(const Snapshot& sand)
{
    double fastest = 0.0;
    for (const Vec3f& v : sand.velocity) {
        fastest = std::max(fastest, static_cast<double>(v.norm()));
    }
    return fastest;
}

double findLowest(const Snapshot& sand)
{
    double lowest = sand.size() > 0 ? sand.position[0].z() : 0.0;
    for (const Vec3& p : sand.position) {
        lowest = std::min(lowest, p.z());
    }
    return lowest;
}

}  // namespace

ReleaseWatch::ReleaseWatch(Snapshot before, FloorHeight floor, double gravity)
    : before_(std::move(before)),
      floor_(std::move(floor)),
      gravity_(gravity),
      top_(findLowest(before_)),
      fastestBefore_(findFastest(before_))
{
    for (const Vec3& p : before_.position) {
        top_ = std::max(top_, p.z());
    }
}

void ReleaseWatch::look(const Snapshot& now)
{
    const double v0 = fastestBefore_;
    const double height = std::max(0.0, top_ - findLowest(now));
    const double couldFall = std::min(v0 + gravity_ * (now.time - before_.time),
                                      std::sqrt(v0 * v0 + 2.0 * gravity_ * height));
    const double fastest = findFastest(now);
    if (couldFall_ == 0.0 || fastest * couldFall_ > fastest_ * couldFall) {
        fastest_ = fastest;
        couldFall_ = couldFall;
    }
}

ReleaseFigures ReleaseWatch::figures(const Snapshot& last) const
{
    const HeapComparison change = compareHeaps(before_, last, floor_);
    ReleaseFigures figures;
    figures.seconds = last.time - before_.time;
    figures.apexMoved = change.apexDifference;
    figures.meanHeightChange = change.cells.mean;
    figures.reposeMoved = change.reposeDifference;
    figures.fastest = fastest_;
    figures.couldFall = couldFall_;
    return figures;
}

}  // namespace sandflow
