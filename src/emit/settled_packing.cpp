#include "emit/settled_packing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/errors.h"
#include "core/random.h"
#include "emit/drop_and_roll.h"
#include "emit/grain_sizes.h"

namespace sandflow {

namespace {

/// Drops in a row that may fail in a patch before it is taken as full. A cone comes back to all
/// its patches each time it is raised.
constexpr int kBoxFailures = 3;
constexpr int kConeFailures = 1;

/// Solid fraction deep inside, and the depth (in mean radii, along the normal of the face) that a
/// cone loses because grains are kept wholly inside; measured for 20,000 to 100,000 grains and
/// slopes of 15 to 50 degrees. Only the first guess of a cone's height depends on them.
constexpr double kSolidFraction = 0.58;
constexpr double kConeSkin = 1.2;

/// A cone starts a little low and is raised by a part of what seems to be missing, again and again:
/// the apex fills last, so a cone that is too high would end with its tip cut off.
constexpr double kConeCaution = 0.97;
constexpr double kRaiseCaution = 0.6;

/// A cone of this fraction is far below what any stable heap has: the slope does not hold.
constexpr double kLoosestCone = 0.40;

/// The drop area in equal patches of about a grain, those not yet full. Every patch gets its drop
/// before one gets the next, in random order: left to chance, the bed's height would vary with the
/// square root of the drops.
class PatchDeck {
public:
    PatchDeck(const Vec2& lo, const Vec2& hi, double edge, int mostFailures)
        : lo_(lo), mostFailures_(mostFailures)
    {
        const auto parts = [edge](double length) {
            return static_cast<std::int64_t>(std::max(1.0, std::floor(length / edge)));
        };
        nx_ = parts(hi.x() - lo.x());
        const std::int64_t ny = parts(hi.y() - lo.y());
        edge_ = Vec2((hi.x() - lo.x()) / static_cast<double>(nx_),
                     (hi.y() - lo.y()) / static_cast<double>(ny));
        open_.resize(static_cast<std::size_t>(nx_ * ny));
        for (std::size_t k = 0; k < open_.size(); ++k) {
            open_[k] = {static_cast<std::int64_t>(k), 0};
        }
    }

    bool isEmpty() const { return open_.empty(); }

    void choose(Random& random)
    {
        // open_[0 .. next_) had their turn in this round.
        next_ = next_ < open_.size() ? next_ : 0;
        std::swap(open_[next_], open_[next_ + random.below(open_.size() - next_)]);
        chosen_ = next_++;
    }

    Vec2 drawPoint(Random& random) const
    {
        const std::int64_t patch = open_[chosen_].index;
        return lo_ +
               Vec2((static_cast<double>(patch % nx_) + random.uniform(0.0, 1.0)) * edge_.x(),
                    (static_cast<double>(patch / nx_) + random.uniform(0.0, 1.0)) * edge_.y());
    }

    void noteSuccess() { open_[chosen_].failures = 0; }

    void noteFailure()
    {
        if (++open_[chosen_].failures >= mostFailures_) {
            open_[chosen_] = open_.back();  // which may still have its turn
            open_.pop_back();
            next_ = chosen_;
        }
    }

private:
    struct Patch {
        std::int64_t index;
        int failures;
    };
    Vec2 lo_, edge_;
    int mostFailures_;
    std::int64_t nx_;
    std::vector<Patch> open_;
    std::size_t chosen_ = 0;
    std::size_t next_ = 0;
};

/// A bed under construction: sizes and places from their own streams.
struct Builder {
    Builder(const SettlingRegion& region, const GrainSpec& spec, std::uint64_t seed,
            std::size_t emitter)
        : grains(spec),
          bed(region, largestRadius(spec)),
          sizes(seed, emitter, RandomUse::sizes),
          places(seed, emitter, RandomUse::packing)
    {
        radius = drawRadius(grains, sizes);
    }

    /// Drops grains on the patches until none is open or `count` grains lie. A grain that finds no
    /// place is dropped again elsewhere, never replaced by a smaller one.
    void fill(PatchDeck& deck, std::int64_t count,
              const std::function<bool(const Vec3&, double)>& isInside)
    {
        while (!deck.isEmpty() && static_cast<std::int64_t>(out.size()) < count) {
            deck.choose(places);
            const Vec2 drop = deck.drawPoint(places);
            const std::optional<Vec3> rest = bed.settle(drop.x(), drop.y(), radius);
            if (!rest || !isInside(*rest, radius)) {
                deck.noteFailure();
                continue;
            }
            deck.noteSuccess();
            bed.add(*rest, radius);
            NewGrain grain;
            grain.position = *rest;
            grain.radius = radius;
            grain.settled = true;
            out.push_back(grain);
            radius = drawRadius(grains, sizes);
        }
    }

