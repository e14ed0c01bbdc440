#include "emit/drop_and_roll.h"

#include <array>
#include <cmath>
#include <limits>

#include "emit/roll_path.h"

namespace sandflow {

namespace {

/// Legs of a path before it is given up; usual ones have about ten.
constexpr int kMostLegs = 300;

/// Two surfaces nearer than this share of the largest radius touch.
constexpr double kTouching = 1e-10;

/// One grain on its way down.
class Descent {
public:
    Descent(const SettlingRegion& region, const BallGrid& grid, double largest, double radius)
        : region_(region),
          grid_(grid),
          largest_(largest),
          radius_(radius),
          inner_{region.lo.x() + radius, region.hi.x() - radius, region.lo.y() + radius,
                 region.hi.y() - radius}
    {
    }

    std::optional<Vec3> run(double x, double y)
    {
        p_ = Vec3(x, y, std::numeric_limits<double>::max());
        fall();
        for (int leg = 0; leg < kMostLegs; ++leg) {
            const Motion motion = chooseMotion(supports_);
            switch (motion.kind) {
                case Motion::Kind::rest:
                    return p_;
                case Motion::Kind::fall:
                    fall();
                    break;
                case Motion::Kind::rollOne:
                    roll(arcOverOne(p_, supports_[motion.first]), supports_[motion.first].id,
                         supports_[motion.first].id);
                    break;
                case Motion::Kind::rollTwo: {
                    Arc arc;
                    if (!arcOverTwo(p_, supports_[motion.first], supports_[motion.second], arc)) {
                        return std::nullopt;
                    }
                    roll(arc, supports_[motion.first].id, supports_[motion.second].id);
                    break;
                }
                case Motion::Kind::stuck:
                    return std::nullopt;
            }
            if (supports_.isFull() || leftRegion()) {
                return std::nullopt;
            }
        }
        return std::nullopt;
    }

private:
    bool leftRegion() const
    {
        return !region_.walls && ((p_.head<2>() - region_.lo).minCoeff() < 0.0 ||
                                  (region_.hi - p_.head<2>()).minCoeff() < 0.0);
    }

    /// Straight down to the first contact; the floor is always there.
    void fall()
    {
        double best = region_.floor + radius_;
        std::int32_t hit = Support::kFloor;
        const double reachMost = radius_ + largest_;
        grid_.forEachBelow(
            p_.head<2>(), reachMost, p_.z() + reachMost,
            [&](std::int32_t b, const BallGrid::Ball& ball) {
                const double reach = radius_ + ball.radius;
                const double square = reach * reach - (ball.centre - p_).head<2>().squaredNorm();
                if (square <= 0.0) {
                    return;
                }
                const double z = ball.centre.z() + std::sqrt(square);
                if (z > best && z <= p_.z() && !supports_.has(b)) {
                    best = z;
                    hit = b;
                }
            },
            [&](double bottom) { return best < bottom + reachMost; });
        p_.z() = best;
        keepTouching(hit, hit);
        addSupport(hit);
    }

    /// Along the arc to its end or the first contact before it.
    void roll(const Arc& arc, std::int32_t first, std::int32_t second)
    {
        double end = arc.to;
        std::int32_t hit = 0;
        bool any = false;
        const auto consider = [&](std::int32_t id, double a, double b, double c) {
            const double t = firstRise(a, b, c, arc.from);
            if (t < end) {
                end = t;
                hit = id;
                any = true;
            }
        };

        // Distance of the centre to a grain at d from the arc's centre is its reach where
        // d.side sin t + d.up cos t = (rho^2 + d^2 - reach^2) / (2 rho).
        Vec3 lo, hi;
        arc.bounds(lo, hi);
        const double reachMost = radius_ + largest_;
        grid_.forEachIn(
            lo - Vec3::Constant(reachMost), hi + Vec3::Constant(reachMost),
            [&](std::int32_t b, const BallGrid::Ball& ball) {
                const double reach = radius_ + ball.radius;
                const Vec3 d = ball.centre - arc.centre;
                const double square = d.squaredNorm();
                const double farthest = arc.radius + reach;
                if (square >= farthest * farthest || supports_.has(b)) {
                    return;
                }
                consider(b, d.dot(arc.side), d.dot(arc.up),
                         (arc.radius * arc.radius + square - reach * reach) / (2.0 * arc.radius));
            });
        for (std::int32_t wall = region_.walls ? -4 : 0; wall < 0; ++wall) {
            if (!supports_.has(wall)) {
                const Vec3 into = -wallNormal(wall);
                consider(wall, into.dot(arc.side), into.dot(arc.up),
                         (wallPoint(wall) - arc.centre).dot(into) / arc.radius);
            }
        }
        consider(Support::kFloor, -arc.side.z(), -arc.up.z(),
                 (arc.centre.z() - region_.floor - radius_) / arc.radius);

        p_ = arc.at(end);
        keepTouching(first, second);
        if (any) {
            addSupport(hit);
        }
    }

