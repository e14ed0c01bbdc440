#include "transfer/part_overlaps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandflow {
namespace {

constexpr int kRounds = 16;
constexpr double kRelaxation = 1.3;      // of the mean correction of a grain's overlapping pairs
constexpr double kAllowed = 0.002;       // of the distance of touching grains: sand at rest has that
constexpr double kSearchMargin = 0.15;   // of it: neighbours that may come to touch in these rounds
constexpr double kTouching = 0.02;       // of it: closer than that counts as touching
constexpr double kSinking = 1.0;         // of its way: how far a grain sinks that is not held
constexpr int kHolding = 4;              // partners that hold a sphere with friction
constexpr double kHarmless = 0.06;       // of r: as deep as the most pressed pairs of full DEM at rest
constexpr int kMostTurns = 40;           // of kRounds each
constexpr std::uint32_t kObstacle = 0x80000000u;
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

}  // namespace

template <class Real>
std::size_t OverlapParter<Real>::shiftAndPart(
    const std::function<Vec3(const GrainRecord<Real>&)>& shiftOf, double least,
    const BuriedGrains& buried, Dem<Real>& dem)
{
    auto& fixed = dem.frozen();
    fixed.sort();
    moved_.clear();
    place_.clear();
    shift_.clear();
    movedAt_.assign(fixed.size(), kNone);
    for (std::size_t k = 0; k < fixed.size(); ++k) {
        const GrainRecord<Real>& g = fixed.record(k);
        const Vec3 shift = shiftOf(g);
        if (shift.squaredNorm() > least * least) {
            movedAt_[k] = static_cast<std::uint32_t>(moved_.size());
            moved_.push_back(static_cast<std::uint32_t>(k));
            place_.push_back(Vec3(g.x, g.y, g.z) + shift);
            shift_.push_back(shift.norm());
        }
    }
    if (moved_.empty()) {
        return 0;
    }
    listNeighbours(dem, &buried);
    listWalls(dem);
    settle(dem.setup().gravity.normalized());
    part();
    fixed.moveTo(moved_, place_);
    return moved_.size();
}

template <class Real>
double OverlapParter<Real>::partAll(Dem<Real>& dem)
{
    double deepest = 0.0;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        auto& fixed = dem.frozen();
        fixed.sort();
        moved_.resize(fixed.size());
        std::iota(moved_.begin(), moved_.end(), 0u);
        movedAt_ = moved_;
        place_.clear();
        for (const GrainRecord<Real>& g : fixed.records()) {
            place_.push_back({g.x, g.y, g.z});
        }
        listNeighbours(dem, nullptr);
        listWalls(dem);
        deepest = deepestOverlap();
        if (deepest < kHarmless * dem.setup().meanRadius) {
            break;
        }
        part();
        fixed.moveTo(moved_, place_);
    }
    return deepest;
}

template <class Real>
double OverlapParter<Real>::deepestOverlap() const
{
    double deepest = 0.0;
    for (std::size_t m = 0; m < place_.size(); ++m) {
        for (std::uint32_t n = m == 0 ? 0 : end_[m - 1]; n < end_[m]; ++n) {
            const Neighbour& other = neighbour_[n];
            const Vec3& there = other.grain >= kObstacle ? obstacles_[other.grain - kObstacle]
                                                         : place_[other.grain];
            deepest = std::max(deepest, other.reach - (place_[m] - there).norm());
        }
    }
    return deepest;
}

/// From the cells of the places before the shift, which is short.
template <class Real>
void OverlapParter<Real>::listNeighbours(const Dem<Real>& dem, const BuriedGrains* buried)
{
    neighbour_.clear();
    end_.clear();
    obstacles_.clear();
    for (std::size_t m = 0; m < moved_.size(); ++m) {
        const GrainRecord<Real>& g = dem.frozen().record(moved_[m]);
        const Vec3 before(g.x, g.y, g.z);
        const auto look = [&](const SortedCells& cells, const auto& records, bool areGrains) {
            cells.visitNear(cells.cellOf(before), 1, [&](const SortedCells::Cell& cell) {
                for (std::uint32_t e = cell.begin; e < cell.end; ++e) {
                    const GrainRecord<Real>& other = records[e];
                    const Vec3 there(other.x, other.y, other.z);
                    const double reach = static_cast<double>(g.radius + other.radius);
                    const double sight = reach * (1.0 + kSearchMargin);
                    if ((there - before).squaredNorm() > sight * sight || other.id == g.id) {
                        continue;
                    }
                    if (areGrains && movedAt_[e] != kNone) {
                        neighbour_.push_back({movedAt_[e], reach});
                    } else {
                        neighbour_.push_back(
                            {kObstacle + static_cast<std::uint32_t>(obstacles_.size()), reach});
                        obstacles_.push_back(there);
                    }
                }
            });
        };
        look(dem.frozen().cells(), dem.frozen().records(), true);
        look(dem.boundary().cells(), dem.boundary().records(), false);
        if (buried) {
            const double range = (static_cast<double>(g.radius) + dem.setup().largestRadius) *
                                 (1.0 + kSearchMargin);
            buried->visitNear(before, range, [&](const Vec3& there, double radius) {
                neighbour_.push_back({kObstacle + static_cast<std::uint32_t>(obstacles_.size()),
                                      static_cast<double>(g.radius) + radius});
                obstacles_.push_back(there);
            });
        }
        end_.push_back(static_cast<std::uint32_t>(neighbour_.size()));
    }
}

