#pragma once
#include "symbolic/evaluate/evaluator.hpp"

#include <maupertuis/kinds.hpp>

#include <array>
#include <functional>

namespace maupertuis::evaluation {

/// A truncated power series in t with first-order variations beside it: x(t) + Σ ε_e δ_e x(t), products of two ε
/// dropped. Part 0 is the series itself, part e its e-th variation.
template <class Scalar>
struct Jet {
  static constexpr std::size_t max_orders = 6, parts = 4;
  std::array<std::array<Scalar, max_orders>, parts> c{};

  const Scalar& operator()(std::size_t part, std::size_t order) const { return c[part][order]; }
  Scalar& operator()(std::size_t part, std::size_t order) { return c[part][order]; }
};

/// Jets over any numbers that are a field with elementary functions: a prime field, 100 digits.
///
/// The rules stand here from the series' own recurrences (f' = f x' for exp, f' = x'/x for log, …) and share nothing
/// with the symbolic derivatives. Functions are asked of the base numbers at order 0 only, so that two routes to the
/// same value agree in the branch of every root and the side of every switch.
template <class Base>
class JetNumbers {
 public:
  using Scalar = typename Base::Value;
  using Value = Jet<Scalar>;
  using Lookup = std::function<Value(Expr)>;

  /// `orders` coefficients of t are kept. Precondition: orders <= Jet::max_orders.
  JetNumbers(Base& base, std::size_t orders, Lookup symbols)
      : base_(base), orders_(orders), zero_(base.number(0)), symbols_(std::move(symbols)) {
    for (std::size_t k = 0; k <= Value::max_orders; ++k) {
      integers_[k] = base.number(static_cast<std::int64_t>(k));
      reciprocals_[k] = k == 0 ? zero_ : base.inverse(integers_[k]);
    }
  }

  Value constant(const Scalar& value) const {
    Value out;
    for (auto& part : out.c) part.fill(zero_);
    out(0, 0) = value;
    return out;
  }
  Value number(const Rational& value) const { return constant(base_.number(value)); }
  Value pi() const { return constant(base_.pi()); }
  Value symbol(Expr e) const { return symbols_(e); }

  Value add(const Value& a, const Value& b) const {
    return each([&](std::size_t p, std::size_t k) { return base_.add(a(p, k), b(p, k)); });
  }
  Value negate(const Value& a) const {
    return each([&](std::size_t p, std::size_t k) { return base_.negate(a(p, k)); });
  }
  Value subtract(const Value& a, const Value& b) const { return add(a, negate(b)); }
  Value scale(const Value& a, const Scalar& factor) const {
    return each([&](std::size_t p, std::size_t k) { return base_.multiply(a(p, k), factor); });
  }
  Value multiply(const Value& a, const Value& b) const {
    return each([&](std::size_t p, std::size_t k) {
      Scalar sum = convolution(a, 0, b, p, k);
      return p == 0 ? sum : base_.add(sum, convolution(a, p, b, 0, k));
    });
  }
  /// d/dt, of every part. The last coefficient is lost (0).
  Value derivative(const Value& a) const {
    return each([&](std::size_t p, std::size_t k) {
      return k + 1 < orders_ ? times(static_cast<long>(k + 1), a(p, k + 1)) : zero_;
    });
  }
  Value inverse(const Value& a) const {
    const Scalar first = base_.inverse(a(0, 0));
    Value out = constant(first);
    for (std::size_t k = 1; k < orders_; ++k) {
      Scalar sum = zero_;
      for (std::size_t j = 1; j <= k; ++j) sum = base_.add(sum, base_.multiply(a(0, j), out(0, k - j)));
      out(0, k) = base_.negate(base_.multiply(sum, first));
    }
    const Value slope = negate(multiply(series(out), series(out)));
    return with_variations(out, slope, a);
  }

