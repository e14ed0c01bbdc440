#pragma once

#include "core/errors.h"
#include "core/vec3.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace sandflow {

/// From where to where something reaches along a direction, m.
struct Extent {
    double from;
    double to;

    double size() const { return to - from; }
    double middle() const { return 0.5 * (from + to); }
};

/// A convex piece of a triangle, cut out of it by lines along two directions at right angles: so it
/// has seven corners at most, three of the triangle's and four of the cuts'.
///
/// Not a triangle itself: halving a needle into triangles that are half as long takes three, and a
/// thousandth of the length 3^10 instead of 2^10.
class FlatPiece {
public:
    /// Without corners; their places are filled all the same, as copies read them.
    FlatPiece() { corners_.fill(Vec3::Zero()); }

    FlatPiece(const Vec3& a, const Vec3& b, const Vec3& c) : FlatPiece()
    {
        count_ = 3;
        corners_[0] = a;
        corners_[1] = b;
        corners_[2] = c;
    }

    std::size_t count() const { return count_; }
    const Vec3& corner(std::size_t k) const { return corners_[k]; }

    /// True if no corner is farther from `centre` than the root of `distance2`.
    bool isWithin(double distance2, const Vec3& centre) const
    {
        return std::all_of(corners_.begin(), corners_.begin() + count_, [&](const Vec3& corner) {
            return (corner - centre).squaredNorm() <= distance2;
        });
    }

    Extent extentAlong(const Vec3& direction) const
    {
        Extent extent{direction.dot(corners_[0]), direction.dot(corners_[0])};
        for (std::size_t k = 1; k < count_; ++k) {
            const double at = direction.dot(corners_[k]);
            extent = {std::min(extent.from, at), std::max(extent.to, at)};
        }
        return extent;
    }

    /// The mean of the corners; it lies in the piece.
    Vec3 middle() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < count_; ++k) {
            sum += corners_[k];
        }
        return sum / static_cast<double>(count_);
    }

    /// The parts below and above `level` along a direction; the level must lie within the extent.
    std::pair<FlatPiece, FlatPiece> cutAt(const Vec3& direction, double level) const
    {
        std::pair<FlatPiece, FlatPiece> halves;
        for (std::size_t k = 0; k < count_; ++k) {
            const Vec3& here = corners_[k];
            const Vec3& next = corners_[k + 1 < count_ ? k + 1 : 0];
            const double over = direction.dot(here) - level;
            const double nextOver = direction.dot(next) - level;
            if (over <= 0.0) {
                halves.first.append(here);
            }
            if (over >= 0.0) {
                halves.second.append(here);
            }
            if ((over < 0.0 && nextOver > 0.0) || (over > 0.0 && nextOver < 0.0)) {
                const Vec3 crossing = here + (over / (over - nextOver)) * (next - here);
                halves.first.append(crossing);
                halves.second.append(crossing);
            }
        }
        return halves;
    }

private:
    // A few more than seven: by rounding, corners that should be one may come as two.
    static constexpr std::size_t kMostCorners = 12;

    void append(const Vec3& corner)
    {
        SAND_CHECK(count_ < kMostCorners, "a piece of a triangle has more corners than {}", count_);
        corners_[count_++] = corner;
    }

    std::array<Vec3, kMostCorners> corners_;
    std::size_t count_ = 0;
};

/// The direction of a triangle's longest edge and that at right angles to it in its plane, of unit
/// length; zero where it has no such extent.
inline std::pair<Vec3, Vec3> sidesOf(Vec3 a, Vec3 b, Vec3 c)
{
    const double ab2 = (b - a).squaredNorm();
    const double bc2 = (c - b).squaredNorm();
    const double ca2 = (a - c).squaredNorm();
    // Turned so that a-b is the longest edge.
    if (bc2 > ab2 && bc2 >= ca2) {
        std::swap(a, c);
    } else if (ca2 > ab2) {
        std::swap(b, c);
    }
    const auto unit = [](const Vec3& v) {
        const double length = v.norm();
        return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
    };
    const Vec3 along = unit(b - a);
    const Vec3 aside = c - a;
    return {along, unit(aside - aside.dot(along) * along)};
}

}  // namespace sandflow
