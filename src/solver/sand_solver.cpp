#include "solver/sand_solver.h"

#include "core/hash.h"
#include "core/stage_clock.h"
#include "transfer/flight_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandflow {
namespace {

/// Grains faster than this are in the air or about to be, not part of the heap (H leaves them out).
constexpr double kAccumulatedSpeed = 0.6;  // m/s
constexpr float kAccumulatedContacts = 2;

/// How far [mean radii] a point of a rough plane may be from its particles: so close that the smallest
/// grain, pressed as deep as the scene allows, keeps its centre above the plane. Else small grains
/// would slip through where sizes differ much.
///
///   gap^2 = (1 + s - overlap s)^2 - depth^2,  s = smallest / mean radius
double roughGapFor(const Scene& scene, const RunPlan& plan)
{
    const double smallest = plan.load.minRadius / scene.grains.radius;
    const double reach = 1.0 + smallest * (1.0 - scene.contact.maxOverlap);
    const double gap = std::sqrt(reach * reach - kRoughCoverDepth * kRoughCoverDepth);
    return std::min(DemSetup().roughGap, gap);
}

DemSetup demSetup(const Scene& scene, const SolidSet& solids, const RunPlan& plan)
{
    DemSetup setup;
    setup.law = plan.law;
    setup.meanRadius = scene.grains.radius;
    setup.largestRadius = plan.load.maxRadius;
    setup.density = scene.grains.density;
    setup.gravity = scene.gravity;
    setup.primitives = solids.primitives();
    for (const MeshSolid& mesh : solids.meshes()) {
        setup.meshCovers.push_back({mesh.from, mesh.until, mesh.cover.points,
                                    kMeshCoverRadius * scene.grains.radius});
    }
    setup.roughGap = roughGapFor(scene, plan);
    setup.seed = scene.seed;
    setup.judged = scene.mode == Mode::surfaceFlow;
    return setup;
}

BcreParams bcreParams(const Scene& scene, const RunPlan& plan)
{
    const SurfaceFlowSpec& spec = scene.surfaceFlow;
    BcreParams params;
    params.exchangeRate = spec.exchangeRate;
    params.reposeAngle = plan.repose.neutralSlope() * kPi / 180.0;
    params.slopeForm = spec.slopeForm;
    params.saturationDepth = spec.saturationDepth.value_or(0.0) * scene.diameter();
    params.minFlowDepth = spec.minFlowDepth * scene.diameter();
    params.maxChange = spec.maxChange * scene.diameter();
    params.transport = spec.transport;
    params.transportSpeed = spec.transportSpeed;
    return params;
}

TransferParams transferParams(const Scene& scene)
{
    TransferParams params;
    params.interfaceThickness = scene.surfaceFlow.interfaceThickness * scene.diameter();
    params.buryClearance = scene.surfaceFlow.buryClearance * scene.diameter();
    params.hysteresis = 0.2 * scene.diameter();
    params.sleep = scene.skip.sleep;
    params.rest = makeRestRules(scene.surfaceFlow);
    return params;
}

CreepParams creepParams(const Scene& scene)
{
    CreepParams params;
    params.diameter = scene.diameter();
    params.decay = scene.surfaceFlow.creepDecay * scene.diameter();
    params.depth = scene.surfaceFlow.creepDepth * scene.diameter();
    return params;
}

SettlingParams settlingParams(const Scene& scene)
{
    SettlingParams params;
    params.depth = scene.surfaceFlow.settleDepth * scene.diameter();
    params.least = 0.2 * scene.diameter();
    return params;
}

template <class Real>
Vec3 positionOf(const GrainRecord<Real>& g)
{
    return {g.x, g.y, g.z};
}

}  // namespace

