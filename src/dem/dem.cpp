#include "dem/dem.h"

#include "core/errors.h"
#include "dem/chunk_turns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandflow {
namespace {

double cellSizeFor(const DemSetup& setup)
{
    return std::max(1.5 * 2.0 * setup.meanRadius,
                    2.0 * setup.largestRadius + 1.05 * setup.skin * setup.meanRadius);
}

}  // namespace

template <class Real>
Dem<Real>::Dem(const DemSetup& setup)
    : setup_(setup),
      frozen_(cellSizeFor(setup)),
      boundary_(cellSizeFor(setup)),
      lists_(cellSizeFor(setup), setup.skin * setup.meanRadius, setup.largestRadius),
      kernel_(makeForceKernel<Real>(setup.law, false)),
      observingKernel_(makeForceKernel<Real>(setup.law, true))
{
    mobile_.judged = setup_.judged;
    meshStands_.resize(setup_.meshCovers.size(), 0);
    for (std::size_t p = 0; p < setup_.primitives.size(); ++p) {
        if (setup_.primitives[p].rough) {
            covers_.push_back({p,
                               RoughCover(setup_.primitives[p],
                                          setup_.roughGap * setup_.meanRadius,
                                          setup_.seed + p),
                               {}});
        }
    }
}

template <class Real>
double Dem<Real>::massOf(double radius) const
{
    return setup_.density * 4.0 / 3.0 * kPi * radius * radius * radius;
}

template <class Real>
GrainRecord<Real> Dem<Real>::makeRecord(const Vec3& position, double radius, std::uint32_t id) const
{
    GrainRecord<Real> g;
    g.x = position.x(), g.y = position.y(), g.z = position.z();
    g.radius = static_cast<Real>(radius);
    g.id = id;
    g.wakeForce = std::numeric_limits<float>::infinity();  // until it is judged, if it is
    return g;
}

template <class Real>
void Dem<Real>::recordContacts()
{
    if (contactsRecorded_) {
        return;
    }
    contactsRecorded_ = true;
    book_.record(lists_.chunks(), mobile_.record, frozen_.records(), boundary_.records());
    std::iota(mobile_.row.begin(), mobile_.row.end(), 0u);
    for (std::size_t k = 0; k < frozen_.size(); ++k) {
        frozen_.info(k).row = kNoRow;
    }
    // The indices are about to change, and the next transfer may be a rebuild or two away.
    for (const std::uint32_t k : wakeRequests_) {
        frozen_.info(k).wakes = true;
    }
    wakeRequests_.clear();
    listsHold_ = false;
}

template <class Real>
void Dem<Real>::forgetContacts()
{
    SAND_CHECK(contactsRecorded_, "springs are wiped between recordContacts() and rebuild()");
    std::fill(mobile_.row.begin(), mobile_.row.end(), kNoRow);
}

template <class Real>
void Dem<Real>::addMobile(const Vec3& position, const Vec3& velocity, const Vec3& spin,
                          double radius, std::uint32_t id)
{
    GrainRecord<Real> g = makeRecord(position, radius, id);
    g.inverseMass = static_cast<Real>(1.0 / massOf(static_cast<double>(g.radius)));
    g.vx = static_cast<Real>(velocity.x());
    g.vy = static_cast<Real>(velocity.y());
    g.vz = static_cast<Real>(velocity.z());
    g.wx = static_cast<Real>(spin.x());
    g.wy = static_cast<Real>(spin.y());
    g.wz = static_cast<Real>(spin.z());
    mobile_.add(g);
    if (listsHold_) {
        listNewcomer();
    }
}

template <class Real>
void Dem<Real>::listNewcomer()
{
    if (!hasRoomFor(lists_.ballAhead(mobile_.record.back()))) {
        listsHold_ = false;
        return;
    }
    lists_.append(mobile_, frozen_, boundary_, setup_.primitives, listTime_);
    mobile_.next.resize(mobile_.size());
    if (setup_.judged) {
        mobile_.load.resize(mobile_.size());
    }
    reports_.resize(lists_.chunkCount());
}

/// False where the ball reaches ground that is not covered yet, or the grid does not.
template <class Real>
bool Dem<Real>::hasRoomFor(const SearchBall& ball) const
{
    const Vec3 centre(ball.x, ball.y, ball.z);
    return lists_.cells().holds(centre) &&
           isCovered(centre, static_cast<double>(ball.reach) + setup_.meanRadius);
}

