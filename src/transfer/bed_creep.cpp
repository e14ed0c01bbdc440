#include "transfer/bed_creep.h"

#include "bcre/smooth_spans.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

constexpr int kLayers = 40;
constexpr double kLayerHeight = 0.5;  // d
constexpr int kFlowLayers = 4;        // above the bed, over which the flow's speed is taken
constexpr double kMemory = 0.1;       // s: speeds are averaged over about that long
constexpr int kSmoothings = 3;        // one column is 3 d: neighbours share their grains' motion
constexpr double kLongestShift = 0.2;   // d, of a grain at a time: what parting overlaps can mend
constexpr double kShortestShift = 1e-5;  // d: less is rest

constexpr double kNoBed = -1e30;

/// u_b over the mean of v over the lowest kFlowLayers.
double shareOfFlow(double decay, double diameter)
{
    const double zone = kFlowLayers * kLayerHeight * diameter;
    return 1.0 / (decay / zone * std::expm1(zone / decay) - 1.0);
}

}  // namespace

template <class Real>
BedCreep<Real>::BedCreep(const CreepParams& params)
    : params_(params),
      share_(params.decay > 0.0 ? shareOfFlow(params.decay, params.diameter) : 0.0)
{}

template <class Real>
std::size_t BedCreep<Real>::carry(const ColumnGrid& columns, double interval,
                                  const BuriedGrains& buried, Dem<Real>& dem)
{
    if (share_ == 0.0) {
        return 0;
    }
    sortIntoLayers(columns, dem);
    findBedVelocity(columns, interval);
    smooth(columns);
    if (fastest_ * interval < kShortestShift * params_.diameter) {
        return 0;
    }
    const auto shiftOf = [&](const GrainRecord<Real>& g) -> Vec3 {
        return interval * velocityAt(columns, g);
    };
    const auto count = static_cast<std::int64_t>(dem.mobile().size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < count; ++k) {
        GrainRecord<Real>& g = dem.mobile().record[k];
        const Vec3 shift = shiftOf(g);
        g.x += shift.x(), g.y += shift.y(), g.z += shift.z();
        // It rests or not relative to the bed.
        GrainMemory& memory = dem.mobile().memory[k];
        memory.anchorX += shift.x(), memory.anchorY += shift.y(), memory.anchorZ += shift.z();
    }
    return parter_.shiftAndPart(shiftOf, kShortestShift * params_.diameter, buried, dem);
}

template <class Real>
void BedCreep<Real>::sortIntoLayers(const ColumnGrid& columns, const Dem<Real>& dem)
{
    layers_.assign(columns.spanCount() * kLayers, {});
    const double perLayer = 1.0 / (kLayerHeight * params_.diameter);
    const auto layerOf = [&](const GrainRecord<Real>& g) -> Layer* {
        const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
        if (span == ColumnGrid::kNone) {
            return nullptr;
        }
        const double depth = (columns.H[span] - g.z) * perLayer;
        return depth < -2.0 || depth >= kLayers
                   ? nullptr
                   : &layers_[static_cast<std::size_t>(span) * kLayers +
                              static_cast<std::size_t>(std::max(depth, 0.0))];
    };
    for (const GrainRecord<Real>& g : dem.mobile().record) {
        if (Layer* layer = layerOf(g)) {
            layer->moving += 1.0;
            layer->velocity += Vec3(g.vx, g.vy, g.vz);
        }
    }
    for (const GrainRecord<Real>& g : dem.frozen().records()) {
        if (Layer* layer = layerOf(g)) {
            layer->still += 1.0;
        }
    }
}

