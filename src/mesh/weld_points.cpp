#include "mesh/weld_points.h"

#include "core/hash.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace sandflow {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Cells this many tolerances wide: few points are so near to a side that other cells must be
/// looked into, and a cell holds few points that are not welded.
constexpr double kCellWidth = 4.0;

struct MixKey {
    std::size_t operator()(std::uint64_t key) const { return mixBits(key); }
};

class PointWelder {
public:
    PointWelder(const std::vector<Vec3>& points, const Vec3& origin, double tolerance)
        : points_(points),
          // Half a cell off: coordinates at the lower end of the box are common.
          origin_(origin - Vec3::Constant(0.5 * kCellWidth * tolerance)),
          tolerance_(tolerance),
          next_(points.size(), kNone)
    {
    }

    /// The earlier point that stands for this one, or itself.
    std::uint32_t findOrAdd(std::uint32_t index)
    {
        const Vec3& p = points_[index];
        const Vec3 place = (p - origin_) / (kCellWidth * tolerance_);
        constexpr double kReach = 1.0001 / kCellWidth;  // rounded up
        std::uint32_t best = kNone;
        for (double x = std::floor(place.x() - kReach); x <= place.x() + kReach; ++x) {
            for (double y = std::floor(place.y() - kReach); y <= place.y() + kReach; ++y) {
                for (double z = std::floor(place.z() - kReach); z <= place.z() + kReach; ++z) {
                    best = std::min(best, findIn(keyOf(x, y, z), p));
                }
            }
        }
        if (best == kNone) {
            best = index;
            const Vec3 cell = place.array().floor();
            const auto [head, isNew] =
                heads_.try_emplace(keyOf(cell.x(), cell.y(), cell.z()), index);
            if (!isNew) {
                next_[index] = head->second;
                head->second = index;
            }
        }
        return best;
    }

private:
    static std::uint64_t keyOf(double x, double y, double z)
    {
        // -1 occurs beside the box; the mask keeps it apart from all cells inside.
        constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
        const auto part = [](double c) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(c)) & kMask;
        };
        return part(x) | part(y) << 21 | part(z) << 42;
    }

    std::uint32_t findIn(std::uint64_t key, const Vec3& p) const
    {
        std::uint32_t best = kNone;
        const auto head = heads_.find(key);
        if (head != heads_.end()) {
            for (std::uint32_t i = head->second; i != kNone; i = next_[i]) {
                if (i < best && (points_[i] - p).squaredNorm() <= tolerance_ * tolerance_) {
                    best = i;
                }
            }
        }
        return best;
    }

    const std::vector<Vec3>& points_;
    Vec3 origin_;
    double tolerance_;
    std::unordered_map<std::uint64_t, std::uint32_t, MixKey> heads_;  ///< a point per cell
    std::vector<std::uint32_t> next_;                                 ///< in the same cell
};

std::vector<bool> markUsed(const TriangleMesh& mesh)
{
    std::vector<bool> used(mesh.points.size(), false);
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            used[corner] = true;
        }
    }
    return used;
}

}  // namespace

std::size_t weldPoints(double tolerance, TriangleMesh& mesh)
{
    const std::vector<bool> used = markUsed(mesh);
    std::vector<std::uint32_t> standIn(mesh.points.size(), kNone);
    PointWelder welder(mesh.points, boundsOf(mesh).min(), tolerance);
    std::size_t welded = 0;
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
        if (used[i]) {
            standIn[i] = welder.findOrAdd(i);
            welded += standIn[i] != i ? 1 : 0;
        }
    }
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = standIn[corner];
        }
    }
    return welded;
}

std::size_t dropUnusedPoints(TriangleMesh& mesh)
{
    const std::vector<bool> used = markUsed(mesh);
    std::vector<std::uint32_t> newIndex(mesh.points.size(), kNone);
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (used[i]) {
            mesh.points[kept] = mesh.points[i];
            newIndex[i] = kept++;
        }
    }
    const std::size_t dropped = mesh.points.size() - kept;
    mesh.points.resize(kept);
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = newIndex[corner];
        }
    }
    return dropped;
}

}  // namespace sandflow
