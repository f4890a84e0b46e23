// Angles over a prime field: the circle group, its multiples of π, and the inverse functions.
#include "symbolic/evaluate/field_numbers.hpp"

#include <numeric>

namespace maupertuis::evaluation {
namespace {

enum : std::uint64_t {
  key_turn = 0x7475726e,
  key_angle = 0x616e67,
  key_generator = 0x67656e,
  key_direction = 0x646972
};

// Beyond it hardly any prime agrees with the reals in every sign; then only the group relations hold.
constexpr std::uint64_t largest_ordered_root = 48;

bool is_inverse_function(Kind kind) {
  return kind == Kind::Asin || kind == Kind::Acos || kind == Kind::Atan || kind == Kind::Atan2;
}

}  // namespace

FieldNumbers::Angle FieldNumbers::turned(Angle a, Angle b) const {
  return {field_.subtract(field_.multiply(a.cosine, b.cosine), field_.multiply(a.sine, b.sine)),
          field_.add(field_.multiply(a.cosine, b.sine), field_.multiply(a.sine, b.cosine))};
}

FieldNumbers::Angle FieldNumbers::turned(Angle a, std::uint64_t times) const {
  Angle result{field_.one(), 0};
  for (; times; times >>= 1) {
    if (times & 1) result = turned(result, a);
    a = turned(a, a);
  }
  return result;
}

/// A random point of the circle by the rational half-angle. 1 + τ² never vanishes, since p = 3 mod 4.
FieldNumbers::Angle FieldNumbers::random_direction(std::uint64_t key) const {
  const Value tau = random(key_direction, key), square = field_.multiply(tau, tau);
  const Value scale = field_.inverse(field_.add(field_.one(), square));
  return {field_.multiply(field_.subtract(field_.one(), square), scale), field_.multiply(field_.add(tau, tau), scale)};
}

void FieldNumbers::choose_generators() {
  const Value any = random(key_generator);
  generator_ = field_.multiply(any, any);
  turn_ = turned(random_direction(0), primes_.m);
  if (generator_ == 0 || generator_ == field_.one() || turn_.sine == 0) throw Redraw{};
  choose_right_angles();
}

PrimeTriple agreeing_primes(const FieldHints& hints, std::uint64_t seed) {
  constexpr int most = 400;
  for (int attempt = 1;; ++attempt, seed = mix(seed)) {
    const PrimeTriple primes = random_prime_triple(hints.m, seed);
    try {
      const FieldNumbers here(primes, hints, seed);
      return primes;
    } catch (const Redraw&) {
      if (attempt >= most) throw;
    }
  }
}

/// The rotation by 2π/m, among the primitive ones that which agrees with the order of the reals: cosines of the first
/// quadrant are positive. This ties cos(π/5) to √5, cos(π/12) to √2 and √6, and so on.
void FieldNumbers::choose_right_angles() {
  const std::uint64_t m = primes_.m, wanted = hints_.m_used;
  root_ = {field_.one(), 0};
  if (wanted == 0) return;
  const auto agrees = [&](Angle step) {  // step: rotation by 2π/wanted
    if (wanted > largest_ordered_root) return true;
    Angle a = step;
    for (std::uint64_t j = 1; 4 * j <= wanted; ++j, a = turned(a, step))
      if (field_.character(a.cosine) < 0 || field_.character(a.sine) < 0) return false;
    return true;
  };
  for (std::uint64_t attempt = 1; attempt < 64; ++attempt) {
    const Angle candidate = turned(random_direction(attempt), primes_.r);
    const Angle step = turned(candidate, m / wanted);
    bool primitive = true;  // no smaller power of step is 1
    for (std::uint64_t d = 2; d <= wanted; ++d) {
      if (wanted % d != 0) continue;
      const Angle power = turned(step, wanted / d);
      primitive &= !(power.cosine == field_.one() && power.sine == 0);
    }
    if (!primitive) continue;
    for (std::uint64_t k = 1; k < wanted; ++k)
      if (std::gcd(k, wanted) == 1 && agrees(turned(step, k))) {
        root_ = turned(step, k);
        return;
      }
    break;  // all primitive roots are powers of this one: none agrees modulo this p
  }
  throw Redraw{true};
}

/// Turns by one term c·rest of an angle.
void FieldNumbers::rotate(const Tape& tape, Position at, const std::vector<Value>& values, Angle& angle) {
  if (tape.kind(at) == Kind::Sum) {
    for (const Position term : tape.arguments(at)) rotate(tape, term, values, angle);
    return;
  }
  if (tape.kind(at) == Kind::Number) {  // sin(x + 1): one is a basis element too
    const Angle unit = turned(turn_, mix(mix(seed_ ^ key_turn) ^ field_.one()) % primes_.r);
    angle = turned(angle, turned(unit, residue_of(tape.expression(at).number(), turns_)));
    return;
  }
  const TermView term = term_view(tape, at);
  const Kind kind = tape.kind(term.rest);
  const auto c = term.coefficient.small();
  if (kind == Kind::Pi && c && hints_.m_used % (2 * static_cast<std::uint64_t>(c->denominator)) == 0 && hints_.m_used) {
    const auto m = static_cast<std::int64_t>(hints_.m_used);
    const auto steps = (c->numerator % (2 * c->denominator)) * (m / (2 * c->denominator));
    angle = turned(angle, turned(root_, static_cast<std::uint64_t>((steps % m + m) % m)));
    return;
  }
  if (is_inverse_function(kind) && c && c->denominator == 1) {
    Angle leaf = direction(tape, term.rest, values);
    if (c->numerator < 0) leaf = opposite(leaf);
    angle = turned(angle, turned(leaf, static_cast<std::uint64_t>(std::abs(c->numerator))));
    return;
  }
  const auto [known, fresh] = units_.try_emplace(term.rest);
  if (fresh) known->second = turned(turn_, mix(mix(seed_ ^ key_turn) ^ term_key(tape, term, values)) % primes_.r);
  Angle unit = known->second;
  if (!c || c->denominator != 1) {
    unit = turned(unit, residue_of(term.coefficient, turns_));
  } else {
    if (c->numerator < 0) unit = opposite(unit);
    unit = turned(unit, static_cast<std::uint64_t>(std::abs(c->numerator)));
  }
  angle = turned(angle, unit);
}

FieldNumbers::Angle FieldNumbers::cos_sin(const Tape& tape, Position argument, const std::vector<Value>& values) {
  const auto known = angles_.find(argument);
  if (known != angles_.end()) return known->second;
  Angle angle{field_.one(), 0};
  rotate(tape, argument, values, angle);
  angles_.emplace(argument, angle);
  return angle;
}

/// The unit vector whose angle an inverse function returns.
FieldNumbers::Angle FieldNumbers::direction(const Tape& tape, Position at, const std::vector<Value>& values) {
  const Value one = field_.one(), x = values[tape.argument(at, 0)];
  const Value complement = field_.subtract(one, field_.multiply(x, x));
  if (tape.kind(at) == Kind::Asin) return {square_root(complement), x};
  if (tape.kind(at) == Kind::Acos) return {x, square_root(complement)};
  const Value along = tape.kind(at) == Kind::Atan2 ? values[tape.argument(at, 1)] : one;
  const Value length = square_root(field_.add(field_.multiply(x, x), field_.multiply(along, along)));
  const Value scale = inverse(length);
  return {field_.multiply(along, scale), field_.multiply(x, scale)};
}

/// The angle as a number, by its symmetries from an angle between 0 and π/4, which is random.
FieldNumbers::Value FieldNumbers::angle_of(Angle a) const {
  if (a.sine == 0 && a.cosine == 0) throw Redraw{};
  if (a.sine == 0) return field_.character(a.cosine) > 0 ? 0 : pi();
  if (field_.character(a.sine) < 0) return field_.negate(angle_of(opposite(a)));
  if (a.cosine == 0) return field_.multiply(pi(), number(Rational(1, 2)));
  if (field_.character(a.cosine) < 0) return field_.subtract(pi(), angle_of({field_.negate(a.cosine), a.sine}));
  if (a.cosine == a.sine) return field_.multiply(pi(), number(Rational(1, 4)));
  if (a.cosine < a.sine)
    return field_.subtract(field_.multiply(pi(), number(Rational(1, 2))), angle_of({a.sine, a.cosine}));
  return random(key_angle, a.cosine);
}

}  // namespace maupertuis::evaluation
