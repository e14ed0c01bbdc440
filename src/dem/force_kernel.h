#pragma once

#include "dem/contact_coefficients.h"
#include "dem/contact_lists.h"
#include "dem/kernel_target.h"

#include <array>
#include <memory>
#include <span>

namespace sandflow {

/// What one step over one chunk reports.
struct ChunkReport {
    float deepestOverlap = 0;      ///< m
    float fastestSquared = 0;      ///< m2/s2
    std::vector<std::uint16_t> left;  ///< slots within the chunk of the grains that left their balls
    bool broke = false;            ///< a position is no longer a number, or overlap is beyond reason
    std::uint32_t brokenGrain = 0; ///< slot, if broke
    std::vector<std::uint32_t> wake;  ///< frozen grains (index) pushed harder than they stand
};

/// Everything a step reads, gathered once per step.
template <class Real>
struct StepInput {
    std::array<const GrainRecord<Real>*, kPartnerSources> source;  ///< by PartnerSource
    std::span<const Primitive> walls;
    Vec3 gravity = Vec3::Zero();
    double dt = 0.0;  ///< s
};

/// Forces on the grains of a chunk, then their motion over dt (symplectic Euler):
///     v += dt (F / m + g),  omega += dt T / I,  x += dt v.
/// Reads mobile.record of everybody, writes mobile.next of this chunk only.
template <class Real>
class ForceKernel {
public:
    virtual ~ForceKernel() = default;
    virtual void stepChunk(std::uint32_t chunk, const StepInput<Real>& input,
                           MobileGrains<Real>& mobile, ContactLists<Real>& lists,
                           ChunkReport& report) const = 0;
};

/// The kernel for this law, compiled without what the law does not have (no rolling friction: no
/// rolling code). `observe` also fills mobile.load. Throws InputError for a target that this
/// processor cannot run. In double every target is the scalar one.
template <class Real>
std::unique_ptr<ForceKernel<Real>> makeForceKernel(const ContactCoefficients& law, bool observe,
                                                   KernelTarget target = KernelTarget::best);
template <>
std::unique_ptr<ForceKernel<float>> makeForceKernel(const ContactCoefficients&, bool, KernelTarget);
template <>
std::unique_ptr<ForceKernel<double>> makeForceKernel(const ContactCoefficients&, bool,
                                                     KernelTarget);

}  // namespace sandflow
