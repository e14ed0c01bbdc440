#include "emit/batch_emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "emit/ballistic.h"
#include "emit/block.h"
#include "emit/grain_sizes.h"
#include "emit/refusal.h"
#include "emit/state_bytes.h"
#include "solids/rough_cover.h"

namespace sandflow {

namespace {

constexpr std::uint32_t kStateTag = 0x31424645;  // "EFB1"

/// A fill with a larger share of its box than this is packed at once to see whether it fits.
constexpr double kSurelyFits = 0.25;

/// So is one in a box of fewer radii than this, where walls keep grains out.
constexpr double kNarrow = 12.0;

/// Slopes, degrees, that dropping and rolling builds to within a grain or two.
constexpr double kFlattestPile = 1.0;
constexpr double kSteepestPile = 50.0;

/// Columns of cells that the packing's grid may have.
constexpr double kMostColumns = 1e8;

/// The level settled sand stands on when asked to stand at z. A level plane there that is covered
/// with fixed grains has bumps a little above it; sand starts on top of them.
double standingLevel(const Scene& scene, const EmitterSpec& spec, double z)
{
    double level = z;
    for (const SolidSpec& solid : scene.solids) {
        const bool isFloor = solid.shape == SolidShape::plane && solid.rough &&
                             solid.normal.z() > 0.999 * solid.normal.norm() &&
                             solid.from <= spec.start && spec.start < solid.until;
        if (isFloor && std::abs(solid.point.z() - z) <= scene.grains.radius) {
            level = std::max(level,
                                        solid.point.z() + (1.0 - kRoughCoverDepth) *
                                                              scene.grains.radius);
        }
    }
    return level;
}

void checkBox(const Scene& scene, std::size_t index, double floor)
{
    const EmitterSpec& spec = scene.emitters[index];
    const double widest = 2.0 * largestRadius(scene.grains);
    Vec3 size = spec.max - spec.min;
    size.z() = spec.max.z() - floor;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] >= widest * (1.0 - 1e-12)) || !std::isfinite(size[axis])) {
            refuseEmitter(scene, index,
                          fmt::format("the box is {:.4g} m along {}, less than the largest grain "
                                      "({:.4g} m); move min and max apart",
                                      size[axis], "xyz"[axis], widest));
        }
    }
}

}  // namespace

BatchEmitter::BatchEmitter(const Scene& scene, std::size_t index)
    : label_(emitterLabel(scene, index)),
      spec_(scene.emitters.at(index)),
      grains_(scene.grains),
      gravity_(scene.gravity),
      seed_(scene.seed),
      index_(index)
{
    switch (spec_.kind) {
        case EmitterKind::block:
            checkBlock(scene, index);
            break;
        case EmitterKind::fill:
            checkFill(scene, index);
            break;
        case EmitterKind::pile:
            checkPile(scene, index);
            break;
        case EmitterKind::single:
            if (spec_.grainRadius && !(*spec_.grainRadius > 0.0)) {
                refuseEmitter(
                    scene, index,
                    fmt::format("the radius must be positive (m), not {}", *spec_.grainRadius));
            }
            planned_ = 1;
            break;
        case EmitterKind::jet:
        case EmitterKind::slot:
            SAND_CHECK(false, "{}a jet is no batch", label_);
    }
}

void BatchEmitter::checkBlock(const Scene& scene, std::size_t index) const
{
    checkBox(scene, index, spec_.min.z());
    if (spec_.count < 1) {
        refuseEmitter(scene, index, fmt::format("count must be at least 1, not {}", spec_.count));
    }
    const std::int64_t most = blockCapacity(spec_.min, spec_.max, largestRadius(grains_));
    if (spec_.count > most) {
        refuseEmitter(scene, index,
                      fmt::format("{} grains do not fit into the box without overlap, at most {} "
                                  "do; lower count or enlarge the box",
                                  spec_.count, most));
    }
    planned_ = spec_.count;
}

void BatchEmitter::checkFill(const Scene& scene, std::size_t index)
{
    floor_ = standingLevel(scene, spec_, spec_.min.z());
    checkBox(scene, index, floor_);
    if (spec_.count < 0) {
        refuseEmitter(scene, index,
                      fmt::format("count must be 0 (as many as fit) or more, not {}", spec_.count));
    }
    const Vec3 size(spec_.max.x() - spec_.min.x(), spec_.max.y() - spec_.min.y(),
                    spec_.max.z() - floor_);
    const double cell = 2.0 * largestRadius(grains_);
    if (size.x() * size.y() / (cell * cell) > kMostColumns) {
        refuseEmitter(scene, index,
                      fmt::format("the box is {:.3g} x {:.3g} m wide, too much for grains of "
                                  "{:.3g} m; make it smaller",
                                  size.x(), size.y(), grains_.radius));
    }
    if (spec_.count == 0) {
        return;
    }
    const double share = static_cast<double>(spec_.count) * meanGrainVolume(grains_) / size.prod();
    const bool isDoubtful = share > kSurelyFits || size.minCoeff() < kNarrow * grains_.radius;
    if (share > 1.0) {
        refuseEmitter(scene, index,
                      fmt::format("{} grains have {:.3g} times the volume of the box; lower count "
                                  "(0 fills the box) or enlarge the box",
                                  spec_.count, share));
    }
    if (isDoubtful) {
        pack();
        if (*planned_ < spec_.count) {
            refuseEmitter(scene, index,
                          fmt::format("{} grains do not fit into the box, at most {} do; lower "
                                      "count (0 fills the box) or enlarge the box",
                                      spec_.count, *planned_));
        }
    }
    planned_ = spec_.count;
}

