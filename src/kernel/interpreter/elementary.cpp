#include "kernel/interpreter/elementary.hpp"

#include <cmath>
#include <stdexcept>

namespace maupertuis::interpreter {
namespace {

double sign(double x) { return static_cast<double>((x > 0) - (x < 0)); }

double power(double base, double exponent) {
  if (exponent == 0.5) return std::sqrt(base);
  if (exponent == -1) return 1 / base;
  return std::pow(base, exponent);
}

double piecewise(std::span<const double> operands) {
  for (std::size_t i = 0; i + 1 < operands.size(); i += 2)
    if (operands[i] != 0) return operands[i + 1];
  return operands.back();
}

double sum(std::span<const double> operands) {
  double result = 0;
  for (const double x : operands) result += x;
  return result;
}

double product(std::span<const double> operands) {
  double result = 1;
  for (const double x : operands) result *= x;
  return result;
}

bool all(std::span<const double> operands) {
  for (const double x : operands) if (x == 0) return false;
  return true;
}

bool any(std::span<const double> operands) {
  for (const double x : operands) if (x != 0) return true;
  return false;
}

}  // namespace

double elementary(Kind function, double x, double y) {
  switch (function) {
    case Kind::Sin: return std::sin(x);
    case Kind::Cos: return std::cos(x);
    case Kind::Tan: return std::tan(x);
    case Kind::Asin: return std::asin(x);
    case Kind::Acos: return std::acos(x);
    case Kind::Atan: return std::atan(x);
    case Kind::Sinh: return std::sinh(x);
    case Kind::Cosh: return std::cosh(x);
    case Kind::Tanh: return std::tanh(x);
    case Kind::Asinh: return std::asinh(x);
    case Kind::Acosh: return std::acosh(x);
    case Kind::Atanh: return std::atanh(x);
    case Kind::Exp: return std::exp(x);
    case Kind::Log: return std::log(x);
    case Kind::Abs: return std::abs(x);
    case Kind::Sign: return sign(x);
    case Kind::Step: return x >= 0 ? 1 : 0;
    case Kind::Atan2: return std::atan2(x, y);
    default: throw std::logic_error("the interpreter met a function that it does not know; please report");
  }
}

double constant_operation(Kind kind, std::span<const double> operands) {
  switch (kind) {
    case Kind::Pi: return 3.14159265358979323846;
    case Kind::Sum: return sum(operands);
    case Kind::Product: return product(operands);
    case Kind::Power: return power(operands[0], operands[1]);
    case Kind::Min: return operands[0] <= operands[1] ? operands[0] : operands[1];
    case Kind::Max: return operands[0] >= operands[1] ? operands[0] : operands[1];
    case Kind::Less: return operands[0] < operands[1];
    case Kind::LessEqual: return operands[0] <= operands[1];
    case Kind::And: return all(operands);
    case Kind::Or: return any(operands);
    case Kind::Piecewise: return piecewise(operands);
    default: return elementary(kind, operands[0], operands.size() > 1 ? operands[1] : 0);
  }
}

}  // namespace maupertuis::interpreter