template <class Real>
void Dem<Real>::rebuild(double time, double dt)
{
    recordContacts();
    contactsRecorded_ = false;
    coverMeshes(time);
    lists_.rebuild(chooseHorizon(dt), mobile_, frozen_, boundary_, setup_.primitives, time,
                   book_, [&](const SortedCells& cells) { coverRoughSolids(cells, time); });
    mobile_.next.resize(mobile_.size());
    if (setup_.judged) {
        mobile_.load.resize(mobile_.size());
    }
    reports_.resize(lists_.chunkCount());
    listTime_ = time;
    listsHold_ = true;
    ++rebuilds_;
}

/// T of the lists [s]: as long as the fastest grain's partners stay within two cells, for that is
/// where a search begins to cost. Grains at rest are not affected by T at all.
template <class Real>
double Dem<Real>::chooseHorizon(double dt) const
{
    constexpr double kFewestSteps = 16;
    Real fastest = 0;
    const auto n = static_cast<std::int64_t>(mobile_.size());
#pragma omp parallel for schedule(static) reduction(max : fastest)
    for (std::int64_t k = 0; k < n; ++k) {
        const GrainRecord<Real>& g = mobile_.record[k];
        fastest = std::max(fastest, g.vx * g.vx + g.vy * g.vy + g.vz * g.vz);
    }
    const double speed = std::sqrt(static_cast<double>(fastest));
    const double reach = lists_.cells().cellSize() - setup_.largestRadius - lists_.skin() / 2;
    return std::clamp(2.0 * reach / std::max(speed, 1e-6), kFewestSteps * dt,
                      setup_.longestHorizon * dt);
}

/// Puts in the particles of meshes that have appeared and takes out those of meshes that are gone.
/// They are looked at only from cells with mobile grains, like all that is fixed.
template <class Real>
void Dem<Real>::coverMeshes(double time)
{
    for (std::size_t m = 0; m < meshStands_.size(); ++m) {
        const MeshCover& mesh = setup_.meshCovers[m];
        const bool stands = mesh.existsAt(time);
        if (stands == static_cast<bool>(meshStands_[m])) {
            continue;
        }
        meshStands_[m] = stands ? 1 : 0;
        const auto cover = static_cast<std::uint32_t>(setup_.primitives.size() + m);
        if (!stands) {
            boundary_.removeUnless([&](std::size_t k) { return boundary_.info(k).cover != cover; });
            continue;
        }
        for (const Vec3& p : mesh.centres) {
            boundary_.add(makeRecord(p, mesh.radius, kFirstBoundaryId + boundaryIds_++), {cover});
        }
    }
}

/// Makes the fixed particles of rough planes wherever a mobile grain may touch them before the next
/// rebuild. What was made stays.
template <class Real>
void Dem<Real>::coverRoughSolids(const SortedCells& cells, double time)
{
    std::vector<Vec3> centres;
    for (Cover& cover : covers_) {
        const Primitive& plane = setup_.primitives[cover.primitive];
        if (!plane.existsAt(time)) {
            if (cover.made.size() > 0) {  // it is gone for good
                cover.made.clear();
                boundary_.removeUnless(
                    [&](std::size_t k) { return boundary_.info(k).cover != cover.primitive; });
            }
            continue;
        }
        for (std::size_t c = 0; c < cells.cells().size(); ++c) {
            const CellIndex at = cells.cells()[c].index;
            const double size = cells.cellSize();
            const double range = size * (lists_.searchRadius(c) + 0.5);
            const Vec3 centre = size * Vec3(at.i + 0.5, at.j + 0.5, at.k + 0.5);
            const double height = plane.axis.dot(centre - plane.point);
            if (std::abs(height) > range * (1.8 + kRoughCoverDepth)) {  // cube's half diagonal, and more
                continue;
            }
            std::int32_t u0 = INT32_MAX, u1 = INT32_MIN, v0 = INT32_MAX, v1 = INT32_MIN;
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3 offset((corner & 1) ? range : -range, (corner & 2) ? range : -range,
                                  (corner & 4) ? range : -range);
                const auto [u, v] = cover.cover.patchOf(centre + offset);
                u0 = std::min(u0, u), u1 = std::max(u1, u);
                v0 = std::min(v0, v), v1 = std::max(v1, v);
            }
            for (std::int32_t v = v0; v <= v1; ++v) {
                for (std::int32_t u = u0; u <= u1; ++u) {
                    if (!cover.made.insert(packCellKey(u, v, 0), 1).second) {
                        continue;
                    }
                    centres.clear();
                    cover.cover.appendPatch(u, v, centres);
                    for (const Vec3& p : centres) {
                        const Vec3 sunk = p - kRoughCoverDepth * setup_.meanRadius * plane.axis;
                        boundary_.add(makeRecord(sunk, setup_.meanRadius,
                                                 kFirstBoundaryId + boundaryIds_++),
                                      {static_cast<std::uint32_t>(cover.primitive)});
                    }
                }
            }
        }
    }
}

