#include "mesh/mesh_columns.h"

#include "core/errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sandflow {

namespace {

int sumOfTurns(const std::vector<Crossing>& crossings)
{
    int sum = 0;
    for (const Crossing& crossing : crossings) {
        sum += crossing.turn;
    }
    return sum;
}

/// Appends the stretches where isSolid(sum of turns below) holds, given crossings in ascending
/// order. Those at one height count as one: solids that touch make one stretch.
template <class IsSolid>
void appendStretches(const std::vector<Crossing>& crossings, const IsSolid& isSolid,
                     std::vector<SolidInterval>& out)
{
    int winding = 0;
    double lo = 0.0;
    for (std::size_t k = 0; k < crossings.size();) {
        const double height = crossings[k].height;
        const bool before = isSolid(winding);
        for (; k < crossings.size() && crossings[k].height == height; ++k) {
            winding += crossings[k].turn;
        }
        const bool after = isSolid(winding);
        if (!before && after) {
            lo = height;
        } else if (before && !after) {
            out.push_back({lo, height});
        }
    }
}

void sortByHeight(std::vector<Crossing>& crossings)
{
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
}

bool isInside(int winding)
{
    return winding != 0;
}

/// Stretches as crossings of their own, to be counted with those of others.
void addEnds(const SolidInterval& stretch, std::vector<Crossing>& ends)
{
    ends.push_back({stretch.lo, 1});
    ends.push_back({stretch.hi, -1});
}

/// Where to ask about a hole, in shares of `thin`: the corners of a triangle, so that a narrow
/// crack along any direction misses two of them.
constexpr double kSine = 0.86602540378443865;  // of 60 degrees
constexpr std::array<std::pair<double, double>, 3> kAround = {
    {{0.0, 1.0}, {-kSine, -0.5}, {kSine, -0.5}}};

/// Crossings in ascending order that do not balance: pairs, and slabs for those without a partner.
void appendPairsAndSlabs(const std::vector<Crossing>& crossings, double thin,
                         std::vector<SolidInterval>& out)
{
    std::vector<Crossing> ends;
    std::vector<double> waiting;  // heights of surfaces that face down, the highest last
    for (const Crossing& crossing : crossings) {
        if (crossing.turn > 0) {
            waiting.push_back(crossing.height);
        } else if (!waiting.empty()) {
            addEnds({waiting.back(), crossing.height}, ends);
            waiting.pop_back();
        } else {
            addEnds({crossing.height - thin, crossing.height}, ends);
        }
    }
    for (const double height : waiting) {
        addEnds({height - thin, height}, ends);
    }
    sortByHeight(ends);
    appendStretches(ends, isInside, out);
}

}  // namespace

MeshColumns::MeshColumns(const TriangleMesh& mesh, double thin) : grid_(mesh), thin_(thin)
{
    SAND_CHECK(thin > 0.0 && std::isfinite(thin), "slabs of {} m", thin);
}

void MeshColumns::solidIntervalsAt(double x, double y, std::vector<SolidInterval>& out) const
{
    // Columns are asked in bulk: one list per thread, not one per line.
    thread_local std::vector<Crossing> crossings;
    grid_.crossingsAt(x, y, crossings);
    out.clear();
    sortByHeight(crossings);
    if (sumOfTurns(crossings) == 0) {
        appendStretches(crossings, isInside, out);
    } else {
        appendPatched(x, y, crossings, out);
    }
}

void MeshColumns::appendPatched(double x, double y, const std::vector<Crossing>& crossings,
                                std::vector<SolidInterval>& out) const
{
    int witnesses = 0;
    std::vector<Crossing> nearby;
    std::vector<SolidInterval> stretches;
    std::vector<Crossing> ends;
    for (const auto& [dx, dy] : kAround) {
        grid_.crossingsAt(x + thin_ * dx, y + thin_ * dy, nearby);
        // A line beside the mesh says nothing about the hole.
        if (nearby.empty() || sumOfTurns(nearby) != 0) {
            continue;
        }
        ++witnesses;
        sortByHeight(nearby);
        stretches.clear();
        appendStretches(nearby, isInside, stretches);
        for (const SolidInterval& stretch : stretches) {
            addEnds(stretch, ends);
        }
    }
    if (witnesses >= 2) {
        sortByHeight(ends);
        appendStretches(ends, [](int votes) { return votes >= 2; }, out);
    } else {
        appendPairsAndSlabs(crossings, thin_, out);
    }
}

/// False where p is above or below all that solidIntervalsAt() would look at: most grains are.
bool MeshColumns::isNear(const Vec3& p) const
{
    const auto isWithin = [&](double x, double y, double margin) {
        const SolidInterval heights = grid_.heightRangeAt(x, y);
        return p.z() >= heights.lo - margin && p.z() <= heights.hi;
    };
    if (!isOpen()) {
        return isWithin(p.x(), p.y(), 0.0);
    }
    return isWithin(p.x(), p.y(), thin_) ||
           std::any_of(kAround.begin(), kAround.end(), [&](const auto& around) {
               return isWithin(p.x() + thin_ * around.first, p.y() + thin_ * around.second, 0.0);
           });
}

bool MeshColumns::contains(const Vec3& p) const
{
    if (!isNear(p)) {
        return false;
    }
    const LineWinding winding = grid_.windingAt(p);
    if (winding.total == 0) {
        return winding.below != 0 || winding.upTo != 0;
    }
    std::vector<SolidInterval> stretches;
    solidIntervalsAt(p.x(), p.y(), stretches);
    return std::any_of(stretches.begin(), stretches.end(), [&](const SolidInterval& stretch) {
        return p.z() >= stretch.lo && p.z() <= stretch.hi;
    });
}

bool MeshColumns::isOpenAt(double x, double y) const
{
    std::vector<Crossing> crossings;
    grid_.crossingsAt(x, y, crossings);
    return sumOfTurns(crossings) != 0;
}

std::size_t MeshColumns::countOpenLines(int linesPerEdge) const
{
    SAND_CHECK(linesPerEdge > 0, "{} lines per edge", linesPerEdge);
    if (!isOpen()) {
        return 0;
    }
    std::size_t count = 0;
    const Vec3 step = bounds().sizes() / linesPerEdge;
    for (int j = 0; j < linesPerEdge; ++j) {
        for (int i = 0; i < linesPerEdge; ++i) {
            const double x = bounds().min().x() + (i + 0.5) * step.x();
            const double y = bounds().min().y() + (j + 0.5) * step.y();
            count += isOpenAt(x, y) ? 1 : 0;
        }
    }
    return count;
}

}  // namespace sandflow
