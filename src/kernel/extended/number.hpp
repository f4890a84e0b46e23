#pragma once
#include "kernel/series/elementary.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/version.hpp>

#include <cmath>
#include <limits>

namespace maupertuis::extended {

/// A binary floating-point number with a mantissa of that many bits, rounded to nearest. Bits that fill whole words
/// cost least.
template <unsigned Bits>
using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<Bits, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

/// log₂ |x|, −∞ for 0: sizes of coefficients leave the range of double.
template <class T>
double log2_size(const T& x) {
  if (x == 0) return -std::numeric_limits<double>::infinity();
  int exponent = 0;
  const T mantissa = frexp(x, &exponent);
  return exponent + std::log2(std::abs(static_cast<double>(mantissa)));
}

/// 2^x
template <class T>
T exp2_of(double x) {
  const double whole = std::floor(x);
  return ldexp(T(std::exp2(x - whole)), static_cast<int>(whole));
}

template <class T>
T epsilon() {
  return std::numeric_limits<T>::epsilon();
}

/// A power of the rounding unit, as thresholds between rounding and what is meant are.
template <class T>
T epsilon_to(double power) {
  return exp2_of<T>(power * (1 - std::numeric_limits<T>::digits));
}

template <class T>
bool is_finite(const T& x) {
  return (boost::multiprecision::isfinite)(x);
}

}  // namespace maupertuis::extended

// Constants are computed by whoever asks first for one, in his thread. Boost computes them for every number type when a
// program starts as well, in the main thread. Newer versions of Boost are left as they are.
#if BOOST_VERSION <= 108100
namespace boost::math::constants::detail {

template <unsigned Bits, int N, const maupertuis::extended::Real<Bits>& (*F)()>
struct constant_initializer2<maupertuis::extended::Real<Bits>, N, F> {
  struct Nothing {
    void force_instantiate() const {}
  };
  static constexpr Nothing initializer{};
  static void force_instantiate() {}
};

}  // namespace boost::math::constants::detail
#endif

namespace maupertuis::series {

template <unsigned Bits>
struct Exactly<boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<Bits, boost::multiprecision::digit_base_2>, boost::multiprecision::et_off>> {
  using T = extended::Real<Bits>;
  static T pi() { return boost::math::constants::pi<T>(); }
  /// Rounded at most three times.
  static T from(const Rational& value) { return T(value.numerator_string()) / T(value.denominator_string()); }
};

}  // namespace maupertuis::series
