#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/rational.hpp>

#include <span>

namespace maupertuis::series {

/// How a number type takes exact numbers. A type of more digits brings its own specialization (kernel/extended).
template <class T>
struct Exactly;

template <>
struct Exactly<double> {
  static double pi() { return 3.14159265358979323846; }
  static double from(const Rational& value) { return value.to_double(); }
};

/// f(x) of an elementary function of one argument, or f(x, y) of atan2.
template <class T>
T elementary(Kind function, const T& x, const T& y);

/// Any operation on numbers: sums, products, powers, functions, comparisons (1 or 0), piecewise.
template <class T>
T operation(Kind kind, std::span<const T> operands);

}  // namespace maupertuis::series
