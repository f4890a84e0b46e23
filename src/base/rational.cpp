#include <maupertuis/rational.hpp>
#include <maupertuis/require.hpp>

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace maupertuis {

using BigInteger = boost::multiprecision::cpp_int;
using BigRational = boost::multiprecision::cpp_rational;
__extension__ typedef __int128 Wide;

struct Rational::Big {
  BigRational value;
};

namespace {

constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();

bool fits(Wide value) { return value >= -Wide(largest) && value <= Wide(largest); }

Wide greatest_common_divisor(Wide a, Wide b) {
  if (a < 0) a = -a;
  while (b != 0) {
    const Wide r = a % b;
    a = b;
    b = r;
  }
  return a;
}

std::uint64_t mod(const BigInteger& value, std::uint64_t prime) {
  BigInteger r = value % prime;
  if (r < 0) r += prime;
  return static_cast<std::uint64_t>(r);
}

std::uint64_t mod(std::int64_t value, std::uint64_t prime) {
  const auto p = static_cast<std::int64_t>(prime);
  const std::int64_t r = value % p;
  return static_cast<std::uint64_t>(r < 0 ? r + p : r);
}

BigRational big_value(const Rational::Big* big, std::int64_t numerator, std::int64_t denominator) {
  return big ? big->value : BigRational(numerator, denominator);
}

/// Rounds a positive quotient to nearest even by integer arithmetic.
double rounded_quotient(BigInteger n, BigInteger d) {
  const long shift = static_cast<long>(msb(n)) - static_cast<long>(msb(d));
  if (shift > 1100) return std::numeric_limits<double>::infinity();
  if (shift < -1200) return 0.0;
  const long subnormal_floor = -1074;
  long scale = std::max(shift - 54, subnormal_floor - 2);  // quotient has 54 or 55 bits, fewer when subnormal
  if (scale > 0)
    d <<= scale;
  else
    n <<= -scale;
  BigInteger quotient, remainder;
  divide_qr(n, d, quotient, remainder);
  if (quotient == 0) return 0.0;
  // Round by hand to 53 bits (or to the subnormal grid) with the sticky bit of the remainder.
  const long bits = static_cast<long>(msb(quotient)) + 1;
  const long drop = std::max(bits - 53, subnormal_floor - scale);
  auto q = static_cast<std::uint64_t>(quotient);
  if (drop > 0) {
    const std::uint64_t half = 1ull << (drop - 1), mask = (1ull << drop) - 1, tail = q & mask;
    q >>= drop;
    if (tail > half || (tail == half && (remainder != 0 || (q & 1)))) ++q;
  }
  return std::ldexp(static_cast<double>(q), static_cast<int>(scale + std::max(drop, 0L)));
}

}  // namespace

Rational Rational::from_big(std::shared_ptr<const Big> big) {
  const BigInteger n = numerator(big->value), d = denominator(big->value);
  Rational r;
  if (abs(n) <= largest && d <= largest) {
    r.numerator_ = static_cast<std::int64_t>(n);
    r.denominator_ = static_cast<std::int64_t>(d);
  } else {
    r.big_ = std::move(big);
  }
  return r;
}

std::shared_ptr<const Rational::Big> Rational::promote() const {
  return big_ ? big_ : std::make_shared<const Big>(Big{BigRational(numerator_, denominator_)});
}

Rational::Rational(std::int64_t numerator, std::int64_t denominator) {
  MAUP_REQUIRE(denominator != 0);
  *this = Rational(numerator) / Rational(denominator);
}

std::optional<Rational> Rational::parse(std::string_view text) {
  std::size_t i = 0;
  const bool negative = i < text.size() && text[i] == '-';
  if (negative) ++i;
  BigInteger digits = 0;
  std::string collected;
  int scale = 0;
  bool point = false;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c >= '0' && c <= '9') {
      collected += c;
      scale -= point;
    } else if (c == '.' && !point)
      point = true;
    else
      break;
  }
  if (collected.empty()) return std::nullopt;
  const std::size_t leading = collected.find_first_not_of('0');
  if (leading != std::string::npos) digits = BigInteger(collected.substr(leading));
  BigInteger denominator = 1;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    char* end = nullptr;
    const std::string exponent(text.substr(i + 1));
    if (exponent.empty() || std::isspace(static_cast<unsigned char>(exponent[0]))) return std::nullopt;
    const long value = std::strtol(exponent.c_str(), &end, 10);
    if (*end != '\0' || value < -4000 || value > 4000) return std::nullopt;
    scale += static_cast<int>(value);
  } else if (i < text.size() && text[i] == '/') {
    const std::string bottom(text.substr(i + 1));
    if (bottom.empty() || bottom.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
    const std::size_t nonzero = bottom.find_first_not_of('0');
    if (nonzero == std::string::npos) return std::nullopt;
    denominator = BigInteger(bottom.substr(nonzero));
  } else if (i != text.size()) {
    return std::nullopt;
  }
  if (scale < 0)
    denominator *= pow(BigInteger(10), static_cast<unsigned>(-scale));
  else
    digits *= pow(BigInteger(10), static_cast<unsigned>(scale));
  BigRational value(digits, denominator);
  return from_big(std::make_shared<const Big>(Big{negative ? BigRational(-value) : value}));
}

