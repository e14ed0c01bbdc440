#pragma once

#include "core/small_vec.h"

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
