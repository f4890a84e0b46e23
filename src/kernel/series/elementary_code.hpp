#pragma once
#include "kernel/series/elementary.hpp"

#include <maupertuis/functions.hpp>

#include <cmath>

namespace maupertuis::series {
namespace on_numbers {

/// What is no number stays none: a comparison with it must not choose a side in silence.
template <class T>
T sign(const T& x) {
  return x > 0 ? T(1) : x < 0 ? T(-1) : x;
}
template <class T>
T step(const T& x) {
  return x >= 0 ? T(1) : x < 0 ? T(0) : x;
}
template <class T>
T smaller(const T& x, const T& y) {
  return y < x || y != y ? y : x;
}
template <class T>
T larger(const T& x, const T& y) {
  return y > x || y != y ? y : x;
}

template <class T>
T power(const T& base, const T& exponent) {
  using std::sqrt, std::pow;
  if (exponent == T(0.5)) return sqrt(base);
  if (exponent == -1) return 1 / base;
  return pow(base, exponent);
}

template <class T>
T piecewise(std::span<const T> operands) {
  for (std::size_t i = 0; i + 1 < operands.size(); i += 2)
    if (operands[i] != 0) return operands[i + 1];
  return operands.back();
}

template <class T>
T sum(std::span<const T> operands) {
  T result = T(0);
  for (const T& x : operands) result += x;
  return result;
}

template <class T>
T product(std::span<const T> operands) {
  T result = T(1);
  for (const T& x : operands) result *= x;
  return result;
}

template <class T>
bool all(std::span<const T> operands) {
  for (const T& x : operands)
    if (x == 0) return false;
  return true;
}

template <class T>
bool any(std::span<const T> operands) {
  for (const T& x : operands)
    if (x != 0) return true;
  return false;
}

}  // namespace on_numbers

template <class T>
T elementary(Kind function, const T& x, const T& y) {
  using std::abs, std::atan2;
  if (is_function(function)) return functions::value(function, x);
  if (function == Kind::Abs) return abs(x);
  if (function == Kind::Sign) return on_numbers::sign(x);
  if (function == Kind::Step) return on_numbers::step(x);
  if (function == Kind::Atan2) return atan2(x, y);
  throw unknown_kind(function, "the operations on numbers");
}

template <class T>
T operation(Kind kind, std::span<const T> operands) {
  using namespace on_numbers;
  if (kind == Kind::Pi) return Exactly<T>::pi();
  if (kind == Kind::Sum) return sum(operands);
  if (kind == Kind::Product) return product(operands);
  if (kind == Kind::Power) return power(operands[0], operands[1]);
  if (kind == Kind::Min) return smaller(operands[0], operands[1]);
  if (kind == Kind::Max) return larger(operands[0], operands[1]);
  if (kind == Kind::Less) return T(operands[0] < operands[1]);
  if (kind == Kind::LessEqual) return T(operands[0] <= operands[1]);
  if (kind == Kind::And) return T(all(operands));
  if (kind == Kind::Or) return T(any(operands));
  if (kind == Kind::Piecewise) return piecewise(operands);
  return elementary(kind, operands[0], operands.size() > 1 ? operands[1] : T(0));  // throws on others
}

}  // namespace maupertuis::series
