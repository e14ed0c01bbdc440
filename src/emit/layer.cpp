#include "emit/layer.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "emit/grain_sizes.h"

namespace sandflow {

namespace {

/// Clear distance inside a layer, as a share of the sum of two radii.
constexpr double kLayerGap = 0.02;

/// Darts for one grain before the layer is shaken. Random addition covers 0.50 of a large area with
/// about 60 darts per grain and saturates at 0.547, so many more darts buy next to nothing.
constexpr int kDartsPerGrain = 300;

/// Shakes of a layer before it is given up, and how far a grain is moved, in its radius.
constexpr int kShakesPerLayer = 30;
constexpr double kShakeReach = 0.5;

/// Share of the centres' area that random addition covers in an opening of any shape.
constexpr double kSafeFraction = 0.3;

constexpr int kTrials = 5;

/// Grains laid so far, by square cells of the largest exclusion distance.
class DartGrid {
public:
    DartGrid(const Opening& opening, double cell)
        : half_(opening.halfSize()),
          cell_(cell),
          nx_(cellCount(half_.x())),
          ny_(cellCount(half_.y())),
          head_(static_cast<std::size_t>(nx_ * ny_), -1)
    {
    }

    bool isFree(const Vec2& p, double radius) const
    {
        const auto [i, j] = cellOf(p);
        for (int v = std::max(0, j - 1); v <= std::min(ny_ - 1, j + 1); ++v) {
            for (int u = std::max(0, i - 1); u <= std::min(nx_ - 1, i + 1); ++u) {
                for (int k = head_[static_cast<std::size_t>(v * nx_ + u)]; k >= 0;
                     k = grains_[static_cast<std::size_t>(k)].next) {
                    const Laid& other = grains_[static_cast<std::size_t>(k)];
                    const double clear = (1.0 + kLayerGap) * (radius + other.radius);
                    if ((other.centre - p).squaredNorm() < clear * clear) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    void add(const Vec2& p, double radius)
    {
        grains_.push_back({p, radius, -1});
        link(static_cast<int>(grains_.size()) - 1);
    }

    /// Moves every grain once to a random place near by, if it is free there and in the opening:
    /// spreads the clear room differently, so that the next grain may find a place.
    void shake(const Opening& opening, Random& random)
    {
        for (int k = 0; k < static_cast<int>(grains_.size()); ++k) {
            Laid& grain = grains_[static_cast<std::size_t>(k)];
            const double reach = kShakeReach * grain.radius;
            const Vec2 p =
                grain.centre + Vec2(random.uniform(-reach, reach), random.uniform(-reach, reach));
            unlink(k);
            if (opening.holds(p, grain.radius) && isFree(p, grain.radius)) {
                grain.centre = p;
            }
            link(k);
        }
    }

    void copyCentres(std::vector<Vec2>& centres) const
    {
        centres.clear();
        for (const Laid& grain : grains_) {
            centres.push_back(grain.centre);
        }
    }

private:
    struct Laid {
        Vec2 centre;
        double radius;
        int next;
    };

    int& headOf(const Vec2& p)
    {
        const auto [i, j] = cellOf(p);
        return head_[static_cast<std::size_t>(j * nx_ + i)];
    }

    void link(int k)
    {
        Laid& grain = grains_[static_cast<std::size_t>(k)];
        int& head = headOf(grain.centre);
        grain.next = head;
        head = k;
    }

    void unlink(int k)
    {
        const Laid& grain = grains_[static_cast<std::size_t>(k)];
        int* link = &headOf(grain.centre);
        while (*link != k) {
            link = &grains_[static_cast<std::size_t>(*link)].next;
        }
        *link = grain.next;
    }

    int cellCount(double half) const { return 1 + static_cast<int>(2.0 * half / cell_); }

    std::pair<int, int> cellOf(const Vec2& p) const
    {
        return {std::clamp(static_cast<int>((p.x() + half_.x()) / cell_), 0, nx_ - 1),
                std::clamp(static_cast<int>((p.y() + half_.y()) / cell_), 0, ny_ - 1)};
    }

    Vec2 half_;
    double cell_;
    int nx_, ny_;
    std::vector<int> head_;
    std::vector<Laid> grains_;
};

}  // namespace

double Opening::centreArea(double grainRadius) const
{
    if (round) {
        const double inner = radius - grainRadius;
        return inner < 0.0 ? 0.0 : kPi * inner * inner;
    }
    const Vec2 inner = size - Vec2::Constant(2.0 * grainRadius);
    return inner.minCoeff() < 0.0 ? 0.0 : inner.x() * inner.y();
}

bool Opening::holds(const Vec2& centre, double grainRadius) const
{
    if (round) {
        return centre.norm() <= radius - grainRadius;
    }
    return (0.5 * size - centre.cwiseAbs()).minCoeff() >= grainRadius;
}

Vec2 Opening::drawCentre(double grainRadius, Random& random) const
{
    const Vec2 inner = halfSize() - Vec2::Constant(grainRadius);
    for (;;) {
        const double x = random.uniform(-inner.x(), inner.x());
        const double y = random.uniform(-inner.y(), inner.y());
        if (!round || x * x + y * y <= inner.x() * inner.x()) {
            return {x, y};
        }
    }
}

std::size_t placeLayer(const Opening& opening, const std::vector<double>& radii, Random& random,
                       std::vector<Vec2>& centres)
{
    centres.clear();
    if (radii.empty()) {
        return 0;
    }
    const double largest = *std::max_element(radii.begin(), radii.end());
    DartGrid grid(opening, 2.0 * largest * (1.0 + kLayerGap));
    int shakes = 0;
    std::size_t placed = 0;
    while (placed < radii.size() && shakes <= kShakesPerLayer) {
        const double radius = radii[placed];
        bool isPlaced = false;
        for (int dart = 0; dart < kDartsPerGrain && !isPlaced; ++dart) {
            const Vec2 p = opening.drawCentre(radius, random);
            isPlaced = grid.isFree(p, radius);
            if (isPlaced) {
                grid.add(p, radius);
            }
        }
        if (isPlaced) {
            ++placed;
        } else {
            grid.shake(opening, random);
            ++shakes;
        }
    }
    grid.copyCentres(centres);
    return placed;
}

std::int64_t layerCapacity(const Opening& opening, const GrainSpec& grains, double wanted,
                           Random& random)
{
    const double largest = largestRadius(grains);
    const Vec2 half = opening.halfSize();
    if (half.minCoeff() < largest) {
        return 0;
    }
    const double clear = (1.0 + kLayerGap) * largest;
    const double safe = kSafeFraction * opening.centreArea(largest) / (kPi * clear * clear);
    if (wanted <= std::max(1.0, std::floor(safe))) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(safe));
    }
    // No more than the discs' own area can ever fit; that bounds the trial.
    const double smallest = grains.radius * (1.0 - grains.sizeSpread);
    const double roof = 4.0 * half.x() * half.y() / (kPi * smallest * smallest) + 1.0;
    const double tried = std::min({roof, 4.0 * wanted + 16.0, 1e8});
    std::int64_t capacity = 0;
    std::vector<double> radii(static_cast<std::size_t>(tried));
    std::vector<Vec2> centres;
    for (int trial = 0; trial < kTrials; ++trial) {
        for (double& radius : radii) {
            radius = drawRadius(grains, random);
        }
        const auto placed = static_cast<std::int64_t>(placeLayer(opening, radii, random, centres));
        capacity = trial == 0 ? placed : std::min(capacity, placed);
    }
    return capacity;
}

}  // namespace sandflow
