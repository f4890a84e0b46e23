#pragma once
#include "kernel/reference/elementary.hpp"

#include <maupertuis/functions.hpp>

#include <cmath>

namespace maupertuis::reference {
namespace on_constants {

template <class T>
T sign(const T& x) {
  return T((x > 0) - (x < 0));
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

}  // namespace on_constants

template <class T>
T elementary(Kind function, const T& x, const T& y) {
  using std::abs, std::atan2;
  if (is_function(function)) return functions::value(function, x);
  if (function == Kind::Abs) return abs(x);
  if (function == Kind::Sign) return on_constants::sign(x);
  if (function == Kind::Step) return T(x >= 0 ? 1 : 0);
  if (function == Kind::Atan2) return atan2(x, y);
  throw unknown_kind(function, "the interpreter");
}

template <class T>
T constant_operation(Kind kind, std::span<const T> operands) {
  using namespace on_constants;
  if (kind == Kind::Pi) return Exactly<T>::pi();
  if (kind == Kind::Sum) return sum(operands);
  if (kind == Kind::Product) return product(operands);
  if (kind == Kind::Power) return power(operands[0], operands[1]);
  if (kind == Kind::Min) return operands[0] <= operands[1] ? operands[0] : operands[1];
  if (kind == Kind::Max) return operands[0] >= operands[1] ? operands[0] : operands[1];
  if (kind == Kind::Less) return T(operands[0] < operands[1]);
  if (kind == Kind::LessEqual) return T(operands[0] <= operands[1]);
  if (kind == Kind::And) return T(all(operands));
  if (kind == Kind::Or) return T(any(operands));
  if (kind == Kind::Piecewise) return piecewise(operands);
  return elementary(kind, operands[0], operands.size() > 1 ? operands[1] : T(0));  // throws on others
}

}  // namespace maupertuis::reference
