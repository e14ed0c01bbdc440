#include "transfer/bed_settling.h"

#include <cmath>

namespace sandflow {

const std::vector<double>& BedSettling::endedFlows(const ColumnGrid& columns,
                                                   const std::vector<Vec3>& bedVelocity,
                                                   double interval)
{
    line_.clear();
    if (params_.depth == 0.0) {
        return line_;
    }
    const std::size_t count = columns.spanCount();
    crept_.resize(count, 0.0);
    usual_.resize(count, 0.0);
    const double kept = std::exp(-interval / params_.lately);
    visited_.assign(count, 0);
    for (std::size_t s = 0; s < bedVelocity.size(); ++s) {
        const double speed = bedVelocity[s].norm();
        crept_[s] += speed * interval;
        usual_[s] = kept * usual_[s] + (1.0 - kept) * speed;
    }
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(count); ++s) {
        if (visited_[s] || !owesRest(s)) {
            continue;
        }
        findRegion(columns, s);
        if (flowIsEnding(bedVelocity)) {
            line_.resize(count, kNowhere);
            for (const std::int32_t t : region_) {
                line_[t] = columns.H[t] - params_.depth;
                crept_[t] = 0.0;
            }
        }
    }
    return line_;
}

/// All spans that owe rest and hang together with the first.
void BedSettling::findRegion(const ColumnGrid& columns, std::int32_t first)
{
    region_.assign(1, first);
    visited_[first] = 1;
    for (std::size_t k = 0; k < region_.size(); ++k) {
        for (const std::int32_t other : columns.link[region_[k]]) {
            if (other != ColumnGrid::kNone && !visited_[other] && owesRest(other)) {
                visited_[other] = 1;
                region_.push_back(other);
            }
        }
    }
}

bool BedSettling::flowIsEnding(const std::vector<Vec3>& bedVelocity) const
{
    double now = 0.0, usual = 0.0;
    for (const std::int32_t s : region_) {
        now += bedVelocity[s].norm();
        usual += usual_[s];
    }
    return now < params_.ending * usual;
}

}  // namespace sandflow
