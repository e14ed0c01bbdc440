#include "app/scene_doubts.h"

#include "app/flight_path.h"
#include "core/random.h"
#include "emit/emitter.h"
#include "emit/layer.h"
#include "emit/layer_clock.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// A jet may use this share of what fits before its rate is doubted.
constexpr double kNearlyFull = 0.9;

/// Below this restitution the dashpot rules the step.
constexpr double kDeadRestitution = 0.05;

/// Planes that lean no more than this carry sand (as in flight_path.cpp).
constexpr double kLeastGround = 0.1;

bool isJet(const EmitterSpec& emitter)
{
    return emitter.kind == EmitterKind::jet || emitter.kind == EmitterKind::slot;
}

std::string labelOf(const char* list, std::size_t index, const std::string& name)
{
    return fmt::format("{}[{}]{}", list, index, name.empty() ? "" : fmt::format(" (\"{}\")", name));
}

/// Some of the places where an emitter's grains start, in its middle and near its rim.
std::vector<Vec3> startingPlaces(const EmitterSpec& emitter, const GrainSpec& grains)
{
    const double inset = 1.5 * grains.radius;
    Vec3 centre = emitter.position;
    Vec3 u = Vec3::Zero(), v = Vec3::Zero();  // half extents
    switch (emitter.kind) {
        case EmitterKind::jet:
        case EmitterKind::slot: {
            const Vec3 across = Vec3::UnitZ().cross(emitter.direction);
            const Vec3 width = across.norm() > 1e-9 ? Vec3(across.normalized()) : Vec3::UnitX();
            const Vec2 half = emitter.kind == EmitterKind::jet ? Vec2::Constant(emitter.radius)
                                                               : Vec2(0.5 * emitter.size);
            u = std::max(0.0, half.x() - inset) * width;
            v = std::max(0.0, half.y() - inset) * emitter.direction.cross(width);
            break;
        }
        case EmitterKind::block:
        case EmitterKind::fill: {
            const Vec3 half = (0.5 * (emitter.max - emitter.min)).array() - inset;
            centre = 0.5 * (emitter.min + emitter.max);
            centre.z() = emitter.min.z() + inset;
            u = Vec3(std::max(0.0, half.x()), 0.0, 0.0);
            v = Vec3(0.0, std::max(0.0, half.y()), 0.0);
            break;
        }
        case EmitterKind::pile:
            centre.z() += inset;
            break;
        case EmitterKind::single:
            break;
    }
    return {centre, centre + u, centre - u, centre + v, centre - v};
}

Vec3 startingVelocity(const EmitterSpec& emitter)
{
    if (isJet(emitter)) {
        return emitter.speed * emitter.direction;
    }
    return emitter.kind == EmitterKind::block || emitter.kind == EmitterKind::single
               ? emitter.velocity
               : Vec3(Vec3::Zero());
}

class DoubtFinder {
public:
    DoubtFinder(const Scene& scene, const SolidSet& solids, const RunPlan& plan)
        : scene_(scene), solids_(solids), plan_(plan), doubts_(solids.notices())
    {
    }

    std::vector<std::string> find()
    {
        doubtContact();
        doubtNeutralSlope();
        doubtTime();
        for (std::size_t s = 0; s < scene_.solids.size(); ++s) {
            doubtSolid(s);
        }
        for (std::size_t e = 0; e < scene_.emitters.size(); ++e) {
            doubtRate(e);
            doubtPlace(e);
        }
        return std::move(doubts_);
    }

private:
    template <class... Arguments>
    void doubt(fmt::format_string<Arguments...> sentence, Arguments&&... arguments)
    {
        doubts_.push_back(fmt::format(sentence, std::forward<Arguments>(arguments)...));
    }

    void doubtContact()
    {
        const ContactSpec& contact = scene_.contact;
        if (contact.restitution < kDeadRestitution) {
            doubt(
                "contact.restitution = {}: so strong a dashpot makes the step small; sand that "
                "does not bounce visibly has 0.1 to 0.3",
                contact.restitution);
        }
        if (contact.friction == 0.0) {
            doubt("contact.friction = 0: no heap will stand, the sand runs out like a liquid");
        }
    }

    void doubtNeutralSlope()
    {
        const ReposeReport& repose = plan_.repose;
        if (scene_.mode != Mode::surfaceFlow) {
            return;
        }
        if (!scene_.surfaceFlow.reposeAngle && !repose.measured) {
            doubt("surface_flow.repose_angle is auto, but {}; give a number of degrees",
                  repose.material);
        }
        if (repose.neutralSlope() < repose.expected) {
            doubt(
                "sand settles only on slopes below {:.4g} degrees (surface_flow.repose_angle + "
                "repose_margin), but heaps of this material stand at {:.1f}: their flanks erode "
                "for ever and more sand stays mobile than need be; raise one of the two",
                repose.neutralSlope(), repose.expected);
        }
    }

    void doubtTime()
    {
        const double last = lastEmissionTime(scene_);
        if (plan_.endTime < last) {
            doubt(
                "the run ends at {:.4g} s, but the last grain is due at {:.4g} s: some never "
                "come; raise time.duration",
                plan_.endTime, last);
        }
    }

