#pragma once
#include <maupertuis/error_function.hpp>
#include <maupertuis/lambert_w.hpp>
#include <maupertuis/rational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace maupertuis::evaluation {

/// How far a library function of a real type may be off, and the type's constants. Specialised for double here and for
/// 100 digits in the sources that use them.
template <class Real>
struct RealTraits;

template <>
struct RealTraits<double> {
  static double infinity() { return std::numeric_limits<double>::infinity(); }
  // The elementary functions of the C library err by less than 4 units in the last place.
  static double slack(double x) { return 8 * std::numeric_limits<double>::epsilon() * std::abs(x) + 1e-300; }
  static double pi() { return 3.14159265358979323846; }
  static double from(const Rational& value) { return value.to_double(); }
};

/// A closed interval of reals that contains the exact value: every operation rounds outwards by `slack`. Empty domains
/// (the root of a negative number) give NaN bounds, which decide nothing.
template <class Real>
struct Interval {
  Real low{}, high{};

  static Interval around(const Real& low, const Real& high) {
    return {Real(low - RealTraits<Real>::slack(low)), Real(high + RealTraits<Real>::slack(high))};
  }
  static Interval whole() { return {Real(-RealTraits<Real>::infinity()), RealTraits<Real>::infinity()}; }
  static Interval nothing() {
    return {Real(std::numeric_limits<double>::quiet_NaN()), Real(std::numeric_limits<double>::quiet_NaN())};
  }
  bool is_nan() const { return !(low <= high); }
  bool contains_zero() const { return !(low > 0) && !(high < 0); }
};

template <class R>
void from_rational(Interval<R>& out, const Rational& value) {
  const R x = RealTraits<R>::from(value);
  const bool exact = value.is_integer() && value.small() && std::abs(value.to_double()) < 9007199254740992.0;
  out = exact ? Interval<R>{x, x} : Interval<R>::around(x, x);
}
template <class R>
void set_pi(Interval<R>& out) {
  out = Interval<R>::around(RealTraits<R>::pi(), RealTraits<R>::pi());
}

/// 0·∞ is 0 here: the factor 0 is exact.
template <class R>
R bounded_product(const R& a, const R& b) {
  return a == 0 || b == 0 ? R(0) : R(a * b);
}

template <class R>
Interval<R> operator+(const Interval<R>& a, const Interval<R>& b) {
  return Interval<R>::around(R(a.low + b.low), R(a.high + b.high));
}
template <class R>
Interval<R> operator-(const Interval<R>& a) {
  return {R(-a.high), R(-a.low)};
}
template <class R>
Interval<R> operator-(const Interval<R>& a, const Interval<R>& b) {
  return a + (-b);
}
/// The least and the largest product of two numbers of these. Signs tell which ends they belong to: two products of 100
/// digits in place of four.
template <class R>
Interval<R> products(const Interval<R>& a, const Interval<R>& b) {
  const auto of = [](const R& a_low, const R& b_low, const R& a_high, const R& b_high) {
    return Interval<R>{bounded_product(a_low, b_low), bounded_product(a_high, b_high)};
  };
  if (a.low >= 0) return of(b.low >= 0 ? a.low : a.high, b.low, b.high >= 0 ? a.high : a.low, b.high);
  if (a.high <= 0) return of(b.high >= 0 ? a.low : a.high, b.high, b.low >= 0 ? a.high : a.low, b.low);
  if (b.low >= 0) return of(a.low, b.high, a.high, b.high);
  if (b.high <= 0) return of(a.high, b.low, a.low, b.low);
  const Interval<R> crossed = of(a.low, b.high, a.low, b.low), others = of(a.high, b.low, a.high, b.high);
  return {std::min(crossed.low, others.low), std::max(crossed.high, others.high)};
}
template <class R>
Interval<R> operator*(const Interval<R>& a, const Interval<R>& b) {
  if (a.is_nan() || b.is_nan()) return Interval<R>::nothing();
  const auto [low, high] = products(a, b);
  if (low == 0 && high == 0) return {R(0), R(0)};
  // A sign is kept: an outward step across 0 would lose that squares are not negative.
  const Interval<R> wide = Interval<R>::around(low, high);
  return {low >= 0 && wide.low < 0 ? R(0) : wide.low, high <= 0 && wide.high > 0 ? R(0) : wide.high};
}
template <class R>
Interval<R> operator/(const Interval<R>& a, const Interval<R>& b) {
  if (b.is_nan() || b.contains_zero()) {
    // One-sided: 1/[0, b] is [1/b, ∞).
    if (!b.is_nan() && b.low >= 0 && b.high > 0)
      return a * Interval<R>{R(R(1) / b.high * R(1 - 1e-12)), RealTraits<R>::infinity()};
    return b.is_nan() ? Interval<R>::nothing() : Interval<R>::whole();
  }
  const R low = R(1) / b.high, high = R(1) / b.low;
  Interval<R> inverse = Interval<R>::around(low, high);
  if (low >= 0 && inverse.low < 0) inverse.low = 0;
  if (high <= 0 && inverse.high > 0) inverse.high = 0;
  return a * inverse;
}

