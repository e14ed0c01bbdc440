#include "measure/compare.h"

#include "measure/radial_profile.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sandflow {
namespace {

constexpr double kComparedFrom = 1.5;  // d; lower sand is single grains, where H means little

/// Gathers one HeightDifference; depths in d, any weight.
class DifferenceSum {
public:
    void add(double depthA, double depthB, double weight)
    {
        if (std::max(depthA, depthB) <= kComparedFrom) {
            return;
        }
        const double difference = depthB - depthA;
        weight_ += weight;
        absolute_ += weight * std::abs(difference);
        square_ += weight * difference * difference;
        signed_ += weight * difference;
        worst_ = std::max(worst_, std::abs(difference));
        ++places_;
    }

    HeightDifference result() const
    {
        if (places_ == 0) {
            return {};
        }
        return {absolute_ / weight_, std::sqrt(square_ / weight_), signed_ / weight_, worst_,
                places_};
    }

private:
    double weight_ = 0.0;
    double absolute_ = 0.0;
    double square_ = 0.0;
    double signed_ = 0.0;
    double worst_ = 0.0;
    std::size_t places_ = 0;
};

HeightDifference compareProfiles(const HeapFigures& a, const HeapFigures& b, double diameter)
{
    const auto depth = [diameter](const HeapFigures& heap, std::size_t k) {
        return k < heap.profile.size() ? heap.profile[k] / diameter : 0.0;
    };
    DifferenceSum sum;
    for (std::size_t k = 0; k < std::max(a.profile.size(), b.profile.size()); ++k) {
        sum.add(depth(a, k), depth(b, k), annulusArea(k));
    }
    return sum.result();
}

/// A tile of the height map is a cell of 5 d, the same one in both maps.
HeightDifference compareCells(const HeightMap& a, const HeightMap& b)
{
    const auto meanDepth = [&a](const HeightMap::Tile* tile) {
        double sum = 0.0;
        for (std::size_t p = 0; tile != nullptr && p < tile->height.size(); ++p) {
            sum += tile->height[p] - tile->floor[p];
        }
        return sum / (HeightMap::kTilePoints * a.diameter());
    };
    std::set<std::pair<std::int32_t, std::int32_t>> cells;  // row, column
    for (const HeightMap* map : {&a, &b}) {
        for (const HeightMap::Tile& tile : map->tiles()) {
            cells.emplace(tile.j, tile.i);
        }
    }
    DifferenceSum sum;
    for (const auto& [j, i] : cells) {
        sum.add(meanDepth(a.findTile(i, j)), meanDepth(b.findTile(i, j)), 1.0);
    }
    return sum.result();
}

double percentOf(double reference, double value)
{
    return reference > 0.0 ? 100.0 * (value - reference) / reference : 0.0;
}

std::string formatAngle(const std::optional<double>& angle)
{
    return angle ? fmt::format("{:.2f}", *angle) : "none";
}

/// One line of the table: name, unit, value of a, value of b, difference with its unit.
std::string formatRow(const std::string& name, const std::string& unit, const std::string& a,
                      const std::string& b, const std::string& difference)
{
    std::string row =
        fmt::format("{:<16} {:<6} {:>12} {:>12}   {:>16}", name, unit, a, b, difference);
    row.erase(row.find_last_not_of(' ') + 1);
    return row + "\n";
}

std::string formatLength(double value)
{
    return fmt::format("{:.1f}", 1e3 * value);  // m to mm
}

std::string formatDifference(const std::string& name, const HeightDifference& difference,
                             const std::string& places)
{
    if (difference.places == 0) {
        return fmt::format("{:<16} no {} higher than {} d in either heap\n", name, places,
                           kComparedFrom);
    }
    return fmt::format(
        "{:<16} mean {:.3f} d, rms {:.3f} d, worst {:.3f} d, bias {:+.3f} d over "
        "{} {}\n",
        name, difference.mean, difference.rms, difference.worst, difference.bias, difference.places,
        places);
}

}  // namespace