    void doubtSolid(std::size_t index)
    {
        const SolidSpec& solid = scene_.solids[index];
        const std::string label = labelOf("solids", index, solid.name);
        if (solid.from > plan_.endTime) {
            doubt("{} appears at {:.4g} s, after the end of the run at {:.4g} s", label, solid.from,
                  plan_.endTime);
        }
        const double g = scene_.gravity.norm();
        const Vec3 up = g > 0.0 ? Vec3(-scene_.gravity / g) : Vec3::UnitZ();
        if (solid.shape == SolidShape::plane && !solid.rough &&
            solid.normal.normalized().dot(up) >= kLeastGround) {
            doubt(
                "{} is a smooth floor (rough = false): the lowest grains creep outward all the "
                "time, so heaps on it spread and a heap with a still inside cannot follow",
                label);
        }
    }

    void doubtRate(std::size_t index)
    {
        const EmitterSpec& emitter = scene_.emitters[index];
        if (!isJet(emitter)) {
            return;
        }
        const LayerClock clock = makeLayerClock(scene_, index);
        const double wanted = std::min(clock.perLayer, static_cast<double>(emitter.count));
        Opening opening;
        opening.round = emitter.kind == EmitterKind::jet;
        opening.radius = emitter.radius;
        opening.size = emitter.size;
        Random trial(scene_.seed, index, RandomUse::trial);
        // Asking for more than is needed, the answer is either found by trial or more than that.
        const auto capacity =
            static_cast<double>(layerCapacity(opening, scene_.grains, wanted / kNearlyFull, trial));
        if (wanted > kNearlyFull * capacity) {
            doubt(
                "{}: {:.6g} grains/s is {:.0f} % of the most that fits through the opening; the "
                "jet leaves as dense layers, and grains may have to wait",
                labelOf("emitters", index, emitter.name), emitter.rate, 100.0 * wanted / capacity);
        }
    }

    void doubtPlace(std::size_t index)
    {
        const EmitterSpec& emitter = scene_.emitters[index];
        const std::string label = labelOf("emitters", index, emitter.name);
        const std::vector<Vec3> places = startingPlaces(emitter, scene_.grains);
        if (doubtInside(places, emitter.start, label)) {
            return;  // the flight of grains inside a solid says nothing
        }
        const auto isOutside = [this](const Vec3& p) {
            return (p.array() < scene_.domain.min.array()).any() ||
                   (p.array() > scene_.domain.max.array()).any();
        };
        if (std::any_of(places.begin(), places.end(), isOutside)) {
            doubt("{} lies partly outside the domain: its grains are gone at once", label);
        }
        if (scene_.gravity.norm() == 0.0) {
            return;  // nothing falls
        }
        std::size_t lost = 0;
        std::optional<Impact> fastest;
        for (const Vec3& place : places) {
            const Flight flight =
                followGrain(scene_, solids_, place, startingVelocity(emitter), emitter.start);
            lost += flight.landing ? 0 : 1;
            if (flight.first && (!fastest || flight.first->speed > fastest->speed)) {
                fastest = flight.first;
            }
        }
        if (lost > 0) {
            doubt("{}: {} of its grains fall past every solid: there is no floor below them", label,
                  lost == places.size() ? "all" : "some");
        }
        if (fastest && fastest->speed > 1.01 * plan_.load.fastestSpeed) {
            const auto solid = static_cast<std::size_t>(fastest->solid);
            doubt(
                "{} hits {} at {:.3g} m/s, but the stiffness is made for {:.3g} m/s: grains may "
                "pass through it; give a higher contact.stiffness",
                label, labelOf("solids", solid, scene_.solids[solid].name), fastest->speed,
                plan_.load.fastestSpeed);
        }
    }

    /// True, with a doubt, if any of the places is inside a filled solid.
    bool doubtInside(const std::vector<Vec3>& places, double time, const std::string& label)
    {
        const auto doubtSolidAt = [&](int index, const auto& holds) {
            const auto inside = std::count_if(places.begin(), places.end(), holds);
            if (inside > 0) {
                const auto solid = static_cast<std::size_t>(index);
                doubt("{} lies {}inside {}: grains that start there are held back", label,
                      inside < static_cast<std::ptrdiff_t>(places.size()) ? "partly " : "",
                      labelOf("solids", solid, scene_.solids[solid].name));
            }
            return inside > 0;
        };
        for (const Primitive& primitive : solids_.primitives()) {
            if (primitive.existsAt(time) && doubtSolidAt(primitive.solid, [&](const Vec3& p) {
                    return nearestSurface(primitive, p).distance < 0.0;
                })) {
                return true;
            }
        }
        for (const MeshSolid& mesh : solids_.meshes()) {
            if (mesh.existsAt(time) && doubtSolidAt(mesh.solid, [&](const Vec3& p) {
                    return mesh.columns.contains(p);
                })) {
                return true;
            }
        }
        return false;
    }

    const Scene& scene_;
    const SolidSet& solids_;
    const RunPlan& plan_;
    std::vector<std::string> doubts_;
};

}  // namespace

std::vector<std::string> findDoubts(const Scene& scene, const SolidSet& solids,
                                    const RunPlan& plan)
{
    return DoubtFinder(scene, solids, plan).find();
}

}  // namespace sandflow
