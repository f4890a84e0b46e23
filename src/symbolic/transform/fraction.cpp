#include "symbolic/transform/term_algebra.hpp"

#include <cstdlib>
#include <numeric>

namespace maupertuis::terms {

namespace {
constexpr std::int64_t largest_part = 1 << 20;
}

Fraction fraction(std::int64_t num, std::int64_t den) {
  const std::int64_t divisor = std::gcd(num, den) * (den < 0 ? -1 : 1);
  num /= divisor;
  den /= divisor;
  if (std::abs(num) > largest_part || den > largest_part) throw TooManyTerms{};
  return {static_cast<std::int32_t>(num), static_cast<std::int32_t>(den)};
}

bool fits_fraction(const Rational& value) {
  const auto parts = value.small();
  return parts && std::abs(parts->numerator) <= largest_part && parts->denominator <= largest_part;
}

Fraction to_fraction(const Rational& value) {
  if (!fits_fraction(value)) throw TooManyTerms{};
  const auto parts = value.small();
  return fraction(parts->numerator, parts->denominator);
}

Fraction operator+(Fraction a, Fraction b) {
  if (a.den == 1 && b.den == 1 && std::abs(a.num + b.num) <= largest_part) return {a.num + b.num, 1};
  return fraction(std::int64_t{a.num} * b.den + std::int64_t{b.num} * a.den, std::int64_t{a.den} * b.den);
}
Fraction operator-(Fraction a, Fraction b) { return a + Fraction{-b.num, b.den}; }
Fraction operator*(Fraction a, Fraction b) {
  return fraction(std::int64_t{a.num} * b.num, std::int64_t{a.den} * b.den);
}
Fraction operator/(Fraction a, Fraction b) {
  return fraction(std::int64_t{a.num} * b.den, std::int64_t{a.den} * b.num);
}
bool operator<(Fraction a, Fraction b) { return std::int64_t{a.num} * b.den < std::int64_t{b.num} * a.den; }

Fraction gcd(Fraction a, Fraction b) {
  const std::int64_t den = std::lcm(std::int64_t{a.den}, std::int64_t{b.den});
  return fraction(std::gcd(a.num * (den / a.den), b.num * (den / b.den)), den);
}

Rational to_rational(Fraction f) { return Rational(f.num, f.den); }

}  // namespace maupertuis::terms