  Value function(const Tape& tape, Position at, const std::vector<Value>& values) {
    copy_leading(tape, values, at);
    const Position argument = tape.argument(at, 0);
    const Value& x = values[argument];
    const auto one = [&] { return number(1); };
    const auto square = [&] { return multiply(x, x); };
    const auto leading = [&] { return base_.function(tape, at, leading_); };
    switch (tape.kind(at)) {
      case Kind::TimeDerivative:
        return derivative(x);
      case Kind::Power:
        return power(tape, at, values);
      case Kind::Sin:
        return cos_sin(tape, argument, x).second;
      case Kind::Cos:
        return cos_sin(tape, argument, x).first;
      case Kind::Tan: {
        const auto [cosine, sine] = cos_sin(tape, argument, x);
        return multiply(sine, inverse(cosine));
      }
      case Kind::Exp:
        return exponential(leading(), x);
      case Kind::Sinh:
      case Kind::Cosh:
      case Kind::Tanh: {
        const Value e = exponential(base_.exponential(tape, argument, leading_), x), f = inverse(e);
        const Scalar half = base_.number(Rational(1, 2));
        const Value sinh = scale(subtract(e, f), half), cosh = scale(add(e, f), half);
        if (tape.kind(at) == Kind::Tanh) return multiply(sinh, inverse(cosh));
        return tape.kind(at) == Kind::Sinh ? sinh : cosh;
      }
      case Kind::Log:
        return integral(leading(), inverse(x), x);
      case Kind::Atan:
        return integral(leading(), inverse(add(one(), square())), x);
      case Kind::Atanh:
        return integral(leading(), inverse(subtract(one(), square())), x);
      case Kind::Asin:
        return integral(leading(), inverse_root(subtract(one(), square())), x);
      case Kind::Acos:
        return integral(leading(), negate(inverse_root(subtract(one(), square()))), x);
      case Kind::Asinh:
        return integral(leading(), inverse_root(add(square(), one())), x);
      case Kind::Acosh:
        return integral(leading(), inverse_root(subtract(square(), one())), x);
      case Kind::Erf: {  // f' = 2/√π exp(−x²) x'
        const Scalar factor = base_.multiply(base_.number(2), base_.inverse(base_.square_root(base_.pi())));
        return integral(leading(), scale(values[tape.gaussian(at)], factor), x);
      }
      case Kind::LambertW:
        return lambert_w(leading(), x);
      case Kind::Atan2:
        return atan2(leading(), x, values[tape.argument(at, 1)]);
      case Kind::Abs:
        return base_.sign(argument, x(0, 0)) < 0 ? negate(x) : x;
      case Kind::Sign:
      case Kind::Step:
        return constant(leading());
      case Kind::Min:
      case Kind::Max: {
        const Value& y = values[tape.argument(at, 1)];
        return chosen_first(leading(), x(0, 0)) ? x : y;
      }
      case Kind::Piecewise:
        return piecewise(tape, at, values);
      case Kind::Less:
      case Kind::LessEqual:
      case Kind::And:
      case Kind::Or:
        return constant(zero_);  // asked by `holds` of the base
      case Kind::Number:
      case Kind::Pi:
      case Kind::Symbol:
      case Kind::Sum:
      case Kind::Product:
        break;
    }
    throw unknown_kind(tape.kind(at), "a series");
  }

  Base& base() { return base_; }
  std::size_t orders() const { return orders_; }

 private:
  template <class F>
  Value each(F f) const {
    Value out;
    for (std::size_t p = 0; p < Value::parts; ++p)
      for (std::size_t k = 0; k < orders_; ++k) out(p, k) = f(p, k);
    return out;
  }

  Scalar times(long n, const Scalar& a) const {
    if (n == 1) return a;
    if (n == 2) return base_.add(a, a);
    return base_.multiply(integers_[static_cast<std::size_t>(n)], a);
  }

  Scalar convolution(const Value& a, std::size_t pa, const Value& b, std::size_t pb, std::size_t k) const {
    Scalar sum = base_.multiply(a(pa, 0), b(pb, k));
    for (std::size_t j = 1; j <= k; ++j) sum = base_.add(sum, base_.multiply(a(pa, j), b(pb, k - j)));
    return sum;
  }

  /// The series alone, without variations.
  Value series(const Value& a) const {
    Value out = constant(zero_);
    out.c[0] = a.c[0];
    return out;
  }

  /// f(x + ε δx) = f(x) + ε f'(x) δx, where `slope` holds the series f'(x).
  Value with_variations(Value f, const Value& slope, const Value& x) const {
    for (std::size_t p = 1; p < Value::parts; ++p)
      for (std::size_t k = 0; k < orders_; ++k) f(p, k) = convolution(slope, 0, x, p, k);
    return f;
  }

  /// f with f' = slope · x' from its value at order 0.
  Value integral(const Scalar& first, const Value& slope, const Value& x) const {
    Value f = constant(first);
    for (std::size_t k = 1; k < orders_; ++k) {
      Scalar sum = zero_;
      for (std::size_t j = 1; j <= k; ++j)
        sum = base_.add(sum, times(static_cast<long>(j), base_.multiply(x(0, j), slope(0, k - j))));
      f(0, k) = base_.multiply(sum, reciprocal(k));
    }
    return with_variations(f, slope, x);
  }

  const Scalar& reciprocal(std::size_t k) const { return reciprocals_[k]; }

  Value exponential(const Scalar& first, const Value& x) const {
    Value f = constant(first);
    for (std::size_t k = 1; k < orders_; ++k) {
      Scalar sum = zero_;
      for (std::size_t j = 1; j <= k; ++j)
        sum = base_.add(sum, times(static_cast<long>(j), base_.multiply(x(0, j), f(0, k - j))));
      f(0, k) = base_.multiply(sum, reciprocal(k));
    }
    return with_variations(f, f, x);
  }

  std::pair<Value, Value> cos_sin(const Tape& tape, Position argument, const Value& x) {
    const auto angle = base_.cos_sin(tape, argument, leading_);
    Value c = constant(angle.cosine), s = constant(angle.sine);
    for (std::size_t k = 1; k < orders_; ++k) {
      Scalar dc = zero_, ds = zero_;
      for (std::size_t j = 1; j <= k; ++j) {
        const Scalar rate = times(static_cast<long>(j), x(0, j));
        dc = base_.add(dc, base_.multiply(rate, s(0, k - j)));
        ds = base_.add(ds, base_.multiply(rate, c(0, k - j)));
      }
      c(0, k) = base_.negate(base_.multiply(dc, reciprocal(k)));
      s(0, k) = base_.multiply(ds, reciprocal(k));
    }
    const Value cosine = with_variations(c, negate(s), x);
    return {cosine, with_variations(s, c, x)};
  }

