#pragma once
#include <maupertuis/rational.hpp>

#include <cstdint>

namespace maupertuis::evaluation {

/// Spreads the bits of a counter: the source of all random choices here, so that the same seed gives the same run.
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

__extension__ typedef unsigned __int128 Wide;  // g++ and clang have it, ISO C++ does not

/// Residues modulo an odd prime below 2^62, in Montgomery form (x is kept as x·2^64 mod p).
class PrimeField {
 public:
  using Value = std::uint64_t;
  explicit PrimeField(std::uint64_t prime);

  std::uint64_t prime() const { return prime_; }
  Value zero() const { return 0; }
  Value one() const { return one_; }
  Value from_residue(std::uint64_t x) const { return multiply(x, square_of_radix_); }
  std::uint64_t residue(Value a) const { return reduce(a); }
  Value from(const Rational& value) const;

  Value add(Value a, Value b) const {
    const Value s = a + b;
    return s >= prime_ ? s - prime_ : s;
  }
  Value subtract(Value a, Value b) const { return a >= b ? a - b : a + prime_ - b; }
  Value negate(Value a) const { return a == 0 ? 0 : prime_ - a; }
  Value multiply(Value a, Value b) const { return reduce(static_cast<Wide>(a) * b); }
  /// Sums of products that are reduced once, at their end. They stay below p·2^64: up to four products may be added
  /// before the next `lessened`, since p < 2^62.
  Wide unreduced(Value a) const { return static_cast<Wide>(a) << 64; }
  Wide lessened(Wide sum) const {
    const auto high = static_cast<std::uint64_t>(sum >> 64), less = high - prime_;  // wraps where it was below p
    return static_cast<Wide>(high < less ? high : less) << 64 | static_cast<std::uint64_t>(sum);
  }
  Value reduced(Wide sum) const { return reduce(sum); }
  Value power(Value base, std::uint64_t exponent) const;
  /// Precondition: a != 0.
  Value inverse(Value a) const { return power(a, prime_ - 2); }
  /// +1 for a square, −1 for a non-square, 0 for zero.
  int character(Value a) const;

 private:
  Value reduce(Wide x) const {
    const std::uint64_t m = static_cast<std::uint64_t>(x) * negative_inverse_;
    const auto t = static_cast<std::uint64_t>((x + static_cast<Wide>(m) * prime_) >> 64);
    return t >= prime_ ? t - prime_ : t;
  }

  std::uint64_t prime_, negative_inverse_, one_, square_of_radix_;
};

/// p = m·r − 1, q = (p − 1)/2 and r, all prime, p of 61 bits (docs/theory/zero_test.md says what each is for).
struct PrimeTriple {
  std::uint64_t p, q, r, m;
};

/// A random triple for a multiple m of 840. Precondition: m < 2^24.
PrimeTriple random_prime_triple(std::uint64_t m, std::uint64_t seed);

bool is_prime(std::uint64_t n);

}  // namespace maupertuis::evaluation
