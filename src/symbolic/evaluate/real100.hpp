#pragma once
// The only place that names the 100-digit type; for .cpp files that calculate with it (Boost is slow to compile).
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "symbolic/evaluate/interval.hpp"

namespace maupertuis::evaluation {

using Real100 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

inline Real100 real100_from(const Rational& value) {
  if (const auto small = value.small()) return Real100(small->numerator) / Real100(small->denominator);
  return Real100(value.numerator_string()) / Real100(value.denominator_string());
}

template <>
struct RealTraits<Real100> {
  static Real100 infinity() { return std::numeric_limits<Real100>::infinity(); }
  // Boost's elementary functions err by some units of the 100th digit; ten digits are given away.
  static Real100 slack(const Real100& x) {
    static const Real100 least("1e-1000");
    return ldexp(abs(x), -298) + least;  // 2⁻²⁹⁸ = 2e-90, by the exponent alone: each operation asks twice
  }
  static Real100 pi() { return boost::math::constants::pi<Real100>(); }
  static Real100 from(const Rational& value) { return real100_from(value); }
};

inline void from_rational(Real100& out, const Rational& value) { out = real100_from(value); }
inline void set_pi(Real100& out) { out = RealTraits<Real100>::pi(); }
inline std::optional<bool> less(const Real100& a, const Real100& b) {
  if (isnan(a) || isnan(b)) return std::nullopt;
  return a < b;
}
inline Real100 unknown_between(const Real100&, const Real100&) { return std::numeric_limits<Real100>::quiet_NaN(); }
inline Real100 integer_power(const Real100& x, long n) { return pow(x, static_cast<int>(n)); }
/// Boost's pow turns the sign of a negative exponent and calls itself; that of NaN stays negative, without end.
inline Real100 real_power(const Real100& x, const Real100& y) { return isnan(y) ? y : pow(x, y); }

/// n of x^(n/2) for odd n: then a power of √x, for a tenth of the price of logarithm and exponential.
inline std::optional<long> odd_halves(const Rational& exponent) {
  const auto parts = exponent.small();
  const bool few = parts && parts->denominator == 2 && std::abs(parts->numerator) < 100;
  return few ? std::optional<long>(parts->numerator) : std::nullopt;
}
inline Real100 constant_power(const Real100& x, const Rational& exponent, const Real100& y) {
  const auto n = odd_halves(exponent);
  return n ? integer_power(Real100(sqrt(x)), *n) : real_power(x, y);
}
inline Interval<Real100> constant_power(const Interval<Real100>& x, const Rational& exponent,
                                        const Interval<Real100>& y) {
  const auto n = x.low > 0 ? odd_halves(exponent) : std::nullopt;
  return n ? integer_power(sqrt(x), *n) : real_power(x, y);
}

}  // namespace maupertuis::evaluation