void BatchEmitter::checkPile(const Scene& scene, std::size_t index)
{
    floor_ = standingLevel(scene, spec_, spec_.position.z());
    if (spec_.count < 1) {
        refuseEmitter(scene, index, fmt::format("count must be at least 1, not {}", spec_.count));
    }
    if (!(spec_.slopeAngle >= kFlattestPile && spec_.slopeAngle <= kSteepestPile)) {
        refuseEmitter(scene, index,
                      fmt::format("slope_angle must lie between {} and {} degrees, not {}",
                                  kFlattestPile, kSteepestPile, spec_.slopeAngle));
    }
    planned_ = spec_.count;
}

void BatchEmitter::pack() const
{
    if (spec_.kind == EmitterKind::fill) {
        const Vec3 low(spec_.min.x(), spec_.min.y(), floor_);
        packed_ = packBox(low, spec_.max, spec_.count, grains_, seed_, index_);
    } else {
        const Vec3 foot(spec_.position.x(), spec_.position.y(), floor_);
        packed_ = packCone(foot, spec_.slopeAngle, spec_.count, grains_, seed_, index_);
    }
    const auto got = static_cast<std::int64_t>(packed_->size());
    // What was promised is what must come.
    if (planned_ && got != *planned_) {
        throw InputError(fmt::format("{}only {} of {} grains could be settled; lower count{}",
                                     label_, got, *planned_,
                                     spec_.kind == EmitterKind::pile ? " or slope_angle" : ""));
    }
    planned_ = got;
}

double BatchEmitter::nextTime() const
{
    return done_ ? std::numeric_limits<double>::infinity() : spec_.start;
}

std::int64_t BatchEmitter::planned() const
{
    if (!planned_) {
        pack();
    }
    return *planned_;
}

void BatchEmitter::emit(double now, std::vector<NewGrain>& out)
{
    const double delay = now - spec_.start;
    SAND_CHECK(!done_, "{}nothing left to emit", label_);
    SAND_CHECK(delay >= 0.0, "{}asked at {} s for a batch due {} s later", label_, now, -delay);
    const std::size_t before = out.size();
    if (spec_.kind == EmitterKind::single) {
        NewGrain grain;
        grain.position = spec_.position;
        grain.radius = spec_.grainRadius.value_or(grains_.radius);
        grain.spin = spec_.spin;
        out.push_back(grain);
    } else if (spec_.kind == EmitterKind::block) {
        Random sizes(seed_, index_, RandomUse::sizes);
        Random places(seed_, index_, RandomUse::places);
        fillBlock(spec_.min, spec_.max, spec_.count, grains_, sizes, places, out);
    } else {
        if (!packed_) {
            pack();
        }
        out.insert(out.end(), packed_->begin(), packed_->end());
        packed_.reset();
    }
    for (std::size_t k = before; k < out.size() && !out[k].settled; ++k) {
        out[k].velocity = spec_.velocity;
        flyOn(gravity_, delay, out[k]);
    }
    done_ = true;
}

std::vector<std::uint8_t> BatchEmitter::saveState() const
{
    StateWriter writer;
    writer.put(kStateTag);
    writer.put(static_cast<std::uint8_t>(done_));
    writer.put(planned_.value_or(-1));
    return writer.take();
}

void BatchEmitter::loadState(const std::vector<std::uint8_t>& bytes)
{
    try {
        StateReader reader(bytes);
        const bool mine = reader.get<std::uint32_t>() == kStateTag;
        const bool done = reader.get<std::uint8_t>() != 0;
        const auto planned = reader.get<std::int64_t>();
        const bool agrees = planned < 0 ? !done && !planned_ : !planned_ || *planned_ == planned;
        if (mine && reader.atEnd() && agrees) {
            done_ = done;
            if (planned >= 0) {
                planned_ = planned;
            }
            if (done) {
                packed_.reset();
            }
            return;
        }
    } catch (const std::out_of_range&) {
        // Too short: refused below like every other foreign state.
    }
    throw InputError(label_ + "the saved state belongs to another emitter; start the run afresh");
}

}  // namespace sandflow
