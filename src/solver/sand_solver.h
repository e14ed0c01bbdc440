#pragma once

#include "bcre/evolve.h"
#include "bcre/surface_height.h"
#include "dem/dem.h"
#include "emit/emitter.h"
#include "grains/buried_grains.h"
#include "solver/overlap_guard.h"
#include "solver/simulation.h"
#include "transfer/base_slip.h"
#include "transfer/bed_creep.h"
#include "transfer/bed_settling.h"
#include "transfer/matter_transfer.h"

#include <memory>
#include <span>
#include <vector>

namespace sandflow {

/// The loop of the method. In dem mode only step 3 is left: every grain is mobile.
template <class Real>
class SandSolver final : public Simulation {
public:
    explicit SandSolver(const Scene& scene);

    FrameReport advanceFrame() override;
    bool finished() const override { return frame_ >= plan_.frames; }
    void releaseAll() override;
    const RunPlan& plan() const override { return plan_; }
    const SolidSet& solids() const override { return solids_; }
    Ledger ledger() const override;
    void takeSnapshot(Snapshot& out) const override;
    std::uint64_t stateHash() const override;
    std::uint64_t countLeaks() const override;
    std::size_t bytesMobile() const override { return dem_.bytes(); }
    std::size_t bytesCover() const override { return dem_.boundary().bytes(); }
    std::size_t bytesBuried() const override { return buried_.bytes(); }

private:
    void advanceWindow(double end, FrameReport& report);
    void separateLayers(double interval, FrameReport& report);
    std::span<const std::uint8_t> slippingBases();
    void measureSurface();
    void moveGrains(double end, FrameReport& report);
    void rebuildLists(FrameReport& report);
    void admitNewGrains();
    void dropExited();
    void settleNewBeds();
    void solidsCameOrWent();
    double stableStepNow() const;
    double nextEmission() const;

    Scene scene_;
    SolidSet solids_;
    RunPlan plan_;
    Dem<Real> dem_;
    BuriedGrains buried_;
    ColumnGrid columns_;
    SurfaceHeightMeter meter_;
    BcreParams bcre_;
    RestRules rest_;
    MatterTransfer<Real> transfer_;
    BaseSlip baseSlip_;
    BedCreep<Real> creep_;
    BedSettling settling_;
    ImpactWatch impacts_;
    std::vector<AccumulatedGrain> accumulated_;

    std::vector<std::unique_ptr<Emitter>> emitters_;
    std::vector<NewGrain> waiting_, admitted_;
    OverlapGuard<Real> guard_;
    bool separates_;         ///< steps 1 and 2 are done: surface flow, until all sand is released
    bool newBeds_ = false;   ///< settled sand came in and its columns do not know it yet

    double time_ = 0.0;
    double windowStart_ = 0.0;     ///< s, when steps 1 and 2 were last due
    double solidsKnownAt_ = 0.0;   ///< s, when the columns were last cut by the solids
    std::uint64_t frame_ = 0;
    std::uint32_t nextId_ = 0;
    std::uint64_t exited_ = 0;
};

}  // namespace sandflow
