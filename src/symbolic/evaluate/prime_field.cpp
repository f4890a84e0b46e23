#include "symbolic/evaluate/prime_field.hpp"

#include <maupertuis/require.hpp>

#include <array>
#include <vector>

namespace maupertuis::evaluation {

PrimeField::PrimeField(std::uint64_t prime) : prime_(prime) {
  MAUP_REQUIRE(prime % 2 == 1 && prime < (1ull << 62));
  std::uint64_t inverse = prime;  // Newton's iteration for 1/p modulo 2^64
  for (int i = 0; i < 6; ++i) inverse *= 2 - prime * inverse;
  negative_inverse_ = ~inverse + 1;
  const auto radix = static_cast<std::uint64_t>((static_cast<Wide>(1) << 64) % prime);
  one_ = radix;
  square_of_radix_ = static_cast<std::uint64_t>(static_cast<Wide>(radix) * radix % prime);
}

PrimeField::Value PrimeField::from(const Rational& value) const {
  const Value numerator = from_residue(value.numerator_mod(prime_));
  if (value.is_integer()) return numerator;
  if (value.denominator_mod(prime_) == 2) return multiply(numerator, from_residue((prime_ + 1) / 2));
  return multiply(numerator, inverse(from_residue(value.denominator_mod(prime_))));
}

PrimeField::Value PrimeField::power(Value base, std::uint64_t exponent) const {
  Value result = one_;
  for (; exponent; exponent >>= 1) {
    if (exponent & 1) result = multiply(result, base);
    base = multiply(base, base);
  }
  return result;
}

int PrimeField::character(Value a) const {
  if (a == 0) return 0;
  // Jacobi's symbol by quadratic reciprocity; 2^64 is a square, so that the Montgomery factor does not matter.
  std::uint64_t x = a, n = prime_;
  int sign = 1;
  while (x != 0) {
    const int twos = __builtin_ctzll(x);
    x >>= twos;
    if ((twos & 1) && (n % 8 == 3 || n % 8 == 5)) sign = -sign;
    if (x % 4 == 3 && n % 4 == 3) sign = -sign;
    const std::uint64_t rest = n % x;
    n = x;
    x = rest;
  }
  return sign;
}

namespace {

bool passes_miller_rabin(const PrimeField& field, std::uint64_t n, std::uint64_t base) {
  const int twos = __builtin_ctzll(n - 1);
  PrimeField::Value x = field.power(field.from_residue(base % n), (n - 1) >> twos);
  const PrimeField::Value minus_one = field.negate(field.one());
  if (x == field.one() || x == minus_one) return true;
  for (int i = 1; i < twos; ++i) {
    x = field.multiply(x, x);
    if (x == minus_one) return true;
  }
  return false;
}

}  // namespace

bool is_prime(std::uint64_t n) {
  // These bases decide every n below 3.3e24 (Sorenson and Webster 2017).
  constexpr std::array<std::uint64_t, 12> bases{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  if (n < 2) return false;
  for (const std::uint64_t b : bases)
    if (n % b == 0) return n == b;
  const PrimeField field(n);
  for (const std::uint64_t b : bases)
    if (!passes_miller_rabin(field, n, b)) return false;
  return true;
}

namespace {

constexpr std::uint64_t sieve_limit = 2048;

std::vector<std::uint32_t> small_primes() {
  std::vector<std::uint32_t> primes;
  std::array<bool, sieve_limit> composite{};
  for (std::uint32_t n = 3; n < sieve_limit; n += 2) {
    if (composite[n]) continue;
    primes.push_back(n);
    for (std::uint32_t k = n * n; k < sieve_limit; k += 2 * n) composite[k] = true;
  }
  return primes;
}

/// 1/x modulo a small prime l, x not 0.
std::int64_t small_inverse(std::int64_t x, std::int64_t l) {
  std::int64_t a = l, b = x % l, u = 0, v = 1;
  while (b != 0) {
    const std::int64_t quotient = a / b;
    a -= quotient * b;
    u -= quotient * v;
    std::swap(a, b);
    std::swap(u, v);
  }
  return (u % l + l) % l;
}

/// Which of r0, r0 + 2, … have r, m/2·r − 1 and m·r − 1 all without a small divisor.
template <std::size_t count>
std::array<bool, count> sieve(std::uint64_t r0, std::uint64_t m, const std::vector<std::uint32_t>& primes) {
  std::array<bool, count> keep;
  keep.fill(true);
  for (const std::uint64_t l : primes) {
    // The residue classes of r that a divisor l forbids: 0, and the inverses of m and m/2.
    const std::uint64_t inverse =
        m % l == 0
            ? 0
            : static_cast<std::uint64_t>(small_inverse(static_cast<std::int64_t>(m % l), static_cast<std::int64_t>(l)));
    for (const std::uint64_t forbidden : {std::uint64_t{0}, inverse, 2 * inverse % l}) {
      std::uint64_t start = (forbidden + l - r0 % l) % l;  // r0 + start is in the class; r grows by 2
      if (start % 2) start += l;
      for (std::uint64_t k = start / 2; k < count; k += l) keep[k] = false;
    }
  }
  return keep;
}

/// Fermat's test in base 2: rejects nearly all composites at the price of one power.
bool may_be_prime(std::uint64_t n) {
  const PrimeField field(n);
  return field.power(field.add(field.one(), field.one()), n - 1) == field.one();
}

}  // namespace

PrimeTriple random_prime_triple(std::uint64_t m, std::uint64_t seed) {
  MAUP_REQUIRE(m % 840 == 0 && m < (1ull << 24));
  constexpr std::size_t window = 2048;
  const auto primes = small_primes();
  const std::uint64_t span = (1ull << 60) / m;  // r in [2^60/m, 2^61/m): p has 61 bits
  for (;; seed = mix(seed)) {
    const std::uint64_t r0 = (span + mix(seed) % (span - 2 * window)) | 1;
    const auto keep = sieve<window>(r0, m, primes);
    for (std::size_t k = 0; k < window; ++k) {
      if (!keep[k]) continue;
      const std::uint64_t r = r0 + 2 * k, p = m * r - 1, q = p / 2;
      if (may_be_prime(r) && may_be_prime(q) && is_prime(r) && is_prime(q) && is_prime(p)) return {p, q, r, m};
    }
  }
}

}  // namespace maupertuis::evaluation
