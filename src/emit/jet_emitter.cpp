#include "emit/jet_emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "emit/ballistic.h"
#include "emit/grain_sizes.h"
#include "emit/refusal.h"
#include "emit/state_bytes.h"

namespace sandflow {

namespace {

/// A layer no denser than the trials' worst succeeds nearly every time, so this many failures in a
/// row do not happen.
constexpr int kMostRetries = 1000;

constexpr std::uint32_t kStateTag = 0x314a4645;  // "EFJ1"

Opening makeOpening(const Scene& scene, std::size_t index)
{
    const EmitterSpec& spec = scene.emitters[index];
    const double widest = 2.0 * largestRadius(scene.grains);
    Opening opening;
    opening.round = spec.kind == EmitterKind::jet;
    opening.radius = spec.radius;
    opening.size = spec.size;
    if (!(2.0 * opening.halfSize().minCoeff() >= widest)) {
        refuseEmitter(scene, index,
                      fmt::format("the opening is narrower than the largest grain; make {} at "
                                  "least {:.4g} m",
                                  opening.round ? "radius" : "both sizes",
                                  opening.round ? 0.5 * widest : widest));
    }
    return opening;
}

/// Horizontal axis of an opening that faces `direction`; x when every horizontal would do.
Vec3 chooseWidthAxis(const Vec3& direction)
{
    const Vec3 across = Vec3::UnitZ().cross(direction);
    return across.norm() > 1e-9 ? across.normalized() : Vec3::UnitX();
}

}  // namespace

JetEmitter::JetEmitter(const Scene& scene, std::size_t index)
    : label_(emitterLabel(scene, index)),
      grains_(scene.grains),
      clock_(makeLayerClock(scene, index)),
      opening_(makeOpening(scene, index)),
      gravity_(scene.gravity),
      sizes_(scene.seed, index, RandomUse::sizes),
      places_(scene.seed, index, RandomUse::places)
{
    const EmitterSpec& spec = scene.emitters[index];
    if (std::abs(spec.direction.norm() - 1.0) > 1e-6) {
        refuseEmitter(scene, index, "direction must be a unit vector");
    }
    centre_ = spec.position;
    velocity_ = spec.direction * spec.speed;
    widthAxis_ = chooseWidthAxis(spec.direction);
    heightAxis_ = spec.direction.cross(widthAxis_);

    // A layer holds perLayer grains rounded up or down, never more than the count.
    const double fullest = std::min(std::ceil(clock_.perLayer), static_cast<double>(spec.count));
    Random trial(scene.seed, index, RandomUse::trial);
    const std::int64_t capacity = layerCapacity(opening_, grains_, fullest, trial);
    if (fullest > static_cast<double>(capacity)) {
        refuseEmitter(
            scene, index,
            fmt::format("a rate of {:.6g} grains/s does not fit through the opening at "
                        "{:.4g} m/s without overlap; the largest that fits is {:.4g}: "
                        "lower rate, or raise speed or {}",
                        spec.rate, spec.speed, static_cast<double>(capacity) / clock_.interval,
                        opening_.round ? "radius" : "size"));
    }
}

double JetEmitter::nextTime() const
{
    // A layer without a grain (a slow rate) is no batch.
    return emitted_ < clock_.count ? clock_.dueTime(clock_.layerOf(emitted_ + 1))
                                   : std::numeric_limits<double>::infinity();
}

void JetEmitter::emit(double now, std::vector<NewGrain>& out)
{
    SAND_CHECK(emitted_ < clock_.count, "{}nothing left to emit", label_);
    const std::int64_t layer = clock_.layerOf(emitted_ + 1);
    const double delay = now - clock_.dueTime(layer);
    SAND_CHECK(delay >= 0.0, "{}asked at {} s for a layer due {} s later", label_, now, -delay);

    // Sizes come first and from their own stream: retries must not favour small grains.
    std::vector<double> radii(static_cast<std::size_t>(clock_.emittedAfter(layer + 1) - emitted_));
    for (double& radius : radii) {
        radius = drawRadius(grains_, sizes_);
    }
    std::vector<Vec2> centres;
    int retries = 0;
    while (placeLayer(opening_, radii, places_, centres) < radii.size()) {
        if (++retries > kMostRetries) {
            throw InputError(
                fmt::format("{}{} grains do not fit into one layer of the opening; "
                            "lower rate a little",
                            label_, radii.size()));
        }
    }
    for (std::size_t k = 0; k < radii.size(); ++k) {
        NewGrain grain;
        grain.position = centre_ + widthAxis_ * centres[k].x() + heightAxis_ * centres[k].y();
        grain.velocity = velocity_;
        grain.radius = radii[k];
        flyOn(gravity_, delay, grain);
        out.push_back(grain);
    }
    emitted_ += static_cast<std::int64_t>(radii.size());
}

std::vector<std::uint8_t> JetEmitter::saveState() const
{
    StateWriter writer;
    writer.put(kStateTag);
    writer.put(clock_.count);
    writer.put(emitted_);
    writer.putBlob(sizes_.saveState());
    writer.putBlob(places_.saveState());
    return writer.take();
}

void JetEmitter::loadState(const std::vector<std::uint8_t>& bytes)
{
    try {
        StateReader reader(bytes);
        const bool mine =
            reader.get<std::uint32_t>() == kStateTag && reader.get<std::int64_t>() == clock_.count;
        const auto emitted = reader.get<std::int64_t>();
        const std::vector<std::uint8_t> sizes = reader.getBlob();
        const std::vector<std::uint8_t> places = reader.getBlob();
        if (mine && reader.atEnd() && emitted >= 0 && emitted <= clock_.count) {
            sizes_.loadState(sizes);
            places_.loadState(places);
            emitted_ = emitted;
            return;
        }
    } catch (const std::out_of_range&) {
        // Too short: refused below like every other foreign state.
    }
    throw InputError(label_ + "the saved state belongs to another emitter; start the run afresh");
}

}  // namespace sandflow
