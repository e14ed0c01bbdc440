#pragma once

#include <cmath>

namespace sandflow {

/// Three numbers in registers. For inner loops, where an Eigen vector's alignment and expression
/// types get in the compiler's way; everything else uses Vec3.
template <class Real>
struct Vec {
    Real x{}, y{}, z{};

    constexpr Vec& operator+=(const Vec& b)
    {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vec& operator-=(const Vec& b)
    {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    constexpr Vec& operator*=(Real s)
    {
        x *= s;
        y *= s;
        z *= s;
        return *this;
    }
    friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
    friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
    friend constexpr Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec operator*(Vec a, Real s) { return a *= s; }
    friend constexpr Vec operator*(Real s, Vec a) { return a *= s; }
    friend constexpr bool operator==(const Vec& a, const Vec& b) = default;
};

template <class Real>
constexpr Real dot(const Vec<Real>& a, const Vec<Real>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
constexpr Vec<Real> cross(const Vec<Real>& a, const Vec<Real>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
inline Real length(const Vec<Real>& a)
{
    using std::sqrt;  // vectors of lanes bring their own
    return sqrt(dot(a, a));
}

/// a without its part along the unit vector n.
template <class Real>
constexpr Vec<Real> projectOff(const Vec<Real>& a, const Vec<Real>& n)
{
    return a - dot(a, n) * n;
}

}  // namespace sandflow