HeapComparison compareHeaps(const Snapshot& a, const Snapshot& b, double floorZ)
{
    return compareHeaps(a, b, levelFloor(floorZ));
}

HeapComparison compareHeaps(const Snapshot& a, const Snapshot& b, const FloorHeight& floor)
{
    // Not for equality: a radius may have been through a text file.
    if (!(std::abs(a.meanRadius - b.meanRadius) <= 1e-6 * a.meanRadius)) {
        throw InputError(
            fmt::format("heaps of grains of {:.6g} m and {:.6g} m mean radius cannot "
                        "be compared",
                        a.meanRadius, b.meanRadius));
    }
    HeapComparison result;
    result.diameter = 2.0 * a.meanRadius;
    const double d = result.diameter;
    const HeightMap mapA(a, floor, d);
    const HeightMap mapB(b, floor, d);
    result.a = measureHeap(a, mapA);
    result.b = measureHeap(b, mapB);
    result.radial = compareProfiles(result.a, result.b, d);
    result.cells = compareCells(mapA, mapB);
    if (result.a.grains > 0 && result.b.grains > 0) {
        result.centroidShift = (result.b.centroid - result.a.centroid).norm() / d;
    }
    result.apexDifference = (result.b.apex - result.a.apex) / d;
    if (result.a.reposeDeg && result.b.reposeDeg) {
        result.reposeDifference = *result.b.reposeDeg - *result.a.reposeDeg;
    }
    result.r90Difference = percentOf(result.a.r90, result.b.r90);
    result.footDifference = (result.b.foot - result.a.foot) / d;
    result.volumeDifference = percentOf(result.a.volume, result.b.volume);
    result.countDifference =
        static_cast<std::int64_t>(result.b.grains) - static_cast<std::int64_t>(result.a.grains);
    return result;
}

std::string describe(const HeapComparison& comparison)
{
    const HeapFigures& a = comparison.a;
    const HeapFigures& b = comparison.b;
    std::string text = formatRow("heap", "", "A", "B", "B - A");
    text += formatRow("grains", "", fmt::format("{}", a.grains), fmt::format("{}", b.grains),
                      fmt::format("{:+d}  ", comparison.countDifference));
    text += formatRow("in the air", "", fmt::format("{}", a.airborne),
                      fmt::format("{}", b.airborne), "");
    text += formatRow("apex", "mm", formatLength(a.apex), formatLength(b.apex),
                      fmt::format("{:+.2f} d", comparison.apexDifference));
    text += formatRow("repose angle", "deg", formatAngle(a.reposeDeg), formatAngle(b.reposeDeg),
                      comparison.reposeDifference
                          ? fmt::format("{:+.2f} deg", *comparison.reposeDifference)
                          : "");
    text += formatRow("r90", "mm", formatLength(a.r90), formatLength(b.r90),
                      fmt::format("{:+.2f} %", comparison.r90Difference));
    text += formatRow("foot", "mm", formatLength(a.foot), formatLength(b.foot),
                      fmt::format("{:+.2f} d", comparison.footDifference));
    text += formatRow("volume", "dm3", fmt::format("{:.3f}", 1e3 * a.volume),
                      fmt::format("{:.3f}", 1e3 * b.volume),
                      fmt::format("{:+.2f} %", comparison.volumeDifference));
    text += formatRow("solid fraction", "", fmt::format("{:.4f}", a.solidFraction),
                      fmt::format("{:.4f}", b.solidFraction),
                      fmt::format("{:+.4f}  ", b.solidFraction - a.solidFraction));
    text +=
        formatRow("centroid shift", "", "", "", fmt::format("{:.2f} d", comparison.centroidShift));
    text += formatDifference("|dH| radial", comparison.radial, "annuli of 1 d");
    text += formatDifference("|dH| on cells", comparison.cells, "cells of 5 d");
    text += fmt::format("(d = {:.4g} mm)\n", 1e3 * comparison.diameter);
    return text;
}

}  // namespace sandflow
