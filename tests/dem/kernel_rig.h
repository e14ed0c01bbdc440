#pragma once

#include "core/errors.h"
#include "dem/force_kernel.h"

#include <omp.h>

/// A force kernel with its lists and nothing else: the caller says which target, and steps.
namespace sandflow::rig {

struct NoInfo {};

template <class Real>
struct KernelRig {
    static constexpr double kCell = 0.02;  ///< m
    static constexpr double kSkin = 0.001;

    explicit KernelRig(const ContactCoefficients& law, KernelTarget target = KernelTarget::best)
        : lists(kCell, kSkin, 0.006),
          kernel(makeForceKernel<Real>(law, false, target)),
          observing(makeForceKernel<Real>(law, true, target))
    {
        omp_set_num_threads(1);  // for a handful of grains, a team costs more than it gives
    }

    static GrainRecord<Real> makeRecord(const Vec3& at, double radius, double density,
                                        std::uint32_t id)
    {
        GrainRecord<Real> g;
        g.x = at.x(), g.y = at.y(), g.z = at.z();
        g.radius = static_cast<Real>(radius);
        g.inverseMass =
            density > 0.0 ? static_cast<Real>(0.75 / (kPi * density * radius * radius * radius))
                          : Real(0);
        g.id = id;
        return g;
    }

    GrainRecord<Real>& add(const Vec3& at, double radius, double density = 2600.0)
    {
        mobile.add(makeRecord(at, radius, density, static_cast<std::uint32_t>(mobile.size())));
        return mobile.record.back();
    }

    void addFrozen(const Vec3& at, double radius, std::uint32_t id, float wakeForce)
    {
        GrainRecord<Real> g = makeRecord(at, radius, 0.0, id);
        g.wakeForce = wakeForce;
        frozen.add(g, {});
    }

    void rebuild()
    {
        book.record(lists.chunks(), mobile.record, frozen.records(), boundary.records());
        for (std::uint32_t k = 0; k < mobile.size(); ++k) {
            mobile.row[k] = k;
        }
        lists.rebuild(24.0 * dt, mobile, frozen, boundary, walls, 0.0, book,
                      [](const SortedCells&) {});
        mobile.next.resize(mobile.size());
        mobile.load.resize(mobile.size());
        hold = true;
        ++rebuilds;
    }

    void step(bool observe = false)
    {
        if (!hold) {
            rebuild();
        }
        StepInput<Real> input;
        input.source = {mobile.record.data(), frozen.records().data(), boundary.records().data()};
        input.walls = walls;
        input.gravity = gravity;
        input.dt = dt;
        reports.resize(lists.chunkCount());
        for (std::uint32_t c = 0; c < lists.chunkCount(); ++c) {
            (observe ? observing : kernel)->stepChunk(c, input, mobile, lists, reports[c]);
            hold = hold && reports[c].left.empty();
        }
        mobile.record.swap(mobile.next);
    }

    /// Slots move at every rebuild; ids do not.
    const GrainRecord<Real>& grain(std::uint32_t id) const
    {
        for (const GrainRecord<Real>& g : mobile.record) {
            if (g.id == id) {
                return g;
            }
        }
        throw InternalError("no such grain");
    }

    MobileGrains<Real> mobile;
    FixedGrains<Real, NoInfo> frozen{kCell}, boundary{kCell};
    ContactLists<Real> lists;
    ContactBook<Real> book;
    std::unique_ptr<ForceKernel<Real>> kernel, observing;
    std::vector<Primitive> walls;
    std::vector<ChunkReport> reports;
    Vec3 gravity = Vec3::Zero();
    double dt = 1e-5;
    bool hold = false;
    int rebuilds = 0;
};

inline ContactCoefficients makeLaw(NormalLaw law, bool rolls)
{
    ContactCoefficients c;
    c.law = law;
    c.stiffness = law == NormalLaw::linear ? 2000.0 : 2e5;
    c.damping = law == NormalLaw::bellYuMucha ? 2e-3 : 0.35;
    c.friction = 0.5;
    c.tangentialRatio = 2.0 / 7.0;
    c.tangentialDamping = 0.5;
    c.rollingFriction = rolls ? 0.1 : 0.0;
    c.rollingStiffness = 0.3;
    c.rollingDamping = 0.3;
    return c;
}

inline Vec3 positionOf(const auto& g)
{
    return Vec3(g.x, g.y, g.z);
}
inline Vec3 velocityOf(const auto& g)
{
    return Vec3(g.vx, g.vy, g.vz);
}
inline Vec3 spinOf(const auto& g)
{
    return Vec3(g.wx, g.wy, g.wz);
}

}  // namespace sandflow::rig
