#pragma once

#include "dem/contact_coefficients.h"
#include "grains/snapshot.h"
#include "scene/repose_angle.h"
#include "scene/scene.h"
#include "solids/solid_set.h"
#include "transfer/matter_transfer.h"

#include <memory>
#include <string>

namespace sandflow {

/// Where every grain is. emitted = mobile + interface + buried + exited, always; asleep is part of
/// mobile.
struct Ledger {
    std::uint64_t emitted = 0;
    std::uint64_t mobile = 0;
    std::uint64_t asleep = 0;
    std::uint64_t interface = 0;
    std::uint64_t buried = 0;
    std::uint64_t exited = 0;

    bool balances() const { return emitted == mobile + interface + buried + exited; }
};

/// What one frame did and cost.
struct FrameReport {
    std::uint64_t frame = 0;
    double time = 0.0;            ///< s, at its end
    std::uint64_t steps = 0;
    double dtMin = 0.0, dtMean = 0.0;   ///< s
    Ledger ledger;
    double deepestOverlap = 0.0;  ///< m, deepest seen in the frame
    double kineticEnergy = 0.0;   ///< J, at its end
    TransferReport transfer;
    std::uint64_t heldBack = 0;   ///< grains that wait because their place is taken
    std::uint64_t rebuilds = 0;
    std::uint64_t grainSteps = 0;     ///< sum over steps of the grains computed
    std::uint64_t skippedGrainSteps = 0;  ///< ... of grains there but not computed
    struct Seconds {
        double surfaceFlow = 0, transfer = 0, rebuild = 0, forces = 0, emit = 0;
    } seconds;                    ///< wall time per stage
};

/// What a run would be like, without running it; and what its numbers rest on.
struct RunPlan {
    ContactCoefficients law;
    StiffnessReport stiffness;
    StepReport step;              ///< at the load expected
    LoadCase load;
    ReposeReport repose;
    std::uint64_t grains = 0;
    double endTime = 0.0;         ///< s
    std::uint64_t frames = 0;
    double framePeriod = 0.0;     ///< s
};

/// Reads the scene's numbers; throws InputError for what cannot work. Meshes count by their boxes.
RunPlan planRun(const Scene& scene, std::span<const Eigen::AlignedBox3d> meshBounds = {});

/// A run: all state of the sand. Deterministic: the same scene and seed give the same bits on any
/// number of threads.
class Simulation {
public:
    virtual ~Simulation() = default;

    /// Runs to the next frame. Throws PhysicsError when the physics broke.
    virtual FrameReport advanceFrame() = 0;
    virtual bool finished() const = 0;

    /// Sets all sand free, for good: from now on every grain is mobile and computed, as in dem mode,
    /// and no new ones come. In dem mode, where all are, the springs of all contacts are wiped
    /// instead, which frozen grains have lost too. The frames after that may go beyond finished().
    virtual void releaseAll() = 0;
    virtual const RunPlan& plan() const = 0;
    virtual const SolidSet& solids() const = 0;
    virtual Ledger ledger() const = 0;

    /// Every grain in the domain, ascending by id.
    virtual void takeSnapshot(Snapshot& out) const = 0;

    /// Fingerprint of the grains' whole state.
    virtual std::uint64_t stateHash() const = 0;

    /// Grain centres below a plane or inside a filled solid or a mesh: must be 0. Grains that do
    /// not move cannot leak: of the mobile ones only.
    virtual std::uint64_t countLeaks() const = 0;

    virtual std::size_t bytesMobile() const = 0;  ///< all of step 3, the next included
    virtual std::size_t bytesCover() const = 0;   ///< particles of rough solids
    virtual std::size_t bytesBuried() const = 0;
};

std::unique_ptr<Simulation> makeSimulation(const Scene& scene);

}  // namespace sandflow