  /// x^a for a constant exponent: x f' = a f x'.
  Value constant_power(const Scalar& first, const Value& x, const Scalar& a) const {
    const Scalar inverse_x = base_.inverse(x(0, 0));
    Value f = constant(first);
    for (std::size_t k = 1; k < orders_; ++k) {
      Scalar sum = zero_;
      for (std::size_t j = 1; j <= k; ++j) {
        const Scalar weight = base_.subtract(times(static_cast<long>(j), a), integers_[k - j]);
        sum = base_.add(sum, base_.multiply(weight, base_.multiply(x(0, j), f(0, k - j))));
      }
      f(0, k) = base_.multiply(base_.multiply(sum, inverse_x), reciprocal(k));
    }
    return with_variations(f, scale(multiply(series(f), inverse(series(x))), a), x);
  }

  Value inverse_root(const Value& y) {
    const Scalar minus_half = base_.number(Rational(-1, 2));
    return constant_power(base_.inverse(base_.square_root(y(0, 0))), y, minus_half);
  }

  Value integer_power(Value x, long n) const {
    if (n < 0) return integer_power(inverse(x), -n);
    if (n == 2) return multiply(x, x);
    Value result = number(1);
    for (; n; n >>= 1) {
      if (n & 1) result = multiply(result, x);
      if (n > 1) x = multiply(x, x);
    }
    return result;
  }

  bool is_constant(const Value& a) const {
    for (std::size_t p = 0; p < Value::parts; ++p)
      for (std::size_t k = 0; k < orders_; ++k)
        if ((p > 0 || k > 0) && !base_.is_zero(a(p, k))) return false;
    return true;
  }

  Value power(const Tape& tape, Position at, const std::vector<Value>& values) {
    const Position base = tape.argument(at, 0), exponent = tape.argument(at, 1);
    const Value &x = values[base], &y = values[exponent];
    if (const Rational* number = tape.expression(exponent).number_or_null())
      if (const auto n = number->as_integer()) return integer_power(x, *n);
    const Scalar first = base_.function(tape, at, leading_);
    if (is_constant(y)) return constant_power(first, x, y(0, 0));
    const Value log = integral(base_.logarithm(tape, base, leading_), inverse(x), x);
    return exponential(first, multiply(y, log));
  }

  /// From w eʷ = x: x (1 + w) w' = w x'. Each pass makes one more order right.
  Value lambert_w(const Scalar& first, const Value& x) const {
    Value w = constant(first), slope = w;
    for (std::size_t k = 0; k < orders_; ++k) {
      slope = series(multiply(w, inverse(multiply(x, add(number(1), w)))));
      w = integral(first, slope, x);
    }
    return w;
  }

  /// The angle φ of (x, y): φ' = (x y' − y x')/(x² + y²).
  Value atan2(const Scalar& first, const Value& y, const Value& x) const {
    const Value scale = inverse(add(multiply(x, x), multiply(y, y)));
    const Value along_y = series(multiply(x, scale)), along_x = series(negate(multiply(y, scale)));
    const Value rate = add(multiply(along_y, derivative(y)), multiply(along_x, derivative(x)));
    Value f = constant(first);
    for (std::size_t k = 1; k < orders_; ++k) f(0, k) = base_.multiply(rate(0, k - 1), reciprocal(k));
    for (std::size_t p = 1; p < Value::parts; ++p)
      for (std::size_t k = 0; k < orders_; ++k)
        f(p, k) = base_.add(convolution(along_y, 0, y, p, k), convolution(along_x, 0, x, p, k));
    return f;
  }

  bool chosen_first(const Scalar& chosen, const Scalar& first) const {
    return base_.is_zero(base_.subtract(chosen, first));
  }

  Value piecewise(const Tape& tape, Position at, const std::vector<Value>& values) {
    const auto arguments = tape.arguments(at);
    for (std::size_t i = 0; i + 1 < arguments.size(); i += 2)
      if (base_.holds(tape, arguments[i], leading_)) return values[arguments[i + 1]];
    return values[arguments.back()];
  }

  /// The base numbers look at values of order 0 below a function.
  void copy_leading(const Tape& tape, const std::vector<Value>& values, Position at) {
    if (copied_ == 0) leading_.resize(tape.size(), zero_);
    for (; copied_ < at; ++copied_) leading_[copied_] = values[copied_](0, 0);
  }

  Base& base_;
  std::size_t orders_;
  Scalar zero_;
  std::array<Scalar, Value::max_orders + 1> integers_{}, reciprocals_{};
  Lookup symbols_;
  std::vector<Scalar> leading_;
  Position copied_ = 0;
};

}  // namespace maupertuis::evaluation