template <class Real>
SandSolver<Real>::SandSolver(const Scene& scene)
    : scene_(scene),
      solids_(scene),
      plan_(planRun(scene, solids_.meshBounds())),
      dem_(demSetup(scene, solids_, plan_)),
      buried_(scene.surfaceFlow.cellSize * scene.diameter()),
      columns_(
          scene.surfaceFlow.cellSize * scene.diameter(),
          [this](double x, double y, std::vector<ColumnGrid::FreeInterval>& out) {
              std::vector<FreeStretch> free;
              solids_.freeStretches(time_, x, y, columns_.cellSize(), free);
              out.clear();
              for (const FreeStretch& f : free) {
                  out.push_back({f.floor, f.ceiling, f.ragged});
              }
          },
          [this](const Vec2& a, const Vec2& b, double lo, double hi) {
              return solids_.partsColumns(time_, a, b, lo, hi);
          }),
      bcre_(bcreParams(scene, plan_)),
      rest_(makeRestRules(scene.surfaceFlow)),
      transfer_(transferParams(scene)),
      creep_(creepParams(scene)),
      settling_(settlingParams(scene)),
      separates_(scene.mode == Mode::surfaceFlow)
{
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
        emitters_.push_back(makeEmitter(scene, e));
    }
    if (scene.mode == Mode::dem) {  // all will be mobile in the end
        dem_.mobile().reserve(plan_.grains);
    }
}

/// Steps 1 and 2 act once per window, step 3 as often as stability asks.
template <class Real>
FrameReport SandSolver<Real>::advanceFrame()
{
    FrameReport report;
    report.frame = ++frame_;
    report.dtMin = std::numeric_limits<double>::infinity();
    dem_.resetExtremes();
    const double start = static_cast<double>(frame_ - 1) * plan_.framePeriod;
    const int windows = std::max(
        1, static_cast<int>(std::ceil(plan_.framePeriod / scene_.surfaceFlow.interval - 1e-9)));
    for (int w = 1; w <= windows; ++w) {
        advanceWindow(start + plan_.framePeriod * w / windows, report);
    }

    report.time = time_;
    report.dtMean = report.steps > 0 ? report.dtMean / static_cast<double>(report.steps) : 0.0;
    report.dtMin = report.steps > 0 ? report.dtMin : 0.0;
    report.deepestOverlap = dem_.deepestOverlap();
    report.ledger = ledger();
    report.heldBack = waiting_.size();
    for (const GrainRecord<Real>& g : dem_.mobile().record) {
        const double m = 1.0 / static_cast<double>(g.inverseMass), r = static_cast<double>(g.radius);
        const double v2 = static_cast<double>(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz);
        const double w2 = static_cast<double>(g.wx * g.wx + g.wy * g.wy + g.wz * g.wz);
        report.kineticEnergy += 0.5 * m * v2 + 0.2 * m * r * r * w2;
    }
    if (!report.ledger.balances()) {
        throw InternalError(fmt::format(
            "frame {}: the ledger does not balance: {} emitted, {} mobile, {} interface, {} buried, "
            "{} exited",
            frame_, report.ledger.emitted, report.ledger.mobile, report.ledger.interface,
            report.ledger.buried, report.ledger.exited));
    }
    return report;
}

template <class Real>
void SandSolver<Real>::advanceWindow(double end, FrameReport& report)
{
    windowStart_ = time_;
    solidsCameOrWent();
    moveGrains(end, report);  // step 3
    time_ = end;
    if (separates_) {
        separateLayers(end - windowStart_, report);  // steps 1 and 2
    }
}

/// Steps 1 and 2: the height field says how deep sand flows, and grains cross the interface to
/// agree with it.
template <class Real>
void SandSolver<Real>::separateLayers(double interval, FrameReport& report)
{
    {   // 1. H -> h -> dh -> h -> R -> R' -> h', eq. (4)
        StageClock clock(report.seconds.surfaceFlow);
        measureSurface();
        followSurface(columns_);
        settleNewBeds();
        evolveBcre(bcre_, interval, columns_);
        enforceMinFlowDepth(bcre_, columns_);
    }
    {   // 2. Erosion and deposition through the particle interface
        StageClock clock(report.seconds.transfer);
        report.transfer.landedMomentum += endFlights(interval, dem_);
        updateRestClocks(rest_, interval, dem_);
        markWoken(rest_, dem_);
        const std::vector<ImpactZone> zones = impacts_.foresee(interval, columns_, dem_);
        wakeZones(zones, dem_);
        transfer_.plan(columns_, dem_, slippingBases());
        dem_.recordContacts();
        report.transfer += transfer_.apply(columns_, dem_, buried_, zones);
        creep_.carry(columns_, interval, buried_, dem_);
        report.transfer += transfer_.setFreeAbove(
            settling_.endedFlows(columns_, creep_.bedVelocity(), interval), columns_, dem_, buried_);
    }
    rebuildLists(report);
}