    Vec3 wallNormal(std::int32_t wall) const
    {
        switch (wall) {
            case -1:
                return Vec3::UnitX();
            case -2:
                return -Vec3::UnitX();
            case -3:
                return Vec3::UnitY();
            case -4:
                return -Vec3::UnitY();
            default:
                return Vec3::UnitZ();
        }
    }

    /// A point of the plane on which the centre of a grain touching the wall lies.
    Vec3 wallPoint(std::int32_t wall) const
    {
        Vec3 point = p_;
        if (wall == Support::kFloor) {
            point.z() = region_.floor + radius_;
        } else {
            point[wall >= -2 ? 0 : 1] = inner_[static_cast<std::size_t>(-wall - 1)];
        }
        return point;
    }

    void addSupport(std::int32_t id)
    {
        Support support;
        support.id = id;
        if (id < 0) {
            support.normal = wallNormal(id);
            support.centre = wallPoint(id);
        } else {
            const BallGrid::Ball& ball = grid_.ball(id);
            support.centre = ball.centre;
            support.reach = radius_ + ball.radius;
            support.normal = (p_ - ball.centre).normalized();
        }
        supports_.add(support);
    }

    /// After a move: forgets supports that were left, keeps `first` and `second` in any case.
    void keepTouching(std::int32_t first, std::int32_t second)
    {
        for (int k = supports_.size() - 1; k >= 0; --k) {
            Support& support = supports_[k];
            double gap = 0.0;
            if (support.isFlat()) {
                support.centre = wallPoint(support.id);
                gap = (p_ - support.centre).dot(support.normal);
            } else {
                const Vec3 away = p_ - support.centre;
                const double distance = away.norm();
                support.normal = away / distance;
                gap = distance - support.reach;
            }
            if (gap > kTouching * largest_ && support.id != first && support.id != second) {
                supports_.remove(k);
            }
        }
    }

    const SettlingRegion& region_;
    const BallGrid& grid_;
    double largest_, radius_;
    std::array<double, 4> inner_;  ///< walls moved in by the radius: x low, high, y low, high
    Vec3 p_;
    SupportList supports_;
};

}  // namespace

DropAndRoll::DropAndRoll(const SettlingRegion& region, double largestRadius)
    : region_(region),
      largest_(largestRadius),
      grid_(region.lo, region.hi, region.floor, 2.0 * largestRadius)
{
}

std::optional<Vec3> DropAndRoll::settle(double x, double y, double radius) const
{
    const std::optional<Vec3> rest = Descent(region_, grid_, largest_, radius).run(x, y);
    if (!rest) {
        return rest;
    }
    // The paths are exact up to rounding; a place that is not is refused rather than kept.
    const double slack = radius - kTouching * largest_;
    bool overlaps = rest->z() - region_.floor < slack;
    if (region_.walls) {
        overlaps = overlaps || (rest->head<2>() - region_.lo).minCoeff() < slack ||
                   (region_.hi - rest->head<2>()).minCoeff() < slack;
    }
    const double reachMost = radius + largest_;
    grid_.forEachIn(*rest - Vec3::Constant(reachMost), *rest + Vec3::Constant(reachMost),
                    [&](std::int32_t, const BallGrid::Ball& ball) {
                        const double gap = (ball.centre - *rest).norm() - radius - ball.radius;
                        overlaps = overlaps || gap < -kTouching * largest_;
                    });
    return overlaps ? std::nullopt : rest;
}

}  // namespace sandflow
