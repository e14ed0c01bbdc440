#pragma once

#include "core/small_vec.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

/// What formulas need beyond operators so that one text serves a single number and a vector of
/// lanes: no branch on a value, only a choice between two values. Vector types bring their own
/// select, max and sqrt, found by argument-dependent lookup.
namespace sandflow {

/// The type in one lane of Real: Real itself, or Real::Number of a vector.
template <class Real>
struct NumberOf {
    using Type = Real;
};
template <class Real>
    requires requires { typename Real::Number; }
struct NumberOf<Real> {
    using Type = typename Real::Number;
};

/// 1 / sqrt(x) to a few units in the last place, for x >= 0; large but finite at 0.
/// Processors take as long for a root or a quotient as for twenty other operations, and their quick
/// estimates differ from maker to maker. So: an estimate from the bits of the number (halving the
/// exponent), then three steps of Newton's method, which square its error of 3 % to 1e-3, 2e-6 and
/// below what a float holds. The same bits wherever it runs.
namespace root_estimate {
inline constexpr std::uint32_t kBits = 0x5F3759DF;
template <class Real>
constexpr Real refine(Real estimate, Real x)
{
    const Real half = Real(0.5f) * x;
    for (int step = 0; step < 3; ++step) {
        estimate = estimate * (Real(1.5f) - half * estimate * estimate);
    }
    return estimate;
}
}  // namespace root_estimate

inline float inverseRoot(float x)
{
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return root_estimate::refine(std::bit_cast<float>(root_estimate::kBits - (bits >> 1)), x);
}
inline double inverseRoot(double x)
{
    return 1.0 / std::sqrt(x);
}

/// sqrt(x) as accurate as inverseRoot.
inline float root(float x)
{
    return x * inverseRoot(x);
}
inline double root(double x)
{
    return std::sqrt(x);
}

template <class Number>
    requires std::is_arithmetic_v<Number>
constexpr Number select(bool condition, Number yes, Number no)
{
    return condition ? yes : no;
}

template <class Condition, class Real>
constexpr Vec<Real> select(Condition condition, const Vec<Real>& yes, const Vec<Real>& no)
{
    return {select(condition, yes.x, no.x), select(condition, yes.y, no.y),
            select(condition, yes.z, no.z)};
}

}  // namespace sandflow
