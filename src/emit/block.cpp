#include "emit/block.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "emit/grain_sizes.h"

namespace sandflow {

namespace {

/// Sites of a hexagonal close packing of spheres of diameter s that lie wholly in a box.
///
///     layer 0     o   o   o   o       rows s sqrt(3)/2 apart, odd rows shifted by s/2;
///                   o   o   o         layers s sqrt(2/3) apart, odd layers shifted by
///                 o   o   o   o       (s/2, s/(2 sqrt 3)): over the hollows
struct SiteLattice {
    Vec3 corner;     ///< of the box
    Vec3 size;       ///< of the box
    double spacing;  ///< s, m

    double rowStep() const { return spacing * std::sqrt(3.0) / 2.0; }
    double layerStep() const { return spacing * std::sqrt(2.0 / 3.0); }

    /// Number of points 0, step, 2 step, ... up to length.
    static std::int64_t fitting(double length, double step)
    {
        // A box made exactly for n grains must hold n whatever the rounding.
        const double n = std::floor(length / step * (1.0 + 1e-12) + 1e-12);
        return length < 0.0 ? 0 : 1 + static_cast<std::int64_t>(std::min(n, 1e15));
    }

    Vec2 shift(std::int64_t layer) const
    {
        return layer % 2 == 0 ? Vec2(0.0, 0.0) : Vec2(0.5 * spacing, rowStep() / 3.0);
    }

    /// Offset along x of a row; taken modulo s so that no room is lost at the box's side.
    double rowShift(std::int64_t layer, std::int64_t row) const
    {
        return (layer + row) % 2 == 0 ? 0.0 : 0.5 * spacing;
    }

    std::int64_t layers() const { return fitting(size.z() - spacing, layerStep()); }
    std::int64_t rows(std::int64_t layer) const
    {
        return fitting(size.y() - spacing - shift(layer).y(), rowStep());
    }
    std::int64_t sitesInRow(std::int64_t layer, std::int64_t row) const
    {
        return fitting(size.x() - spacing - rowShift(layer, row), spacing);
    }

    std::int64_t sites() const
    {
        // Layers and rows alternate between two kinds.
        std::int64_t sum = 0;
        for (std::int64_t layer = 0; layer < 2; ++layer) {
            const std::int64_t many = (layers() + 1 - layer) / 2;
            const std::int64_t even = (rows(layer) + 1) / 2;
            const std::int64_t odd = rows(layer) / 2;
            sum += many * (even * sitesInRow(layer, 0) + odd * sitesInRow(layer, 1));
        }
        return sum;
    }

    Vec3 site(std::int64_t layer, std::int64_t row, std::int64_t k) const
    {
        const Vec3 first = corner + Vec3::Constant(0.5 * spacing);
        return first + Vec3(rowShift(layer, row) + spacing * static_cast<double>(k),
                            shift(layer).y() + rowStep() * static_cast<double>(row),
                            layerStep() * static_cast<double>(layer));
    }
};

/// Uniform in a ball.
Vec3 drawInBall(double radius, Random& random)
{
    for (;;) {
        const double x = random.uniform(-1.0, 1.0);
        const double y = random.uniform(-1.0, 1.0);
        const double z = random.uniform(-1.0, 1.0);
        if (x * x + y * y + z * z <= 1.0) {
            return Vec3(x, y, z) * radius;
        }
    }
}

/// The widest spacing that still offers `count` sites.
double widestSpacing(const Vec3& min, const Vec3& max, std::int64_t count, double diameter)
{
    double fits = diameter;
    double tooWide = std::max(diameter, (max - min).minCoeff()) * (1.0 + 1e-9);
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (fits + tooWide);
        (SiteLattice{min, max - min, middle}.sites() >= count ? fits : tooWide) = middle;
    }
    return fits;
}

}  // namespace

std::int64_t blockCapacity(const Vec3& min, const Vec3& max, double largest)
{
    return SiteLattice{min, max - min, 2.0 * largest}.sites();
}

void fillBlock(const Vec3& min, const Vec3& max, std::int64_t count, const GrainSpec& grains,
               Random& sizes, Random& places, std::vector<NewGrain>& out)
{
    const double spacing = widestSpacing(min, max, count, 2.0 * largestRadius(grains));
    const SiteLattice lattice{min, max - min, spacing};
    std::int64_t sitesLeft = lattice.sites();
    std::int64_t grainsLeft = count;
    SAND_CHECK(sitesLeft >= grainsLeft, "{} sites for {} grains", sitesLeft, grainsLeft);
    for (std::int64_t layer = 0; layer < lattice.layers(); ++layer) {
        for (std::int64_t row = 0; row < lattice.rows(layer); ++row) {
            for (std::int64_t k = 0; k < lattice.sitesInRow(layer, row); ++k, --sitesLeft) {
                // Selection sampling: every subset of sites is equally likely.
                const double share =
                    static_cast<double>(grainsLeft) / static_cast<double>(sitesLeft);
                if (share < 1.0 && places.uniform(0.0, 1.0) >= share) {
                    continue;
                }
                NewGrain grain;
                grain.radius = drawRadius(grains, sizes);
                // Two sites are at least s apart: s - (s/2 - r1) - (s/2 - r2) = r1 + r2.
                const double room = std::max(0.0, 0.5 * spacing - grain.radius);
                grain.position = lattice.site(layer, row, k) + drawInBall(room, places);
                out.push_back(grain);
                --grainsLeft;
            }
        }
    }
}

}  // namespace sandflow
