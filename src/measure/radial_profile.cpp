#include "measure/radial_profile.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

// Beyond this ring the number of sub-grid points per annulus is its area to better than 0.1 %.
constexpr std::size_t kCountedRings = 400;

/// How many sub-grid points lie in each annulus. Counted, not taken from the area: near the centre
/// an annulus has a dozen points, and one more or less would change its mean by a d or two.
std::vector<double> countPoints(const HeightMap& map, const Vec2& centre, std::size_t rings)
{
    const double d = map.diameter();
    const double s = map.spacing();
    const std::size_t counted = std::min(rings, kCountedRings);
    std::vector<double> within(rings + 1, 0.0);  // points with rho < k d
    const double radius = static_cast<double>(counted) * d;
    const std::int32_t lastRow = map.pointIndex(centre.y() + radius) + 1;
    for (std::int32_t row = map.pointIndex(centre.y() - radius) - 1; row <= lastRow; ++row) {
        const double dy = map.pointCoordinate(row) - centre.y();
        for (std::size_t k = counted; k > 0; --k) {
            const double outer = static_cast<double>(k) * d;
            const double rest = outer * outer - dy * dy;
            if (rest <= 0.0) {
                break;
            }
            const double half = std::sqrt(rest);
            const double first = std::ceil((centre.x() - half) / s - 0.5);
            const double last = std::floor((centre.x() + half) / s - 0.5);
            within[k] += std::max(last - first + 1.0, 0.0);
        }
    }
    std::vector<double> count(rings);
    for (std::size_t k = 0; k < rings; ++k) {
        count[k] =
            k < counted ? within[k + 1] - within[k] : annulusArea(k) * d * d / map.pointArea();
    }
    return count;
}

}  // namespace

double annulusArea(std::size_t k)
{
    return kPi * (2.0 * static_cast<double>(k) + 1.0);
}

double annulusMeanRadius(std::size_t k)
{
    // int rho^2 drho / int rho drho over [k, k + 1]
    const double inner = static_cast<double>(k);
    return (2.0 / 3.0) * (3.0 * inner * inner + 3.0 * inner + 1.0) / (2.0 * inner + 1.0);
}

std::vector<double> averageOverAnnuli(const HeightMap& map, const Vec2& centre)
{
    std::vector<double> sum;
    for (const HeightMap::Tile& tile : map.tiles()) {
        for (std::int32_t p = 0; p < HeightMap::kTilePoints; ++p) {
            const double depth = tile.height[p] - tile.floor[p];
            if (depth <= 0.0) {
                continue;
            }
            const std::int64_t i =
                std::int64_t{tile.i} * HeightMap::kTileEdge + p % HeightMap::kTileEdge;
            const std::int64_t j =
                std::int64_t{tile.j} * HeightMap::kTileEdge + p / HeightMap::kTileEdge;
            const double rho = std::hypot(map.pointCoordinate(i) - centre.x(),
                                          map.pointCoordinate(j) - centre.y());
            const auto ring = static_cast<std::size_t>(rho / map.diameter());
            if (ring >= sum.size()) {
                sum.resize(ring + 1, 0.0);
            }
            sum[ring] += depth;
        }
    }
    const std::vector<double> count = countPoints(map, centre, sum.size());
    for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] = count[k] > 0.0 ? sum[k] / count[k] : 0.0;
    }
    return sum;
}

double averageOverDisc(const HeightMap& map, const Vec2& centre, double radius)
{
    double sum = 0.0;
    double count = 0.0;
    const std::int32_t lastI = map.pointIndex(centre.x() + radius);
    const std::int32_t lastJ = map.pointIndex(centre.y() + radius);
    for (std::int32_t j = map.pointIndex(centre.y() - radius); j <= lastJ; ++j) {
        for (std::int32_t i = map.pointIndex(centre.x() - radius); i <= lastI; ++i) {
            if (std::hypot(map.pointCoordinate(i) - centre.x(),
                           map.pointCoordinate(j) - centre.y()) < radius) {
                sum += map.depthAt(i, j);
                count += 1.0;
            }
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace sandflow
