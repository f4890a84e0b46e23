#pragma once
#include "kernel/interpreter/elementary.hpp"

#include <cmath>
#include <stdexcept>

namespace maupertuis::interpreter {
namespace on_constants {

template <class T>
T sign(const T& x) { return T((x > 0) - (x < 0)); }

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
  for (const T& x : operands) if (x == 0) return false;
  return true;
}

template <class T>
bool any(std::span<const T> operands) {
  for (const T& x : operands) if (x != 0) return true;
  return false;
}

}  // namespace on_constants

template <class T>
T elementary(Kind function, const T& x, const T& y) {
  using std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh, std::cosh, std::tanh, std::asinh,
      std::acosh, std::atanh, std::exp, std::log, std::abs, std::atan2;
  switch (function) {
    case Kind::Sin: return sin(x);
    case Kind::Cos: return cos(x);
    case Kind::Tan: return tan(x);
    case Kind::Asin: return asin(x);
    case Kind::Acos: return acos(x);
    case Kind::Atan: return atan(x);
    case Kind::Sinh: return sinh(x);
    case Kind::Cosh: return cosh(x);
    case Kind::Tanh: return tanh(x);
    case Kind::Asinh: return asinh(x);
    case Kind::Acosh: return acosh(x);
    case Kind::Atanh: return atanh(x);
    case Kind::Exp: return exp(x);
    case Kind::Log: return log(x);
    case Kind::Abs: return abs(x);
    case Kind::Sign: return on_constants::sign(x);
    case Kind::Step: return T(x >= 0 ? 1 : 0);
    case Kind::Atan2: return atan2(x, y);
    default: throw std::logic_error("the interpreter met a function that it does not know; please report");
  }
}

template <class T>
T constant_operation(Kind kind, std::span<const T> operands) {
  using namespace on_constants;
  switch (kind) {
    case Kind::Pi: return Exactly<T>::pi();
    case Kind::Sum: return sum(operands);
    case Kind::Product: return product(operands);
    case Kind::Power: return power(operands[0], operands[1]);
    case Kind::Min: return operands[0] <= operands[1] ? operands[0] : operands[1];
    case Kind::Max: return operands[0] >= operands[1] ? operands[0] : operands[1];
    case Kind::Less: return T(operands[0] < operands[1]);
    case Kind::LessEqual: return T(operands[0] <= operands[1]);
    case Kind::And: return T(all(operands));
    case Kind::Or: return T(any(operands));
    case Kind::Piecewise: return piecewise(operands);
    default: return elementary(kind, operands[0], operands.size() > 1 ? operands[1] : T(0));
  }
}

}  // namespace maupertuis::interpreter