template <class Real>
void Dem<Real>::step(double dt, bool observe)
{
    SAND_CHECK(listsHold_, "step without valid contact lists");
    if (observe) {
        mobile_.load.resize(mobile_.size());
    }
    StepInput<Real> input;
    input.source = {mobile_.record.data(), frozen_.records().data(), boundary_.records().data()};
    input.walls = setup_.primitives;
    input.gravity = setup_.gravity;
    input.dt = dt;
    const ForceKernel<Real>& kernel = observe ? *observingKernel_ : *kernel_;

    const ChunkTurns turns(lists_.chunkCount());
    // One chunk is not worth waking the other threads for.
#pragma omp parallel for schedule(dynamic, 1) if (turns.count() > 1)
    for (std::int64_t t = 0; t < turns.count(); ++t) {
        for (std::uint32_t c = turns.begin(t); c < turns.begin(t + 1); ++c) {
            kernel.stepChunk(c, input, mobile_, lists_, reports_[c]);
        }
    }
    mobile_.record.swap(mobile_.next);

    float fastest = 0, deepest = 0;
    for (const ChunkReport& report : reports_) {
        fastest = std::max(fastest, report.fastestSquared);
        deepest = std::max(deepest, report.deepestOverlap);
        wakeRequests_.insert(wakeRequests_.end(), report.wake.begin(), report.wake.end());
        if (report.broke) {
            const GrainRecord<Real>& g = mobile_.next[report.brokenGrain];
            throw PhysicsError(fmt::format(
                "grain {} at ({:.4g}, {:.4g}, {:.4g}) m was thrown far beyond its reach within one "
                "step of {:.3g} s (deepest overlap {:.3g} mean radii): the step is too large or "
                "grains were put into each other; lower time.step_safety or check the emitters",
                g.id, g.x, g.y, g.z, dt, deepest / setup_.meanRadius));
        }
    }
    followStrays();
    fastestSpeed_ = std::sqrt(static_cast<double>(fastest));
    latestOverlap_ = static_cast<double>(deepest);
    deepestOverlap_ = std::max(deepestOverlap_, latestOverlap_);
}

/// Grains that left their balls in the last step are searched alone. When they become many, or reach
/// ground that is not covered yet, everybody's lists are due.
template <class Real>
void Dem<Real>::followStrays()
{
    const std::size_t most = 64 + mobile_.size() / 25;
    for (std::size_t c = 0; c < reports_.size(); ++c) {
        for (const std::uint16_t left : reports_[c].left) {
            const auto slot = static_cast<std::uint32_t>(c * kChunkSize + left);
            if (lists_.strayCount() >= most ||
                !hasRoomFor(lists_.ballAhead(mobile_.record[slot]))) {
                listsHold_ = false;
                return;
            }
            lists_.followStray(slot, mobile_, frozen_, boundary_, setup_.primitives, listTime_);
            ++strays_;
        }
    }
}

/// True if every patch of rough solids within `range` of the point has been made.
template <class Real>
bool Dem<Real>::isCovered(const Vec3& centre, double range) const
{
    return std::all_of(covers_.begin(), covers_.end(), [&](const Cover& cover) {
        const Primitive& plane = setup_.primitives[cover.primitive];
        const double height = plane.axis.dot(centre - plane.point);
        if (!plane.existsAt(listTime_) || height > range + setup_.meanRadius) {
            return true;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const double side = range + cover.cover.jitter();
            const Vec3 offset((corner & 1) ? side : -side, (corner & 2) ? side : -side,
                              (corner & 4) ? side : -side);
            const auto [u, v] = cover.cover.patchOf(centre + offset);
            if (!cover.made.find(packCellKey(u, v, 0))) {
                return false;
            }
        }
        return true;
    });
}

template <class Real>
std::uint64_t Dem<Real>::listedPairs() const
{
    std::uint64_t sum = 0;
    for (const auto& chunk : lists_.chunks()) {
        sum += chunk.own.size() + chunk.foreign.size() + chunk.walls.size();
    }
    return sum;
}

template <class Real>
std::size_t Dem<Real>::bytes() const
{
    return (mobile_.record.capacity() + mobile_.next.capacity()) * sizeof(GrainRecord<Real>) +
           mobile_.row.capacity() * sizeof(std::uint32_t) +
           mobile_.memory.capacity() * sizeof(GrainMemory) +
           mobile_.load.capacity() * sizeof(GrainLoad) + lists_.bytes() + book_.bytes() +
           frozen_.bytes() + boundary_.bytes();
}

template class Dem<float>;
template class Dem<double>;

}  // namespace sandflow
