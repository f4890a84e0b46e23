#pragma once
#include <maupertuis/error_function.hpp>
#include <maupertuis/lambert_w.hpp>
#include <maupertuis/rational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace maupertuis::evaluation {

/// A double with a bound of what rounding has made of it so far, to first order: the running error analysis of
/// Wilkinson. NaN where no bound is known.
struct RunningError {
  double value = 0, error = 0;
};

inline constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

inline RunningError rounded(double value, double error) { return {value, error + unit_roundoff * std::abs(value)}; }

inline void from_rational(RunningError& out, const Rational& value) {
  const double x = value.to_double();
  const auto parts = value.small();
  const bool exact = parts && (parts->denominator & (parts->denominator - 1)) == 0 &&
                     std::abs(static_cast<double>(parts->numerator)) < 9007199254740992.0;
  out = exact ? RunningError{x, 0} : rounded(x, 0);
}
inline void set_pi(RunningError& out) { out = rounded(3.14159265358979323846, 0); }

inline RunningError operator+(const RunningError& a, const RunningError& b) {
  if (a.value == 0 || b.value == 0) return {a.value + b.value, a.error + b.error};
  return rounded(a.value + b.value, a.error + b.error);
}
inline RunningError operator-(const RunningError& a) { return {-a.value, a.error}; }
inline RunningError operator-(const RunningError& a, const RunningError& b) { return a + (-b); }
inline RunningError operator*(const RunningError& a, const RunningError& b) {
  return rounded(a.value * b.value, std::abs(a.value) * b.error + (std::abs(b.value) + b.error) * a.error);
}
inline RunningError operator/(const RunningError& a, const RunningError& b) {
  const double value = a.value / b.value, least = std::abs(b.value) - b.error;
  return rounded(value,
                 least > 0 ? (a.error + std::abs(value) * b.error) / least : std::numeric_limits<double>::infinity());
}

/// Nothing where rounding leaves it open.
inline std::optional<bool> less(const RunningError& a, const RunningError& b) {
  const double distance = b.value - a.value, error = a.error + b.error;
  if (!(std::abs(distance) > error) && error != 0) return std::nullopt;
  if (std::isnan(distance)) return std::nullopt;
  return distance > 0;
}
inline RunningError unknown_between(const RunningError&, const RunningError&) { return {std::nan(""), std::nan("")}; }

/// |f(x + e) − f(x)| for an error e of x, whose slope is taken over a distance at which f itself is known well.
template <class F>
double carried(const RunningError& x, double y, F f) {
  if (x.error == 0) return 0;
  const double h = std::max(std::abs(x.value) * 0x1p-26, x.error);
  const double right = std::abs(f(x.value + h) - y), left = std::abs(f(x.value - h) - y);
  return (std::isnan(right) ? left : std::isnan(left) ? right : std::max(left, right)) / h * x.error;
}

/// A function of the C library, which errs by less than a unit in the last place or two.
template <class F>
RunningError smooth(const RunningError& x, F f) {
  const double y = f(x.value);
  return {y, carried(x, y, f) + 2 * unit_roundoff * std::abs(y)};
}
template <class F>
RunningError smooth(const RunningError& a, const RunningError& b, F f) {
  const double y = f(a.value, b.value);
  return {y, carried(a, y, [&](double x) { return f(x, b.value); }) +
                 carried(b, y, [&](double x) { return f(a.value, x); }) + 2 * unit_roundoff * std::abs(y)};
}

// clang-format off
inline RunningError abs(const RunningError& x) { return {std::abs(x.value), x.error}; }
inline RunningError sqrt(const RunningError& x) { return smooth(x, [](double v) { return std::sqrt(v); }); }
inline RunningError sin(const RunningError& x) { return smooth(x, [](double v) { return std::sin(v); }); }
inline RunningError cos(const RunningError& x) { return smooth(x, [](double v) { return std::cos(v); }); }
inline RunningError tan(const RunningError& x) { return smooth(x, [](double v) { return std::tan(v); }); }
inline RunningError asin(const RunningError& x) { return smooth(x, [](double v) { return std::asin(v); }); }
inline RunningError acos(const RunningError& x) { return smooth(x, [](double v) { return std::acos(v); }); }
inline RunningError atan(const RunningError& x) { return smooth(x, [](double v) { return std::atan(v); }); }
inline RunningError sinh(const RunningError& x) { return smooth(x, [](double v) { return std::sinh(v); }); }
inline RunningError cosh(const RunningError& x) { return smooth(x, [](double v) { return std::cosh(v); }); }
inline RunningError tanh(const RunningError& x) { return smooth(x, [](double v) { return std::tanh(v); }); }
inline RunningError asinh(const RunningError& x) { return smooth(x, [](double v) { return std::asinh(v); }); }
inline RunningError acosh(const RunningError& x) { return smooth(x, [](double v) { return std::acosh(v); }); }
inline RunningError atanh(const RunningError& x) { return smooth(x, [](double v) { return std::atanh(v); }); }
inline RunningError exp(const RunningError& x) { return smooth(x, [](double v) { return std::exp(v); }); }
inline RunningError log(const RunningError& x) { return smooth(x, [](double v) { return std::log(v); }); }
// clang-format on
inline RunningError error_function(const RunningError& x) {
  return smooth(x, [](double v) { return maupertuis::error_function(v); });
}
inline RunningError lambert_w(const RunningError& x) {
  return smooth(x, [](double v) { return maupertuis::lambert_w(v); });
}
inline RunningError atan2(const RunningError& y, const RunningError& x) {
  return smooth(y, x, [](double a, double b) { return std::atan2(a, b); });
}
inline RunningError integer_power(const RunningError& x, long n) {
  return smooth(x, [n](double v) { return std::pow(v, static_cast<double>(n)); });
}
inline RunningError real_power(const RunningError& x, const RunningError& y) {
  return smooth(x, y, [](double a, double b) { return std::pow(a, b); });
}

}  // namespace maupertuis::evaluation