template <class R>
std::optional<bool> less(const Interval<R>& a, const Interval<R>& b) {
  if (a.is_nan() || b.is_nan()) return std::nullopt;
  if (a.high < b.low) return true;
  if (a.low >= b.high) return false;
  return std::nullopt;
}
template <class R>
Interval<R> unknown_between(const Interval<R>& a, const Interval<R>& b) {
  if (a.is_nan() || b.is_nan()) return Interval<R>::nothing();
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// f rising on [domain_low, domain_high].
template <class R, class F>
Interval<R> rising(const Interval<R>& x, F f) {
  if (x.is_nan()) return x;
  return Interval<R>::around(f(x.low), f(x.high));
}
template <class R>
bool within(const Interval<R>& x, double low, double high) {
  return x.low >= low && x.high <= high;
}

template <class R>
Interval<R> abs(const Interval<R>& x) {
  if (x.low >= 0) return x;
  if (x.high <= 0) return -x;
  return x.is_nan() ? x : Interval<R>{R(0), std::max(R(-x.low), x.high)};
}
template <class R>
Interval<R> integer_power(const Interval<R>& x, long n) {
  if (n < 0) return Interval<R>{R(1), R(1)} / integer_power(x, -n);
  Interval<R> base = n % 2 == 0 ? abs(x) : x, result{R(1), R(1)};
  for (; n; n >>= 1) {
    if (n & 1) result = result * base;
    if (n > 1) base = base * base;
  }
  return result;
}

template <class R>
Interval<R> exp(const Interval<R>& x) {
  using std::exp;
  Interval<R> y = rising(x, [](const R& v) { return R(exp(v)); });
  if (y.low < 0) y.low = 0;
  return y;
}
template <class R>
Interval<R> log(const Interval<R>& x) {
  using std::log;
  return x.low > 0    ? rising(x, [](const R& v) { return R(log(v)); })
         : x.high > 0 ? Interval<R>::whole()
                      : Interval<R>::nothing();
}
template <class R>
Interval<R> sqrt(const Interval<R>& x) {
  using std::sqrt;
  if (x.is_nan() || x.high < 0) return Interval<R>::nothing();
  const Interval<R> y = rising(Interval<R>{x.low < 0 ? R(0) : x.low, x.high}, [](const R& v) { return R(sqrt(v)); });
  return {y.low < 0 ? R(0) : y.low, y.high};
}
/// x^y for x > 0, as exp(y log x).
template <class R>
Interval<R> real_power(const Interval<R>& x, const Interval<R>& y) {
  if (x.is_nan() || x.high <= 0) return Interval<R>::nothing();
  if (!(x.low > 0)) return Interval<R>{R(0), RealTraits<R>::infinity()};
  return exp(y * log(x));
}

/// Narrow arguments only: the value at the middle, plus the half-width times the largest slope 1.
template <class R, class F>
Interval<R> gentle(const Interval<R>& x, F f, const Interval<R>& range) {
  if (x.is_nan()) return x;
  const R half = (x.high - x.low) / 2;
  if (!(half < 1)) return range;
  const R value = f(R(x.low + half));
  const Interval<R> y = Interval<R>::around(R(value - half), R(value + half));
  // The middle of the interval was rounded, and a large argument is reduced with an error of its own.
  const R off = RealTraits<R>::slack(x.low) + RealTraits<R>::slack(x.high);
  return {std::max(R(y.low - off), range.low), std::min(R(y.high + off), range.high)};
}
template <class R>
Interval<R> sin(const Interval<R>& x) {
  using std::sin;
  return gentle(
      x, [](const R& v) { return R(sin(v)); }, Interval<R>{R(-1), R(1)});
}
template <class R>
Interval<R> cos(const Interval<R>& x) {
  using std::cos;
  return gentle(
      x, [](const R& v) { return R(cos(v)); }, Interval<R>{R(-1), R(1)});
}
template <class R>
Interval<R> tan(const Interval<R>& x) {
  return sin(x) / cos(x);
}
template <class R>
Interval<R> atan(const Interval<R>& x) {
  using std::atan;
  return rising(x, [](const R& v) { return R(atan(v)); });
}
template <class R>
Interval<R> asin(const Interval<R>& x) {
  using std::asin;
  return within(x, -1, 1) ? rising(x, [](const R& v) { return R(asin(v)); }) : Interval<R>::nothing();
}
template <class R>
Interval<R> acos(const Interval<R>& x) {
  Interval<R> half_turn;
  set_pi(half_turn);
  return half_turn * Interval<R>{R(0.5), R(0.5)} - asin(x);
}
template <class R>
Interval<R> sinh(const Interval<R>& x) {
  using std::sinh;
  return rising(x, [](const R& v) { return R(sinh(v)); });
}
template <class R>
Interval<R> cosh(const Interval<R>& x) {
  using std::cosh;
  return rising(abs(x), [](const R& v) { return R(cosh(v)); });
}
template <class R>
Interval<R> tanh(const Interval<R>& x) {
  using std::tanh;
  return rising(x, [](const R& v) { return R(tanh(v)); });
}
template <class R>
Interval<R> asinh(const Interval<R>& x) {
  using std::asinh;
  return rising(x, [](const R& v) { return R(asinh(v)); });
}
template <class R>
Interval<R> acosh(const Interval<R>& x) {
  using std::acosh;
  return x.low >= 1 ? rising(x, [](const R& v) { return R(acosh(v)); }) : Interval<R>::nothing();
}
template <class R>
Interval<R> atanh(const Interval<R>& x) {
  using std::atanh;
  return within(x, -1, 1) ? rising(x, [](const R& v) { return R(atanh(v)); }) : Interval<R>::nothing();
}
template <class R>
Interval<R> error_function(const Interval<R>& x) {
  return rising(x, [](const R& v) { return R(maupertuis::error_function(v)); });
}
/// Within 1e-12 of its end −1/e the root of w eʷ = x is known by its sign alone, as where the interval begins below.
template <class R>
Interval<R> lambert_w(const Interval<R>& x) {
  constexpr double inside = -0.367879441171;
  if (x.is_nan() || !(x.high > inside)) return Interval<R>::nothing();
  const Interval<R> y =
      rising(Interval<R>{std::max(x.low, R(inside)), x.high}, [](const R& v) { return R(maupertuis::lambert_w(v)); });
  return {x.low < inside ? R(-1) : y.low, y.high};
}
/// Away from the cut and the origin, else the whole range.
template <class R>
Interval<R> atan2(const Interval<R>& y, const Interval<R>& x) {
  Interval<R> pi;
  set_pi(pi);
  if (y.is_nan() || x.is_nan()) return Interval<R>::nothing();
  if (x.low > 0) return atan(y / x);
  const Interval<R> quarter = pi * Interval<R>{R(0.5), R(0.5)};
  if (y.low > 0) return quarter - atan(x / y);
  if (y.high < 0) return -quarter - atan(x / y);
  return {R(-pi.high), pi.high};
}

}  // namespace maupertuis::evaluation