template <class Real>
std::span<const std::uint8_t> SandSolver<Real>::slippingBases()
{
    if (scene_.surfaceFlow.freezeOnSmooth) {
        return {};
    }
    return baseSlip_.find(columns_, solids_.primitives(), time_);
}

/// H over all accumulated sand: everything fixed, and mobile grains that lie rather than fly.
template <class Real>
void SandSolver<Real>::measureSurface()
{
    accumulated_.clear();
    for (const GrainRecord<Real>& g : dem_.frozen().records()) {
        accumulated_.push_back({positionOf(g), static_cast<double>(g.radius)});
    }
    for (std::size_t k = 0; k < dem_.mobile().size(); ++k) {
        const GrainRecord<Real>& g = dem_.mobile().record[k];
        const double speed2 = static_cast<double>(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz);
        if (dem_.mobile().load[k].contacts >= kAccumulatedContacts &&
            speed2 < kAccumulatedSpeed * kAccumulatedSpeed) {
            accumulated_.push_back({positionOf(g), static_cast<double>(g.radius)});
        }
    }
    meter_.measure(accumulated_, scene_.diameter(), scene_.surfaceFlow.smoothing, columns_);
}

/// Sand that was put in at rest is static from the start: its bed need not grow from the floor.
template <class Real>
void SandSolver<Real>::settleNewBeds()
{
    if (!newBeds_) {
        return;
    }
    newBeds_ = false;
    for (std::size_t s = 0; s < columns_.spanCount(); ++s) {
        columns_.h[s] = std::max(columns_.floor[s], columns_.H[s] - bcre_.minFlowDepth);
        columns_.R[s] = columns_.H[s] - columns_.h[s];
    }
}

/// Step 3: soft spheres until `end`. The lists are made anew when too many grains have left their
/// balls; grains that come in are put into them.
template <class Real>
void SandSolver<Real>::moveGrains(double end, FrameReport& report)
{
    bool retry = !waiting_.empty();
    while (time_ < end - 1e-12) {
        if (retry || nextEmission() <= time_ || !dem_.listsHold()) {
            StageClock clock(report.seconds.emit);
            if (!dem_.listsHold()) {
                dem_.recordContacts();
                dropExited();
                if (separates_) {
                    report.transfer += transfer_.wakeMarked(columns_, dem_, buried_);
                }
            }
            admitNewGrains();
            retry = false;
        }
        if (!dem_.listsHold()) {
            rebuildLists(report);
        }
        if (dem_.mobile().size() == 0) {  // nothing moves: on to the next emission
            time_ = std::min(end, nextEmission());
            continue;
        }
        const double left = end - time_;
        const double count = std::max(1.0, std::ceil(left / stableStepNow() - 1e-9));
        const double dt = left / count;
        {
            StageClock clock(report.seconds.forces);
            dem_.step(dt, count == 1.0 && separates_);
        }
        time_ += dt;
        ++report.steps;
        report.dtMin = std::min(report.dtMin, dt);
        report.dtMean += dt;
        report.grainSteps += dem_.mobile().size();
        report.skippedGrainSteps += dem_.frozen().size() + buried_.size();
    }
}

template <class Real>
void SandSolver<Real>::rebuildLists(FrameReport& report)
{
    StageClock clock(report.seconds.rebuild);
    dem_.rebuild(time_, stableStepNow());
    ++report.rebuilds;
    if (separates_) {
        judgeNewlyFrozen(rest_, dem_);
    }
}

