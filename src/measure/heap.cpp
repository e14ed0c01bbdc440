#include "measure/heap.h"

#include "measure/radial_profile.h"
#include "measure/robust_line.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

constexpr double kApexRadius = 3.0;    // d
constexpr double kFootHeight = 1.0;    // d
constexpr double kFlankTop = 0.75;     // of the apex; above, the impact of the jet rounds the heap
constexpr double kFlankBottom = 0.15;  // of the apex; below, the tail of single grains runs out
constexpr double kRunOutShare = 0.9;

Vec2 findCentroid(const Snapshot& snapshot, const std::vector<std::uint32_t>& grains)
{
    Vec2 sum = Vec2::Zero();
    for (const std::uint32_t n : grains) {
        sum += snapshot.position[n].head<2>();
    }
    return sum / static_cast<double>(grains.size());
}

/// Smallest radius about `centre` that holds the share of the grains' centres.
double findRunOut(const Snapshot& snapshot, const std::vector<std::uint32_t>& grains,
                  const Vec2& centre)
{
    std::vector<double> distance;
    distance.reserve(grains.size());
    for (const std::uint32_t n : grains) {
        distance.push_back((snapshot.position[n].head<2>() - centre).norm());
    }
    const double rank = std::ceil(kRunOutShare * static_cast<double>(grains.size()));
    const auto at = distance.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
    std::nth_element(distance.begin(), at, distance.end());
    return *at;
}

std::optional<double> fitRepose(const std::vector<double>& profile, double apex, double diameter)
{
    // The flank is one piece: from the first annulus below its top to the last one before the
    // profile first falls below its bottom. Both coordinates in d.
    std::vector<double> radius;
    std::vector<double> height;
    for (std::size_t k = 0; k < profile.size() && profile[k] >= kFlankBottom * apex; ++k) {
        if (!radius.empty() || profile[k] <= kFlankTop * apex) {
            radius.push_back(annulusMeanRadius(k));
            height.push_back(profile[k] / diameter);
        }
    }
    const std::optional<Line> line = fitRobustLine(radius, height);
    if (!line) {
        return std::nullopt;
    }
    return std::atan(-line->slope) * 180.0 / kPi;
}

/// Where the profile, taken as a line through the annuli's means, last falls below 1 d. The
/// outermost such place, so that a crater does not count as the foot.
double findFoot(const std::vector<double>& profile, double diameter)
{
    const double level = kFootHeight * diameter;
    std::size_t above = profile.size();
    while (above > 0 && profile[above - 1] < level) {
        --above;
    }
    if (above == 0) {
        return 0.0;
    }
    const double inner = annulusMeanRadius(above - 1);
    const double outer = annulusMeanRadius(above);
    const double high = profile[above - 1];
    const double low = above < profile.size() ? profile[above] : 0.0;
    return diameter * (inner + (outer - inner) * (high - level) / (high - low));
}

double sumVolume(const HeightMap& map)
{
    double volume = 0.0;
    for (const HeightMap::Tile& tile : map.tiles()) {
        double depth = 0.0;
        for (std::size_t p = 0; p < tile.height.size(); ++p) {
            depth += tile.height[p] - tile.floor[p];
        }
        volume += depth * map.pointArea();
    }
    return volume;
}

double sumSphereVolume(const Snapshot& snapshot, const std::vector<std::uint32_t>& grains)
{
    double cubes = 0.0;
    for (const std::uint32_t n : grains) {
        const double radius = snapshot.radius[n];
        cubes += radius * radius * radius;
    }
    return 4.0 / 3.0 * kPi * cubes;
}

}  // namespace

HeapFigures measureHeap(const Snapshot& snapshot, double floorZ)
{
    return measureHeap(snapshot, HeightMap(snapshot, floorZ));
}

HeapFigures measureHeap(const Snapshot& snapshot, const HeightMap& map)
{
    const std::vector<std::uint32_t>& grains = map.settled();
    HeapFigures figures;
    figures.grains = grains.size();
    figures.airborne = snapshot.size() - grains.size();
    figures.diameter = map.diameter();
    if (grains.empty()) {
        return figures;
    }
    figures.centroid = findCentroid(snapshot, grains);
    figures.profile = averageOverAnnuli(map, figures.centroid);
    figures.apex = averageOverDisc(map, figures.centroid, kApexRadius * map.diameter());
    figures.reposeDeg = fitRepose(figures.profile, figures.apex, map.diameter());
    figures.r90 = findRunOut(snapshot, grains, figures.centroid);
    figures.foot = findFoot(figures.profile, map.diameter());
    figures.volume = sumVolume(map);
    figures.solidFraction =
        figures.volume > 0.0 ? sumSphereVolume(snapshot, grains) / figures.volume : 0.0;
    return figures;
}

}  // namespace sandflow