Rational Rational::from_double(double value) {
  MAUP_REQUIRE(std::isfinite(value));
  return from_big(std::make_shared<const Big>(Big{BigRational(value)}));
}

bool Rational::is_integer() const { return big_ ? denominator(big_->value) == 1 : denominator_ == 1; }

int Rational::sign() const {
  if (big_) return big_->value.sign();
  return (numerator_ > 0) - (numerator_ < 0);
}

std::optional<Rational::Small> Rational::small() const {
  if (big_) return std::nullopt;
  return Small{numerator_, denominator_};
}

std::optional<std::int64_t> Rational::as_integer() const {
  if (big_ || denominator_ != 1) return std::nullopt;
  return numerator_;
}

double Rational::to_double() const {
  constexpr std::int64_t exact = std::int64_t{1} << 53;
  if (!big_ && std::abs(numerator_) <= exact && denominator_ <= exact)
    return static_cast<double>(numerator_) / static_cast<double>(denominator_);
  const BigRational value = big_value(big_.get(), numerator_, denominator_);
  const double magnitude = rounded_quotient(abs(numerator(value)), denominator(value));
  return sign() < 0 ? -magnitude : magnitude;
}

std::string Rational::to_string() const {
  return is_integer() ? numerator_string() : numerator_string() + "/" + denominator_string();
}
std::string Rational::numerator_string() const {
  return big_ ? numerator(big_->value).str() : std::to_string(numerator_);
}
std::string Rational::denominator_string() const {
  return big_ ? denominator(big_->value).str() : std::to_string(denominator_);
}

std::uint64_t Rational::numerator_mod(std::uint64_t prime) const {
  return big_ ? mod(numerator(big_->value), prime) : mod(numerator_, prime);
}
std::uint64_t Rational::denominator_mod(std::uint64_t prime) const {
  return big_ ? mod(denominator(big_->value), prime) : mod(denominator_, prime);
}

std::size_t Rational::hash() const {
  constexpr std::uint64_t prime = 2305843009213693951ull;  // 2^61 − 1
  return numerator_mod(prime) * 0x9E3779B97F4A7C15ull ^ denominator_mod(prime);
}

namespace {

/// gcd(n, d), d > 0. Halves, quarters and integers are what most sums and products of terms are made of.
std::int64_t common_divisor(std::int64_t n, std::int64_t d) {
  const bool power_of_two = (d & (d - 1)) == 0;
  if (!power_of_two || n == 0) return std::gcd(n, d);
  return std::min(n & -n, d);
}

/// The small result n/d in lowest terms, if it fits. Precondition: d > 0.
std::optional<Rational::Small> reduce(Wide n, Wide d) {
  if (fits(n) && fits(d)) {  // nearly always, at a tenth of the price
    const auto numerator = static_cast<std::int64_t>(n), denominator = static_cast<std::int64_t>(d);
    const std::int64_t g = common_divisor(numerator, denominator);
    return g == 1 ? Rational::Small{numerator, denominator} : Rational::Small{numerator / g, denominator / g};
  }
  const Wide g = greatest_common_divisor(n, d);
  n /= g;
  d /= g;
  if (!fits(n) || !fits(d)) return std::nullopt;
  return Rational::Small{static_cast<std::int64_t>(n), static_cast<std::int64_t>(d)};
}

}  // namespace

Rational operator+(const Rational& a, const Rational& b) {
  if (!a.big_ && !b.big_) {
    if (a.denominator_ == 1 && b.denominator_ == 1) {
      std::int64_t sum = 0;
      if (!__builtin_add_overflow(a.numerator_, b.numerator_, &sum) && sum != std::numeric_limits<std::int64_t>::min())
        return Rational(sum);
    }
    // Each product is below 2^126, their sum below 2^127.
    const Wide n = Wide(a.numerator_) * b.denominator_ + Wide(b.numerator_) * a.denominator_;
    if (const auto small = reduce(n, Wide(a.denominator_) * b.denominator_)) {
      Rational r;
      r.numerator_ = small->numerator;
      r.denominator_ = small->denominator;
      return r;
    }
  }
  return Rational::from_big(
      std::make_shared<const Rational::Big>(Rational::Big{a.promote()->value + b.promote()->value}));
}