/// Smooth solids have no particles that would hold grains back.
template <class Real>
void OverlapParter<Real>::listWalls(const Dem<Real>& dem)
{
    wall_.clear();
    wallEnd_.clear();
    for (const std::uint32_t k : moved_) {
        const GrainRecord<Real>& g = dem.frozen().record(k);
        const Vec3 before(g.x, g.y, g.z);
        const auto radius = static_cast<double>(g.radius);
        for (const Primitive& solid : dem.setup().primitives) {
            if (!solid.isSmoothAt(dem.listTime())) {
                continue;
            }
            const SurfacePoint surface = nearestSurface(solid, before);
            if (surface.distance < radius * (1.0 + 2.0 * kSearchMargin)) {
                wall_.push_back(
                    {surface.normal, surface.normal.dot(before) - surface.distance, radius});
            }
        }
        wallEnd_.push_back(static_cast<std::uint32_t>(wall_.size()));
    }
}

/// Sand that is sheared opens up, and its weight closes it again: a grain that touches too few
/// others to be held by them sinks, in proportion to the way that it went.
template <class Real>
void OverlapParter<Real>::settle(const Vec3& down)
{
    const auto count = static_cast<std::int64_t>(place_.size());
    nextPlace_.resize(place_.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t m = 0; m < count; ++m) {
        int touching = 0;
        for (std::uint32_t n = m == 0 ? 0 : end_[m - 1]; n < end_[m]; ++n) {
            const Neighbour& other = neighbour_[n];
            const Vec3& there = other.grain >= kObstacle ? obstacles_[other.grain - kObstacle]
                                                         : place_[other.grain];
            const double sight = other.reach * (1.0 + kTouching);
            touching += (place_[m] - there).squaredNorm() < sight * sight ? 1 : 0;
        }
        for (std::uint32_t n = m == 0 ? 0 : wallEnd_[m - 1]; n < wallEnd_[m]; ++n) {
            touching += wall_[n].overlapAt(place_[m], -kTouching) > 0.0 ? 1 : 0;
        }
        nextPlace_[m] = place_[m];
        if (touching < kHolding) {
            nextPlace_[m] += kSinking * shift_[m] * down;
        }
    }
    place_.swap(nextPlace_);
}

/// Jacobi: every grain looks at the places of the last round, so the order does not matter.
template <class Real>
void OverlapParter<Real>::part()
{
    nextPlace_.resize(place_.size());
    const auto count = static_cast<std::int64_t>(place_.size());
    for (int round = 0; round < kRounds; ++round) {
#pragma omp parallel for schedule(static)
        for (std::int64_t m = 0; m < count; ++m) {
            Vec3 push = Vec3::Zero();
            int pairs = 0;
            for (std::uint32_t n = m == 0 ? 0 : end_[m - 1]; n < end_[m]; ++n) {
                const Neighbour& other = neighbour_[n];
                const bool isObstacle = other.grain >= kObstacle;
                const Vec3 apart = place_[m] - (isObstacle ? obstacles_[other.grain - kObstacle]
                                                           : place_[other.grain]);
                const double distance = apart.norm();
                const double overlap = other.reach * (1.0 - kAllowed) - distance;
                if (overlap > 0.0 && distance > 0.0) {
                    push += (isObstacle ? 1.0 : 0.5) * overlap / distance * apart;
                    ++pairs;
                }
            }
            for (std::uint32_t n = m == 0 ? 0 : wallEnd_[m - 1]; n < wallEnd_[m]; ++n) {
                const double overlap = wall_[n].overlapAt(place_[m], kAllowed);
                if (overlap > 0.0) {
                    push += overlap * wall_[n].normal;
                    ++pairs;
                }
            }
            nextPlace_[m] = pairs == 0 ? place_[m] : place_[m] + kRelaxation / pairs * push;
        }
        place_.swap(nextPlace_);
    }
    // Walls do not give way, however many grains press.
#pragma omp parallel for schedule(static)
    for (std::int64_t m = 0; m < count; ++m) {
        for (std::uint32_t n = m == 0 ? 0 : wallEnd_[m - 1]; n < wallEnd_[m]; ++n) {
            place_[m] += std::max(wall_[n].overlapAt(place_[m], kAllowed), 0.0) * wall_[n].normal;
        }
    }
}

template class OverlapParter<float>;
template class OverlapParter<double>;

}  // namespace sandflow
