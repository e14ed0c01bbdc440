#pragma once

#include <array>
#include <cstdint>

#include "core/vec3.h"

namespace sandflow {

/// What a settling grain touches: another grain, a wall or the floor.
struct Support {
    static constexpr std::int32_t kFloor = -5;  ///< walls are -1 .. -4

    std::int32_t id = 0;          ///< >= 0: index of the other grain
    Vec3 normal = Vec3::UnitZ();  ///< unit, from the support to the grain
    Vec3 centre = Vec3::Zero();   ///< of the other grain; for a flat support the point touched
    double reach = 0.0;           ///< sum of the radii; 0 for a flat support

    bool isFlat() const { return id < 0; }
};

/// The supports of a grain; a packing of unequal spheres needs three, rounding adds a few.
class SupportList {
public:
    static constexpr int kMost = 12;

    int size() const { return size_; }
    Support& operator[](int k) { return supports_[static_cast<std::size_t>(k)]; }
    const Support& operator[](int k) const { return supports_[static_cast<std::size_t>(k)]; }
    bool isFull() const { return size_ == kMost; }
    void add(const Support& support) { supports_[static_cast<std::size_t>(size_++)] = support; }
    bool has(std::int32_t id) const;
    void remove(int k)
    {
        supports_[static_cast<std::size_t>(k)] = supports_[static_cast<std::size_t>(--size_)];
    }

private:
    std::array<Support, kMost> supports_;
    int size_ = 0;
};

/// How a frictionless grain in contact with its supports goes on.
struct Motion {
    enum class Kind { rest, fall, rollOne, rollTwo, stuck };
    Kind kind = Kind::stuck;
    int first = -1;  ///< index of the support rolled on
    int second = -1;
};

/// The steepest feasible descent: -z projected onto the cone of velocities that leave every
/// support or slide along it. The projection is unique; it is found by trying which supports press.
Motion chooseMotion(const SupportList& supports);

/// Circular path of the centre: centre + radius (cos t up + sin t side), downhill as t grows.
struct Arc {
    Vec3 centre;
    double radius;
    Vec3 up;      ///< unit, towards the highest point of the circle
    Vec3 side;    ///< unit, in the circle's plane
    double from;  ///< t now
    double to;    ///< t where a support lets go

    Vec3 at(double t) const;
    /// Least and greatest coordinate over [from, to].
    void bounds(Vec3& lo, Vec3& hi) const;
};

/// Great circle over one sphere, down to its equator.
Arc arcOverOne(const Vec3& p, const Support& support);

/// Circle touching two supports, at most one of them flat, down to where one stops pressing.
/// False when the circle lies flat, so that there is no downhill.
bool arcOverTwo(const Vec3& p, const Support& a, const Support& b, Arc& arc);

/// First t in [from, from + 2 pi) at which a sin t + b cos t rises through c; huge if it never
/// does. From inside (above c) it is `from`.
double firstRise(double a, double b, double c, double from);

}  // namespace sandflow