    GrainSpec grains;
    DropAndRoll bed;
    Random sizes, places;
    double radius;  ///< of the next grain, m
    std::vector<NewGrain> out;
};

double coneHeightAt(double fraction, double slopeAngle, std::int64_t count, const GrainSpec& grains)
{
    // V = pi H^3 / (3 tan^2 slope), fraction V = sum of the grains' volumes.
    const double volume = static_cast<double>(count) * meanGrainVolume(grains) / fraction;
    const double slope = std::tan(slopeAngle * kPi / 180.0);
    return std::cbrt(3.0 * volume * slope * slope / kPi);
}

}  // namespace

double coneHeight(double slopeAngle, std::int64_t count, const GrainSpec& grains)
{
    return coneHeightAt(kSolidFraction, slopeAngle, count, grains) +
           kConeSkin * grains.radius / std::cos(slopeAngle * kPi / 180.0);
}

std::vector<NewGrain> packBox(const Vec3& min, const Vec3& max, std::int64_t count,
                              const GrainSpec& grains, std::uint64_t seed, std::size_t emitter)
{
    SettlingRegion region;
    region.lo = min.head<2>();
    region.hi = max.head<2>();
    region.floor = min.z();
    Builder builder(region, grains, seed, emitter);

    // Drop where every size of grain is clear of the walls.
    const Vec2 margin = Vec2::Constant(largestRadius(grains));
    PatchDeck deck(region.lo + margin, region.hi - margin, 2.0 * grains.radius, kBoxFailures);
    const std::int64_t most = count > 0 ? count : std::numeric_limits<std::int64_t>::max();
    builder.fill(deck, most,
                 [&](const Vec3& p, double radius) { return p.z() + radius <= max.z(); });
    return std::move(builder.out);
}

std::vector<NewGrain> packCone(const Vec3& apexFoot, double slopeAngle, std::int64_t count,
                               const GrainSpec& grains, std::uint64_t seed, std::size_t emitter)
{
    const double slope = slopeAngle * kPi / 180.0;
    const double cosine = std::cos(slope);
    const double largest = largestRadius(grains);
    // The lowest cone that holds one grain: height of a sphere's tangent cone.
    const double least = largest * (1.0 + 1.0 / cosine) * 1.001;
    const double highest = coneHeightAt(kLoosestCone, slopeAngle, count, grains) + 2.0 * least;
    double height = std::max(least, kConeCaution * coneHeight(slopeAngle, count, grains));

    SettlingRegion region;
    const double widest = highest / std::tan(slope);
    region.lo = apexFoot.head<2>() - Vec2::Constant(widest);
    region.hi = apexFoot.head<2>() + Vec2::Constant(widest);
    region.floor = apexFoot.z();
    region.walls = false;
    Builder builder(region, grains, seed, emitter);

    // Wholly inside: distance to the cone's face (H - z - rho tan a) cos a >= radius.
    const auto isInside = [&](const Vec3& p, double radius) {
        const Vec3 from = p - apexFoot;
        const double depth = height - from.z() - from.head<2>().norm() * std::tan(slope);
        return depth * cosine >= radius;
    };
    while (static_cast<std::int64_t>(builder.out.size()) < count && height <= highest) {
        const double base = height / std::tan(slope);
        PatchDeck deck(apexFoot.head<2>() - Vec2::Constant(base),
                       apexFoot.head<2>() + Vec2::Constant(base), 2.0 * grains.radius,
                       kConeFailures);
        builder.fill(deck, count, isInside);
        // Full: raise the cone by what the grains left over need, spread over its face.
        const double left =
            static_cast<double>(count - static_cast<std::int64_t>(builder.out.size())) *
            meanGrainVolume(grains) / kSolidFraction;
        height += std::max(0.1 * grains.radius, kRaiseCaution * left / (kPi * base * base));
    }
    return std::move(builder.out);
}

}  // namespace sandflow