/// The linear law's step never changes. Hertzian contacts stiffen with overlap: the step follows
/// the deepest overlap there is, or that the fastest grain there is could make.
template <class Real>
double SandSolver<Real>::stableStepNow() const
{
    if (plan_.law.law == NormalLaw::linear || scene_.time.step) {
        return plan_.step.step;
    }
    // Elastic impact on a fixed grain, an upper bound: delta = (5 m v^2 / (4 K sqrt(R*)))^0.4.
    const double r = scene_.grains.radius;
    const double impact =
        std::pow(1.25 * dem_.massOf(plan_.load.maxRadius) * dem_.fastestSpeed() *
                     dem_.fastestSpeed() / (plan_.law.stiffness * std::sqrt(0.5 * r)),
                 0.4);
    const double overlap = std::max({impact, 1.2 * dem_.latestOverlap(), 1e-3 * r});
    return stableStep(plan_.law, plan_.load, overlap, scene_.time.stepSafety, std::nullopt).step;
}

template <class Real>
double SandSolver<Real>::nextEmission() const
{
    double next = std::numeric_limits<double>::infinity();
    for (const auto& emitter : emitters_) {
        next = std::min(next, emitter->nextTime());
    }
    return next;
}

/// New grains, where there is room for them; the others wait. Emitters take turns, so that grains of
/// two of them never enter in each other's place.
template <class Real>
void SandSolver<Real>::admitNewGrains()
{
    const auto admit = [&](std::size_t retries) {
        admitted_.clear();
        guard_.admit(dem_, solids_, time_, retries, waiting_, admitted_);
        for (const NewGrain& g : admitted_) {
            SAND_CHECK(nextId_ < kFirstBoundaryId, "out of grain ids");
            if (g.settled && separates_) {
                dem_.recordContacts();
                dem_.frozen().add(dem_.makeRecord(g.position, g.radius, nextId_++), {});
                newBeds_ = true;
            } else {
                dem_.addMobile(g.position, g.velocity, g.spin, g.radius, nextId_++);
                if (separates_) {
                    startFlight(time_ - windowStart_, dem_);
                }
            }
        }
    };
    admit(waiting_.size());
    for (const auto& emitter : emitters_) {
        const std::size_t retries = waiting_.size();
        while (emitter->nextTime() <= time_) {
            emitter->emit(time_, waiting_);
        }
        if (waiting_.size() > retries) {
            admit(retries);
        }
    }
}

template <class Real>
void SandSolver<Real>::dropExited()
{
    MobileGrains<Real>& mobile = dem_.mobile();
    const Eigen::AlignedBox3d domain(scene_.domain.min, scene_.domain.max);
    exited_ += mobile.size();
    mobile.removeUnless([&](std::size_t k) { return domain.contains(positionOf(mobile.record[k])); });
    exited_ -= mobile.size();
}

/// When a solid appears or vanishes the columns over it are cut anew, and all sand is free again:
/// what held it may be gone. What still rests is frozen again within a few windows.
template <class Real>
void SandSolver<Real>::solidsCameOrWent()
{
    const bool changed = solids_.changesBetween(solidsKnownAt_, time_);
    solidsKnownAt_ = time_;
    if (!changed) {
        return;
    }
    dem_.recordContacts();
    if (separates_) {
        std::vector<std::pair<std::int32_t, std::int32_t>> cut;
        columns_.rebuildSpans(cut);
        creep_ = BedCreep<Real>(creepParams(scene_));  // what they remember is by span
        settling_ = BedSettling(settlingParams(scene_));
        baseSlip_ = BaseSlip();
        transfer_.releaseAll(dem_, buried_);
    }
}

template <class Real>
void SandSolver<Real>::releaseAll()
{
    dem_.recordContacts();
    if (separates_) {
        transfer_.releaseAll(dem_, buried_);
    } else {
        dem_.forgetContacts();
    }
    separates_ = false;
    emitters_.clear();
    waiting_.clear();
}

