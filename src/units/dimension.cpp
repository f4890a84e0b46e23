#include <maupertuis/require.hpp>
#include <maupertuis/units.hpp>

#include <algorithm>
#include <numeric>

namespace maupertuis {
namespace {

using Exponent = Dimension::Exponent;

constexpr std::int64_t kLargest = 32767;

// Saturates at ±32767, far outside of physics, where two dimensions are wrong anyway.
Exponent exponent(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t common = std::max<std::int64_t>(std::gcd(numerator, denominator), 1);
  numerator /= common;
  denominator /= common;
  if (numerator > kLargest || numerator < -kLargest || denominator > kLargest) {
    return {static_cast<std::int16_t>(numerator < 0 ? -kLargest : kLargest), 1};
  }
  return {static_cast<std::int16_t>(numerator), static_cast<std::int16_t>(denominator)};
}

Exponent add(Exponent a, Exponent b, int sign) {
  return exponent(std::int64_t{a.numerator} * b.denominator + sign * std::int64_t{b.numerator} * a.denominator,
                  std::int64_t{a.denominator} * b.denominator);
}

Dimension combine(const Dimension& a, const Dimension& b, int sign) {
  Dimension result;
  for (int i = 0; i < Dimension::Count; ++i) result.exponents[i] = add(a.exponents[i], b.exponents[i], sign);
  return result;
}

}  // namespace

bool Dimension::is_one() const { return same_as(Dimension{}); }

bool Dimension::same_as(const Dimension& other) const {
  return std::equal(exponents.begin(), exponents.begin() + Angle, other.exponents.begin());
}

Dimension operator*(const Dimension& a, const Dimension& b) { return combine(a, b, 1); }
Dimension operator/(const Dimension& a, const Dimension& b) { return combine(a, b, -1); }

Dimension Dimension::base(Base which) {
  MAUP_REQUIRE(which < Count);
  Dimension result;
  result.exponents[which] = {1, 1};
  return result;
}

Dimension pow(const Dimension& dimension, std::int64_t numerator, std::int64_t denominator) {
  MAUP_REQUIRE(denominator != 0);
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  constexpr std::int64_t bound = std::int64_t{1} << 40;
  numerator = std::clamp(numerator, -bound, bound);
  denominator = std::min(denominator, bound);
  Dimension result;
  for (int i = 0; i < Dimension::Count; ++i) {
    const Exponent e = dimension.exponents[i];
    result.exponents[i] = exponent(e.numerator * numerator, e.denominator * denominator);
  }
  return result;
}

namespace dimensions {

Dimension one() { return {}; }
Dimension angle() { return Dimension::base(Dimension::Angle); }
Dimension length() { return Dimension::base(Dimension::Length); }
Dimension mass() { return Dimension::base(Dimension::Mass); }
Dimension time() { return Dimension::base(Dimension::Time); }
Dimension charge() { return Dimension::base(Dimension::Current) * time(); }
Dimension velocity() { return length() / time(); }
Dimension acceleration() { return velocity() / time(); }
Dimension force() { return mass() * acceleration(); }
Dimension torque() { return force() * length() / angle(); }
Dimension energy() { return force() * length(); }
Dimension power() { return energy() / time(); }
Dimension moment_of_inertia() { return mass() * length() * length(); }
Dimension action() { return energy() * time(); }

}  // namespace dimensions
}  // namespace maupertuis