Rational operator*(const Rational& a, const Rational& b) {
  if (!a.big_ && !b.big_) {
    if (const auto small = reduce(Wide(a.numerator_) * b.numerator_, Wide(a.denominator_) * b.denominator_)) {
      Rational r;
      r.numerator_ = small->numerator;
      r.denominator_ = small->denominator;
      return r;
    }
  }
  return Rational::from_big(
      std::make_shared<const Rational::Big>(Rational::Big{a.promote()->value * b.promote()->value}));
}

Rational operator/(const Rational& a, const Rational& b) {
  MAUP_REQUIRE(!b.is_zero());
  if (b.big_) {
    return Rational::from_big(std::make_shared<const Rational::Big>(Rational::Big{a.promote()->value / b.big_->value}));
  }
  Rational inverse;
  inverse.numerator_ = b.numerator_ < 0 ? -b.denominator_ : b.denominator_;
  inverse.denominator_ = std::abs(b.numerator_);
  return a * inverse;
}

Rational operator-(const Rational& a) {
  if (a.big_) return Rational::from_big(std::make_shared<const Rational::Big>(Rational::Big{-a.big_->value}));
  Rational r = a;
  r.numerator_ = -r.numerator_;
  return r;
}

Rational operator-(const Rational& a, const Rational& b) { return a + (-b); }

bool operator==(const Rational& a, const Rational& b) {
  if (static_cast<bool>(a.big_) != static_cast<bool>(b.big_)) return false;
  if (a.big_) return a.big_->value == b.big_->value;
  return a.numerator_ == b.numerator_ && a.denominator_ == b.denominator_;
}

bool operator<(const Rational& a, const Rational& b) {
  if (a.big_ || b.big_) return a.promote()->value < b.promote()->value;
  return Wide(a.numerator_) * b.denominator_ < Wide(b.numerator_) * a.denominator_;
}

Rational abs(const Rational& value) { return value.sign() < 0 ? -value : value; }

Rational pow(const Rational& value, int exponent) {
  Rational base = exponent < 0 ? Rational(1) / value : value, result = 1;
  for (unsigned e = static_cast<unsigned>(std::abs(exponent)); e != 0; e >>= 1) {
    if (e & 1u) result *= base;
    if (e > 1) base *= base;
  }
  return result;
}

namespace {

/// Newton's method from above falls down to the root, doubling its digits: numbers of a thousand digits take a dozen
/// divisions.
std::optional<BigInteger> integer_root(const BigInteger& n, int k) {
  if (n == 0 || n == 1) return n;
  const auto others = static_cast<unsigned>(k - 1);
  BigInteger root = BigInteger(1) << (msb(n) / static_cast<unsigned>(k) + 1);
  while (true) {
    BigInteger next = (root * others + n / pow(root, others)) / (others + 1);
    if (next >= root) break;
    root = std::move(next);
  }
  if (pow(root, static_cast<unsigned>(k)) == n) return root;
  return std::nullopt;
}

/// Euler's criterion: a square is one modulo each prime, and of other numbers half are at each.
bool is_square_modulo_primes(const Rational& value) {
  for (const std::uint64_t prime : {1000003, 1000033, 1000037, 1000039, 1000081, 1000099, 1000117, 1000121})
    for (std::uint64_t base : {value.numerator_mod(prime), value.denominator_mod(prime)}) {
      std::uint64_t power = 1;
      const bool divides = base == 0;
      for (std::uint64_t exponent = (prime - 1) / 2; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1) power = power * base % prime;
        base = base * base % prime;
      }
      if (!divides && power != 1) return false;
    }
  return true;
}

}  // namespace

std::optional<Rational> exact_root(const Rational& value, int k) {
  if (value.sign() < 0) return std::nullopt;
  if (const auto small = value.small()) {
    const auto n = integer_root(BigInteger(small->numerator), k), d = integer_root(BigInteger(small->denominator), k);
    return n && d ? std::optional(Rational(n->convert_to<std::int64_t>(), d->convert_to<std::int64_t>()))
                  : std::nullopt;
  }
  if (k == 2 && !is_square_modulo_primes(value)) return std::nullopt;
  const auto n = integer_root(BigInteger(value.numerator_string()), k);
  if (!n) return std::nullopt;
  const auto d = integer_root(BigInteger(value.denominator_string()), k);
  if (!d) return std::nullopt;
  return Rational::parse(n->str() + "/" + d->str());
}

}  // namespace maupertuis
