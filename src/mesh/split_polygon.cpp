#include "mesh/split_polygon.h"

#include <algorithm>

namespace sandflow {
namespace {

double cross(const Vec2& a, const Vec2& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// Twice the area along the polygon's normal (Newell).
Vec3 doubleAreaOf(std::span<const Vec3> corners)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    }
    return sum;
}

/// Twice the area of the largest triangle at the first corner and the one farthest from it: 0 if
/// all lie on a line.
double spreadOf(std::span<const Vec3> corners)
{
    Vec3 farthest = Vec3::Zero();
    for (const Vec3& corner : corners) {
        if ((corner - corners[0]).squaredNorm() > farthest.squaredNorm()) {
            farthest = corner - corners[0];
        }
    }
    double widest = 0.0;
    for (const Vec3& corner : corners) {
        widest = std::max(widest, farthest.cross(corner - corners[0]).norm());
    }
    return widest;
}

/// How strict a cut must be; the milder ones are for polygons that touch themselves.
enum class Ear { clear, touched, flat };

/// Cuts off ears, triangles at a convex corner with no other corner inside, until three are left.
class EarCutter {
public:
    EarCutter(std::span<const Vec3> corners, const Vec3& normal)
    {
        Eigen::Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        const Eigen::Index u = (axis + 1) % 3;
        const Eigen::Index v = (axis + 2) % 3;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec2 p(corners[i][u], corners[i][v]);
            flat_.push_back(normal[axis] > 0.0 ? p : Vec2(-p.x(), p.y()));
            left_.push_back(static_cast<std::uint32_t>(i));
        }
    }

    bool cutAll(std::vector<std::array<std::uint32_t, 3>>& triangles)
    {
        while (left_.size() > 3) {
            if (!cutOne(Ear::clear, triangles) && !cutOne(Ear::touched, triangles) &&
                !cutOne(Ear::flat, triangles)) {
                return false;
            }
        }
        triangles.push_back({left_[0], left_[1], left_[2]});
        return turnAt(1) >= 0.0;
    }

private:
    std::size_t before(std::size_t i) const { return i == 0 ? left_.size() - 1 : i - 1; }
    std::size_t after(std::size_t i) const { return i + 1 == left_.size() ? 0 : i + 1; }

    /// Twice the area of the ear at place i of left_; negative at reflex corners.
    double turnAt(std::size_t i) const
    {
        const Vec2& tip = flat_[left_[i]];
        return cross(tip - flat_[left_[before(i)]], flat_[left_[after(i)]] - tip);
    }

    bool cutOne(Ear kind, std::vector<std::array<std::uint32_t, 3>>& triangles)
    {
        // Going on behind the last cut makes strips rather than a fan of needles.
        for (std::size_t k = 0; k < left_.size(); ++k) {
            const std::size_t i = (start_ + k) % left_.size();
            const double turn = turnAt(i);
            const bool shape = kind == Ear::flat ? turn == 0.0 : turn > 0.0;
            if (shape && (kind == Ear::flat || !anyInside(i, kind))) {
                triangles.push_back({left_[before(i)], left_[i], left_[after(i)]});
                left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
                start_ = i + 1;
                return true;
            }
        }
        return false;
    }

    /// Whether another corner lies in the ear: with Ear::clear on its rim counts too, but not at
    /// the place of one of its own corners.
    bool anyInside(std::size_t i, Ear kind) const
    {
        const Vec2& a = flat_[left_[before(i)]];
        const Vec2& b = flat_[left_[i]];
        const Vec2& c = flat_[left_[after(i)]];
        const Vec2 lo = a.cwiseMin(b).cwiseMin(c);
        const Vec2 hi = a.cwiseMax(b).cwiseMax(c);
        return std::any_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
            const Vec2& p = flat_[other];
            // Most are far away.
            if (p.x() < lo.x() || p.x() > hi.x() || p.y() < lo.y() || p.y() > hi.y() || p == a ||
                p == b || p == c) {
                return false;
            }
            const double least =
                std::min({cross(b - a, p - a), cross(c - b, p - b), cross(a - c, p - c)});
            return kind == Ear::clear ? least >= 0.0 : least > 0.0;
        });
    }

    std::vector<Vec2> flat_;           ///< the corners seen along the normal
    std::vector<std::uint32_t> left_;  ///< those not cut off yet, in their order
    std::size_t start_ = 0;
};

}  // namespace

bool splitPolygon(std::span<const Vec3> corners,
                  std::vector<std::array<std::uint32_t, 3>>& triangles)
{
    triangles.clear();
    const auto count = static_cast<std::uint32_t>(corners.size());
    if (count == 3) {
        triangles.push_back({0, 1, 2});
        return true;
    }
    const Vec3 doubleArea = doubleAreaOf(corners);
    const double spread = spreadOf(corners);
    // Of a polygon that has an area; less is rounding or lobes that cancel.
    constexpr double kLeastShare = 1e-6;
    if (doubleArea.norm() > kLeastShare * spread) {
        return EarCutter(corners, doubleArea).cutAll(triangles);
    }
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
        triangles.push_back({0, i, i + 1});
    }
    double length2 = 0.0;
    for (const Vec3& corner : corners) {
        length2 = std::max(length2, (corner - corners[0]).squaredNorm());
    }
    return spread <= kLeastShare * length2;
}

}  // namespace sandflow
