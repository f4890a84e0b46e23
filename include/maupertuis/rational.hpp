#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace maupertuis {

/// An exact rational number. Small ones (both parts within 63 bits) live in place; larger ones are shared, immutable
/// multiprecision values. Always in lowest terms with a positive denominator, so that equality is equality of parts.
class Rational {
 public:
  Rational() = default;
  Rational(std::int64_t value) : numerator_(value) {}  // NOLINT: an integer is a rational
  Rational(int value) : numerator_(value) {}           // NOLINT
  /// Precondition: denominator != 0.
  Rational(std::int64_t numerator, std::int64_t denominator);

  /// Reads "12", "-3/4", "9.81", "6.674e-11" exactly. Nothing on a malformed text or an exponent beyond ±4000.
  static std::optional<Rational> parse(std::string_view text);
  /// The exact value of a finite double. Precondition: std::isfinite(value).
  static Rational from_double(double value);

  bool is_zero() const { return !big_ && numerator_ == 0; }
  bool is_one() const { return !big_ && numerator_ == 1 && denominator_ == 1; }
  bool is_integer() const;
  int sign() const;
  /// Both parts when they fit 63 bits.
  struct Small {
    std::int64_t numerator, denominator;
  };
  std::optional<Small> small() const;
  /// The value when it is an integer of 63 bits.
  std::optional<std::int64_t> as_integer() const;

  /// Correctly rounded to nearest (±infinity beyond the range of double).
  double to_double() const;
  /// "-3/4", "12"
  std::string to_string() const;
  std::string numerator_string() const;
  std::string denominator_string() const;
  /// Residues modulo a prime below 2^62.
  std::uint64_t numerator_mod(std::uint64_t prime) const;
  std::uint64_t denominator_mod(std::uint64_t prime) const;
  std::size_t hash() const;

  friend Rational operator+(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a, const Rational& b);
  friend Rational operator*(const Rational& a, const Rational& b);
  /// Precondition: b != 0.
  friend Rational operator/(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a);
  friend bool operator==(const Rational& a, const Rational& b);
  friend bool operator!=(const Rational& a, const Rational& b) { return !(a == b); }
  friend bool operator<(const Rational& a, const Rational& b);
  Rational& operator+=(const Rational& b) { return *this = *this + b; }
  Rational& operator*=(const Rational& b) { return *this = *this * b; }

  struct Big;  // boost::multiprecision::cpp_rational; known to rational.cpp alone

 private:
  static Rational from_big(std::shared_ptr<const Big> big);
  std::shared_ptr<const Big> promote() const;

  std::int64_t numerator_ = 0;
  std::int64_t denominator_ = 1;
  std::shared_ptr<const Big> big_;  // set only when a part does not fit
};

Rational abs(const Rational& value);
/// value^exponent; value != 0 when exponent < 0. |exponent| is bounded by the caller.
Rational pow(const Rational& value, int exponent);
/// The exact k-th root if value is a perfect k-th power (value >= 0, k >= 2).
std::optional<Rational> exact_root(const Rational& value, int k);

}  // namespace maupertuis