template <class Real>
Ledger SandSolver<Real>::ledger() const
{
    Ledger out;
    out.emitted = nextId_;
    for (std::size_t k = 0; k < dem_.frozen().size(); ++k) {
        ++(dem_.frozen().info(k).state == GrainState::asleep ? out.asleep : out.interface);
    }
    out.mobile = dem_.mobile().size() + out.asleep;
    out.buried = buried_.size();
    out.exited = exited_;
    return out;
}

template <class Real>
void SandSolver<Real>::takeSnapshot(Snapshot& out) const
{
    const Ledger count = ledger();
    const std::size_t n = count.mobile + count.interface + count.buried;
    out.frame = frame_;
    out.time = time_;
    out.meanRadius = scene_.grains.radius;
    out.emitted = count.emitted;
    out.exited = count.exited;
    // Ids are a range with few gaps: place each grain by its id, then close the gaps.
    constexpr std::uint32_t kNobody = 0xFFFFFFFFu;
    std::vector<std::uint32_t> slotOfId(nextId_, kNobody);
    std::vector<Vec3> position(n);
    std::vector<Vec3f> velocity(n, Vec3f::Zero()), spin(n, Vec3f::Zero());
    std::vector<float> radius(n);
    std::vector<GrainState> state(n);
    std::uint32_t next = 0;
    const auto put = [&](std::uint32_t id, const Vec3& p, double r, GrainState s) {
        slotOfId[id] = next;
        position[next] = p;
        radius[next] = static_cast<float>(r);
        state[next] = s;
        return next++;
    };
    for (const GrainRecord<Real>& g : dem_.mobile().record) {
        const std::uint32_t at =
            put(g.id, positionOf(g), static_cast<double>(g.radius), GrainState::mobile);
        velocity[at] = Vec3f(static_cast<float>(g.vx), static_cast<float>(g.vy),
                             static_cast<float>(g.vz));
        spin[at] = Vec3f(static_cast<float>(g.wx), static_cast<float>(g.wy),
                         static_cast<float>(g.wz));
    }
    for (std::size_t k = 0; k < dem_.frozen().size(); ++k) {
        const GrainRecord<Real>& g = dem_.frozen().record(k);
        put(g.id, positionOf(g), static_cast<double>(g.radius), dem_.frozen().info(k).state);
    }
    buried_.forEach([&](const Vec3& p, double r, std::uint32_t id) {
        put(id, p, r, GrainState::buried);
    });

    out.id.clear(), out.position.clear(), out.velocity.clear(), out.spin.clear();
    out.radius.clear(), out.state.clear();
    for (std::uint32_t id = 0; id < nextId_; ++id) {
        const std::uint32_t at = slotOfId[id];
        if (at == kNobody) {
            continue;
        }
        out.id.push_back(id);
        out.position.push_back(position[at]);
        out.velocity.push_back(velocity[at]);
        out.spin.push_back(spin[at]);
        out.radius.push_back(radius[at]);
        out.state.push_back(state[at]);
    }
}

template <class Real>
std::uint64_t SandSolver<Real>::countLeaks() const
{
    const auto count = static_cast<std::int64_t>(dem_.mobile().size());
    std::uint64_t leaks = 0;
#pragma omp parallel for schedule(static) reduction(+ : leaks)
    for (std::int64_t k = 0; k < count; ++k) {
        leaks += solids_.contains(time_, positionOf(dem_.mobile().record[k])) ? 1 : 0;
    }
    return leaks;
}

template <class Real>
std::uint64_t SandSolver<Real>::stateHash() const
{
    Snapshot all;
    takeSnapshot(all);
    StateHash hash;
    const auto add = [&](const auto& values) {
        hash.add(values.data(), values.size() * sizeof(values[0]));
    };
    hash.addWord(frame_);
    add(all.id), add(all.position), add(all.velocity), add(all.spin), add(all.radius);
    add(all.state), add(columns_.h);
    return hash.value();
}

template class SandSolver<float>;
template class SandSolver<double>;

std::unique_ptr<Simulation> makeSimulation(const Scene& scene)
{
    if (scene.precision == Precision::real64) {
        return std::make_unique<SandSolver<double>>(scene);
    }
    return std::make_unique<SandSolver<float>>(scene);
}

}  // namespace sandflow
