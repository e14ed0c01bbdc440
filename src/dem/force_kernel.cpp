#include "dem/force_kernel.h"

#include "dem/choose_passes.h"
#include "dem/contact_pair.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// What a thread needs while it works on a chunk.
template <class Real>
struct Workspace {
    std::vector<ContactSum<Real>> sums;
    std::vector<std::uint32_t> wake;
    TouchingPairs<Real> touching{};
};

template <class Real>
using WallPass = float (*)(const LawNumbers<double>& numbers, const StepInput<Real>& input,
                           const GrainRecord<Real>* grains, ChunkContacts<Real>& contacts,
                           ContactSum<Real>* sums);

template <class Number>
Vec<double> vecOf(Number x, Number y, Number z)
{
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

/// Adds the forces of analytic walls. Returns the deepest overlap [m]. Few grains touch one, so
/// this is the same code for every target; in double, where one number has a quick root.
template <class Real, NormalLaw law, RollingLaw rolling>
float sumWallContacts(const LawNumbers<double>& numbers, const StepInput<Real>& input,
                      const GrainRecord<Real>* grains, ChunkContacts<Real>& contacts,
                      ContactSum<Real>* sums)
{
    float deepest = 0;
    for (std::size_t w = 0; w < contacts.walls.size(); ++w) {
        auto& wall = contacts.walls[w];
        const std::uint32_t slot = wall.grain;
        const GrainRecord<Real>& g = grains[slot];
        const SurfacePoint surface =
            nearestSurface(input.walls[wall.primitive], Vec3(g.x, g.y, g.z));
        const auto radius = static_cast<double>(g.radius);
        if (surface.distance >= radius) {
            wall.live = false;
            continue;
        }
        ContactGeometry<double> at;
        at.normal = {surface.normal.x(), surface.normal.y(), surface.normal.z()};
        at.overlap = radius - surface.distance;
        at.arm = surface.distance;
        at.partnerArm = 0.0;
        // A flat wall is a partner of infinite radius and mass: R* = R, m* = m.
        at.effectiveRadius = radius;
        at.radiusRatio = 1.0;
        const ContactSide<double> side = {radius, static_cast<double>(g.inverseMass),
                                          vecOf(g.vx, g.vy, g.vz), vecOf(g.wx, g.wy, g.wz)};

        PairHistory<Real>& h = contacts.wallHistory[w];
        ContactSprings<double> springs;
        if (wall.live) {
            springs = {vecOf(h.sx, h.sy, h.sz), vecOf(h.qx, h.qy, h.qz)};
        }
        const ContactForce<double> f = evaluateContact<law, rolling>(
            numbers, at, side, ContactSide<double>{}, input.dt, springs);
        const auto put = [](const Vec<double>& v, Real& x, Real& y, Real& z) {
            x = static_cast<Real>(v.x), y = static_cast<Real>(v.y), z = static_cast<Real>(v.z);
        };
        put(springs.tangential, h.sx, h.sy, h.sz);
        put(springs.rolling, h.qx, h.qy, h.qz);
        wall.live = true;
        deepest = std::max(deepest, static_cast<float>(at.overlap));

        ContactSum<Real>& sum = sums[slot];
        sum.fx += static_cast<Real>(f.force.x), sum.fy += static_cast<Real>(f.force.y);
        sum.fz += static_cast<Real>(f.force.z);
        sum.tx += static_cast<Real>(f.torque.x), sum.ty += static_cast<Real>(f.torque.y);
        sum.tz += static_cast<Real>(f.torque.z);
        sum.load += static_cast<Real>(f.normal);
        sum.partners += f.normal > 0.0 ? Real(1) : Real(0);
    }
    return deepest;
}

template <class Real>
WallPass<Real> findWallPass(NormalLaw law, RollingLaw rolling)
{
    return chooseLaw(law, rolling, []<NormalLaw knownLaw, RollingLaw knownRolling>() {
        return &sumWallContacts<Real, knownLaw, knownRolling>;
    });
}

template <class Real>
void observeLoads(const GrainRecord<Real>* grains, const ContactSum<Real>* sums,
                  std::uint32_t count, const Vec3& gravity, GrainLoad* load)
{
    const Vec<Real> g = {static_cast<Real>(gravity.x()), static_cast<Real>(gravity.y()),
                         static_cast<Real>(gravity.z())};
    for (std::uint32_t i = 0; i < count; ++i) {
        const ContactSum<Real>& sum = sums[i];
        const Vec<Real> net =
            Vec<Real>{sum.fx, sum.fy, sum.fz} + (Real(1) / grains[i].inverseMass) * g;
        load[i] = {static_cast<float>(sum.partners), static_cast<float>(length(net)),
                   static_cast<float>(sum.load)};
    }
}

template <class Real>
class ChunkKernel final : public ForceKernel<Real> {
public:
    ChunkKernel(const ContactCoefficients& law, bool observe, const ChunkPasses<Real>& passes)
        : law_(law),
          numbers_(law),
          observe_(observe),
          passes_(passes),
          wallPass_(findWallPass<Real>(law.law, law.rollingLaw()))
    {
    }

    void stepChunk(std::uint32_t chunk, const StepInput<Real>& input, MobileGrains<Real>& mobile,
                   ContactLists<Real>& lists, ChunkReport& report) const override
    {
        static thread_local Workspace<Real> space;
        const std::uint32_t first = chunk * kChunkSize;
        const GrainRecord<Real>* grains = mobile.record.data() + first;
        ChunkContacts<Real>& contacts = lists.chunks()[chunk];
        space.sums.assign(contacts.grainCount, {});

        report.deepestOverlap = sumGrainContacts(input, grains, contacts, space, report);
        report.deepestOverlap = std::max(
            report.deepestOverlap,
            wallPass_(numbers_, input, grains, contacts, space.sums.data()));
        if (observe_) {
            observeLoads(grains, space.sums.data(), contacts.grainCount, input.gravity,
                         mobile.load.data() + first);
        }
        moveGrains(chunk, input, lists, space, mobile, report);
    }

private:
    float sumGrainContacts(const StepInput<Real>& input, const GrainRecord<Real>* grains,
                           ChunkContacts<Real>& contacts, Workspace<Real>& space,
                           ChunkReport& report) const
    {
        space.wake.resize(contacts.foreign.size());
        ContactWork<Real> work;
        work.law = &law_;
        work.dt = static_cast<Real>(input.dt);
        work.grains = grains;
        std::copy(input.source.begin(), input.source.end(), work.source);
        work.ownCount = static_cast<std::uint32_t>(contacts.own.size());
        work.foreignCount = static_cast<std::uint32_t>(contacts.foreign.size());
        work.own = contacts.own.data();
        work.foreign = contacts.foreign.data();
        work.foreignSlot = contacts.foreignSlot.data();
        work.ownLive = contacts.ownLive.data();
        work.foreignLive = contacts.foreignLive.data();
        work.ownHistory = contacts.ownHistory.data();
        work.foreignHistory = contacts.foreignHistory.data();
        work.touching = &space.touching;
        work.sums = space.sums.data();
        work.wake = space.wake.data();
        passes_.sumContacts(work);
        report.wake.assign(work.wake, work.wake + work.wakeCount);
        return static_cast<float>(work.deepest);
    }

    void moveGrains(std::uint32_t chunk, const StepInput<Real>& input,
                    const ContactLists<Real>& lists, const Workspace<Real>& space,
                    MobileGrains<Real>& mobile, ChunkReport& report) const
    {
        const std::uint32_t first = chunk * kChunkSize;
        MotionWork<Real> work;
        work.dt = input.dt;
        for (int c = 0; c < 3; ++c) {
            work.gravity[c] = input.gravity[c];
            work.origin[c] = lists.origin(chunk)[c];
        }
        work.record = mobile.record.data() + first;
        work.next = mobile.next.data() + first;
        work.ball = &lists.balls()[first].x;
        work.sums = space.sums.data();
        work.count = static_cast<std::uint32_t>(space.sums.size());
        work.brokenGrain = 0;
        report.left.resize(work.count);
        work.left = report.left.data();
        passes_.moveGrains(work);
        report.fastestSquared = work.fastestSquared;
        report.left.resize(work.leftCount);
        report.broke = work.broke;
        report.brokenGrain = first + work.brokenGrain;
    }

    ContactCoefficients law_;
    LawNumbers<double> numbers_;
    bool observe_;
    ChunkPasses<Real> passes_;
    WallPass<Real> wallPass_;
};

}  // namespace

template <>
std::unique_ptr<ForceKernel<float>> makeForceKernel<float>(const ContactCoefficients& law,
                                                           bool observe, KernelTarget target)
{
    return std::make_unique<ChunkKernel<float>>(
        law, observe, choosePasses<float>(target, law.law, law.rollingLaw()));
}

template <>
std::unique_ptr<ForceKernel<double>> makeForceKernel<double>(const ContactCoefficients& law,
                                                             bool observe, KernelTarget)
{
    return std::make_unique<ChunkKernel<double>>(
        law, observe,
        choosePasses<double>(KernelTarget::scalar, law.law, law.rollingLaw()));
}

}  // namespace sandflow
