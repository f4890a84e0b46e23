#pragma once
#include "symbolic/evaluate/evaluator.hpp"

#include <maupertuis/functions.hpp>

#include <cmath>
#include <functional>
#include <optional>

namespace maupertuis::evaluation {

/// Numbers of a real type: double, an interval, 100 digits. The type brings its functions by overloads of sin, pow,
/// … found beside it, and three more: `from_rational(Real&, const Rational&)`, `set_pi(Real&)`, and `less`, which
/// may not know. A switch that is not known gives `unknown_between`.
inline void from_rational(double& out, const Rational& value) { out = value.to_double(); }
inline void set_pi(double& out) { out = 3.14159265358979323846; }
inline std::optional<bool> less(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::nullopt;
  return a < b;
}
inline double unknown_between(double, double) { return std::nan(""); }
inline double integer_power(double x, long n) { return std::pow(x, static_cast<double>(n)); }
inline double real_power(double x, double y) { return std::pow(x, y); }
/// x^y of a constant y, which is `exponent`.
template <class Real>
Real constant_power(const Real& x, const Rational&, const Real& y) {
  return real_power(x, y);
}

template <class Real>
class RealNumbers {
 public:
  using Value = Real;
  using Lookup = std::function<Real(Expr)>;

  explicit RealNumbers(Lookup symbols) : symbols_(std::move(symbols)) {}

  Real number(const Rational& value) const {
    Real out;
    from_rational(out, value);
    return out;
  }
  Real pi() const {
    Real out;
    set_pi(out);
    return out;
  }
  Real symbol(Expr e) const { return symbols_(e); }
  Real add(const Real& a, const Real& b) const { return a + b; }
  Real subtract(const Real& a, const Real& b) const { return a - b; }
  Real multiply(const Real& a, const Real& b) const { return a * b; }
  Real negate(const Real& a) const { return -a; }
  Real inverse(const Real& a) const { return number(1) / a; }

  Real function(const Tape& tape, Position at, const std::vector<Real>& v) const {
    const auto arg = [&](std::size_t i) -> const Real& { return v[tape.argument(at, i)]; };
    const Kind kind = tape.kind(at);
    switch (family_of(kind)) {
      case Family::Function:
        return functions::value(kind, arg(0));
      case Family::Switch:
        return with_switch(kind, arg(0));
      case Family::Angle: {
        using std::atan2;
        return atan2(arg(0), arg(1));
      }
      case Family::Extremum:
        return choose(kind == Kind::Min ? less(arg(1), arg(0)) : less(arg(0), arg(1)), arg(1), arg(0));
      case Family::Piecewise:
        return piecewise(tape, at, v);
      case Family::Comparison:
      case Family::Logic:
        return number(0);  // asked by `holds`
      case Family::Algebra:
        if (kind == Kind::Power) return power(tape, at, v);
        break;
      case Family::Leaf:
      case Family::TimeDerivative:
        break;
    }
    throw unknown_kind(kind, "an evaluation over real numbers");
  }

  std::optional<bool> holds(const Tape& tape, Position at, const std::vector<Real>& v) const {
    const Position a = tape.argument(at, 0), b = tape.argument(at, 1);
    if (tape.kind(at) == Kind::Less) return less(v[a], v[b]);
    if (tape.kind(at) == Kind::LessEqual) {
      const auto greater = less(v[b], v[a]);
      return greater ? std::optional<bool>(!*greater) : std::nullopt;
    }
    const auto first = holds(tape, a, v), second = holds(tape, b, v);
    const bool decisive = tape.kind(at) == Kind::Or;  // `true` decides an or, `false` an and
    if ((first && *first == decisive) || (second && *second == decisive)) return decisive;
    return first && second ? std::optional<bool>(!decisive) : std::nullopt;
  }

 private:
  static Real choose(std::optional<bool> condition, const Real& yes, const Real& no) {
    return condition ? (*condition ? yes : no) : unknown_between(yes, no);
  }

  Real power(const Tape& tape, Position at, const std::vector<Real>& v) const {
    const Position base = tape.argument(at, 0), exponent = tape.argument(at, 1);
    const Rational* number = tape.expression(exponent).number_or_null();
    if (!number) return real_power(v[base], v[exponent]);
    if (const auto n = number->as_integer()) return integer_power(v[base], *n);
    using std::sqrt;
    if (*number == Rational(1, 2)) return sqrt(v[base]);
    return constant_power(v[base], *number, v[exponent]);
  }

  Real piecewise(const Tape& tape, Position at, const std::vector<Real>& v) const {
    const auto arguments = tape.arguments(at);
    for (std::size_t i = 0; i + 1 < arguments.size(); i += 2) {
      const auto condition = holds(tape, arguments[i], v);
      if (!condition) {
        Real hull = v[arguments[i + 1]];
        for (std::size_t j = i + 2; j < arguments.size(); ++j)
          if (!is_condition(j, arguments.size())) hull = unknown_between(hull, v[arguments[j]]);
        return hull;
      }
      if (*condition) return v[arguments[i + 1]];
    }
    return v[arguments.back()];
  }

  Real sign(const Real& x) const {
    const Real zero = number(0);
    const auto negative = less(x, zero), positive = less(zero, x);
    if (!negative || !positive) return unknown_between(number(-1), number(1));
    return number(*positive ? 1 : *negative ? -1 : 0);
  }

  Real with_switch(Kind kind, const Real& x) const {
    using std::abs;
    if (kind == Kind::Abs) return abs(x);
    if (kind == Kind::Sign) return sign(x);
    if (kind == Kind::Step) return choose(less(x, number(0)), number(0), number(1));
    throw unknown_kind(kind, "an evaluation over real numbers");
  }

  Lookup symbols_;
};

}  // namespace maupertuis::evaluation