/// The bed begins where most grains are fixed, over a span and its neighbours.
template <class Real>
void BedCreep<Real>::findBedVelocity(const ColumnGrid& columns, double interval)
{
    const std::size_t count = columns.spanCount();
    averaged_.resize(count, Vec3::Zero());
    bedTop_.assign(count, kNoBed);
    const double kept = std::exp(-interval / kMemory);
    const double fastest = kLongestShift * params_.diameter / interval;
#pragma omp parallel for schedule(static)
    for (std::int64_t s = 0; s < static_cast<std::int64_t>(count); ++s) {
        const auto layer = [&](int depth) {
            Layer sum = layers_[static_cast<std::size_t>(s * kLayers + depth)];
            for (const std::int32_t other : columns.link[s]) {
                if (other != ColumnGrid::kNone) {
                    const Layer& o = layers_[static_cast<std::size_t>(other * kLayers + depth)];
                    sum.still += o.still, sum.moving += o.moving, sum.velocity += o.velocity;
                }
            }
            return sum;
        };
        Vec3 flow = Vec3::Zero();  // mean velocity just above the bed
        for (int depth = 0; depth < kLayers && bedTop_[s] == kNoBed; ++depth) {
            const Layer here = layer(depth);
            if (here.still <= here.moving) {
                continue;
            }
            bedTop_[s] = columns.H[s] - kLayerHeight * params_.diameter * depth;
            double moving = 0.0;
            for (int above = std::max(0, depth - kFlowLayers); above < depth; ++above) {
                const Layer sand = layer(above);
                moving += sand.moving;
                flow += sand.velocity;
            }
            flow /= std::max(moving, 1.0);
        }
        // A solid below holds the bed, one beside it turns it.
        const double thickness = std::max(bedTop_[s] - columns.floor[s], 0.0);
        Vec3 u = bedTop_[s] == kNoBed || columns.ragged[s]
                     ? Vec3::Zero()
                     : Vec3(-share_ * std::expm1(-thickness / params_.decay) * flow);
        for (int direction = 0; direction < 4; ++direction) {
            const double outward = (direction & 1 ? 1.0 : -1.0) * u[direction / 2];
            if (columns.link[s][direction] == ColumnGrid::kNone && outward > 0.0) {
                u[direction / 2] = 0.0;
            }
        }
        const double speed = u.norm();
        averaged_[s] = kept * averaged_[s] +
                       (1.0 - kept) * (speed > fastest ? Vec3(fastest / speed * u) : u);
    }
}

template <class Real>
void BedCreep<Real>::smooth(const ColumnGrid& columns)
{
    velocity_ = averaged_;
    smoothOverNeighbours(columns, kSmoothings, velocity_, smoothed_);
    fastest_ = 0.0;
    for (const Vec3& u : velocity_) {
        fastest_ = std::max(fastest_, u.norm());
    }
}

template <class Real>
Vec3 BedCreep<Real>::velocityAt(const ColumnGrid& columns, const GrainRecord<Real>& g) const
{
    const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
    if (span == ColumnGrid::kNone || bedTop_[span] == kNoBed ||
        g.z > columns.H[span] + params_.diameter) {
        return Vec3::Zero();
    }
    const double below = bedTop_[span] - g.z;
    if (below >= params_.depth) {
        return Vec3::Zero();
    }
    const double x = g.x / columns.cellSize() - columns.columnI[span] - 0.5;
    const double y = g.y / columns.cellSize() - columns.columnJ[span] - 0.5;
    const std::int32_t besideX = columns.link[span][x > 0.0 ? 1 : 0];
    const std::int32_t besideY = columns.link[span][y > 0.0 ? 3 : 2];
    Vec3 u = velocity_[span];
    if (besideX != ColumnGrid::kNone) {
        u += std::abs(x) * (velocity_[besideX] - velocity_[span]);
    }
    if (besideY != ColumnGrid::kNone) {
        u += std::abs(y) * (velocity_[besideY] - velocity_[span]);
    }
    if (below > 0.0) {
        const double end = std::exp(-params_.depth / params_.decay);
        u *= (std::exp(-below / params_.decay) - end) / (1.0 - end);
    }
    return u;
}

template class BedCreep<float>;
template class BedCreep<double>;

}  // namespace sandflow
