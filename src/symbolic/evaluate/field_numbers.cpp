#include "symbolic/evaluate/field_numbers.hpp"

#include <maupertuis/functions.hpp>

#include <algorithm>
#include <optional>

namespace maupertuis::evaluation {
namespace {

// Keys of the random choices, one a purpose.
enum : std::uint64_t {
  key_symbol = 0x73796d,
  key_exponent = 0x657870,
  key_log = 0x6c6f67,
  key_pi = 0x7069,
  key_root = 0x726f6f74,
};

}  // namespace

FieldNumbers::FieldNumbers(const PrimeTriple& primes, const FieldHints& hints, std::uint64_t seed)
    : field_(primes.p), exponents_(primes.q), turns_(primes.r), primes_(primes), hints_(hints), seed_(seed) {
  choose_generators();
}

void FieldNumbers::set_seed(std::uint64_t seed) {
  seed_ = seed;
  angles_.clear();
  units_.clear();
  drawn_again_.clear();
  choose_generators();
}

Expr FieldNumbers::mend(const Redraw& redraw) {
  const Expr symbol = redraw.another_prime ? Expr() : symbol_to_draw_again(redraw);
  if (!symbol) return {};
  ++drawn_again_[symbol.id()];
  angles_.clear();
  units_.clear();
  return symbol;
}

FieldNumbers::Asking& FieldNumbers::asking(Position at) {
  const auto [it, is_new] = asking_.try_emplace(at);
  if (!is_new) return it->second;
  std::vector<Expr>& symbols = it->second.symbols;
  for (const Expr& e : symbols_of({&hints_.asking.at(at), 1}))
    if (hints_.met_by.count(e.id())) symbols.push_back(e);
  std::stable_sort(symbols.begin(), symbols.end(),
                   [&](const Expr& a, const Expr& b) { return hints_.met_by.at(a.id()) > hints_.met_by.at(b.id()); });
  return it->second;
}

Expr FieldNumbers::symbol_to_draw_again(const Redraw& redraw) {
  if (!hints_.asking.count(redraw.at)) return {};
  Asking& node = asking(redraw.at);
  if (node.drawn_again && node.argument == redraw.argument) std::erase(node.symbols, node.drawn_again);
  node.argument = redraw.argument;
  const auto first =
      std::find_if(node.symbols.begin(), node.symbols.end(), [&](const Expr& e) { return !is_fixed(e); });
  return node.drawn_again = first == node.symbols.end() ? Expr() : *first;
}

FieldNumbers::Value FieldNumbers::random(std::uint64_t key, std::uint64_t second) const {
  return mix(mix(seed_ ^ mix(key)) ^ second) % primes_.p;
}

FieldNumbers::Value FieldNumbers::symbol(Expr e) const {
  const auto again = drawn_again_.find(e.id());
  const Value x = random(again == drawn_again_.end() ? key_symbol : mix(key_symbol + again->second), e.id());
  return hints_.positive.count(e.id()) && field_.character(x) < 0 ? field_.negate(x) : x;
}

/// π is positive: it has a root.
FieldNumbers::Value FieldNumbers::pi() const {
  const Value x = random(key_pi);
  return field_.character(x) < 0 ? field_.negate(x) : x;
}

FieldNumbers::Value FieldNumbers::inverse(Value a) const {
  if (a == 0) throw Redraw{};
  return field_.inverse(a);
}

// ------------------------------------------------------------------------------------------ signs, roots, powers

int FieldNumbers::sign(Position argument, Value value) const {
  const int sign = field_.character(value);
  if (sign == 0 || !has_sign(argument, value, sign)) throw Redraw{};
  return sign;
}

/// Is it of this sign, and may it be, by what is known of the argument at real points?
bool FieldNumbers::has_sign(Position argument, Value value, int sign) const {
  const int known = argument < hints_.sign.size() ? hints_.sign[argument] : 0;
  return field_.character(value) == sign && (known == 0 || known == sign);
}

/// Its roots have no value at any real point.
bool FieldNumbers::is_never_positive(Position argument) const {
  return argument < hints_.sign.size() && hints_.sign[argument] < 0;
}

FieldNumbers::Value FieldNumbers::positive(Value a) const {
  if (field_.character(a) <= 0) throw Redraw{};
  return a;
}

/// p = 3 mod 4: this root is itself a square, hence multiplicative and "positive".
FieldNumbers::Value FieldNumbers::square_root(Value a) const {
  return a == 0 ? 0 : field_.power(positive(a), (primes_.p + 1) / 4);
}

FieldNumbers::Value FieldNumbers::positive_power(Value base, std::uint64_t exponent) const {
  return field_.power(positive(base), exponent);
}

std::uint64_t FieldNumbers::residue_of(const Rational& c, const PrimeField& group) const {
  return group.residue(group.from(c));
}
std::uint64_t FieldNumbers::exponent_of(const Rational& c) const { return residue_of(c, exponents_); }

FieldNumbers::Value FieldNumbers::free_power(Value base, const Rational& exponent) const {
  if (base == 0) throw Redraw{};
  const auto parts = exponent.small();
  std::int64_t whole = parts ? parts->numerator / parts->denominator : 0;
  if (parts && parts->numerator < 0) --whole;  // no integer: it is not a multiple of its denominator
  const Value fraction = field_.from(exponent - Rational(whole)),
              integer = whole < 0 ? field_.power(field_.inverse(base), static_cast<std::uint64_t>(-whole))
                                  : field_.power(base, static_cast<std::uint64_t>(whole));
  return field_.multiply(integer, random(mix(key_root ^ fraction), base));
}

/// What a term c·rest is the multiple of, as a number that names it: its value divided by c.
FieldNumbers::Value FieldNumbers::term_key(const Tape& tape, const TermView& term,
                                           const std::vector<Value>& values) const {
  const Value value = values[term.rest];
  const bool rest_holds_coefficient = !term.coefficient.is_one() && tape.kind(term.rest) == Kind::Product &&
                                      tape.kind(tape.argument(term.rest, 0)) == Kind::Number &&
                                      tape.arguments(term.rest).size() > 2;
  return rest_holds_coefficient ? field_.multiply(value, inverse(number(term.coefficient))) : value;
}

/// An exponent as a residue modulo q: a sum of rational multiples of basis elements, each a random residue.
std::uint64_t FieldNumbers::exponent_of(const Tape& tape, Position at, const std::vector<Value>& values) {
  if (tape.kind(at) == Kind::Number) return exponent_of(tape.expression(at).number());
  if (tape.kind(at) == Kind::Sum) {
    std::uint64_t sum = 0;
    for (const Position term : tape.arguments(at)) sum = (sum + exponent_of(tape, term, values)) % primes_.q;
    return sum;
  }
  const TermView term = term_view(tape, at);
  const std::uint64_t atom = mix(mix(seed_ ^ key_exponent) ^ term_key(tape, term, values)) % primes_.q;
  return static_cast<std::uint64_t>(static_cast<Wide>(exponent_of(term.coefficient)) * atom % primes_.q);
}

FieldNumbers::Value FieldNumbers::power(const Tape& tape, Position at, const std::vector<Value>& values) {
  const Position base = tape.argument(at, 0), exponent = tape.argument(at, 1);
  const Rational* number = tape.expression(exponent).number_or_null();
  if (number) {
    if (const auto n = number->as_integer()) {
      if (*n < 0) return field_.power(inverse(values[base]), static_cast<std::uint64_t>(-*n));
      return field_.power(values[base], static_cast<std::uint64_t>(*n));
    }
  }
  if (number && free_roots_ && tape.kind(base) != Kind::Number && !is_never_positive(base))
    return free_power(values[base], *number);
  if (!has_sign(base, values[base], 1)) {
    // Within a piece that is not in force here: any number will do, and the other pieces are met.
    if (stands_in_a_piece(at)) return random(mix(key_root ^ values[exponent]), values[base]);
    throw Redraw{false, at, values[base]};
  }
  return field_.power(values[base], number ? exponent_of(*number) : exponent_of(tape, exponent, values));
}

// ------------------------------------------------------------------------------------------------- exp and log

/// A positive u with exp(rest) = u, where rest is a function that inverts exp; nothing for all others.
std::optional<FieldNumbers::Value> FieldNumbers::exponential_of_inverse(const Tape& tape, Position rest,
                                                                        const std::vector<Value>& values) const {
  const Kind kind = tape.kind(rest);
  if (!is_function(kind)) return std::nullopt;
  const Value x = values[tape.argument(rest, 0)], one = field_.one();
  if (kind == Kind::Log) return x;
  if (kind == Kind::Asinh) return field_.add(x, square_root(field_.add(field_.multiply(x, x), one)));
  if (kind == Kind::Acosh) return field_.add(x, square_root(field_.subtract(field_.multiply(x, x), one)));
  if (kind == Kind::Atanh) return square_root(field_.multiply(field_.add(one, x), inverse(field_.subtract(one, x))));
  if (kind == Kind::LambertW) return field_.multiply(x, inverse(values[rest]));
  return std::nullopt;
}

/// Multiplies by exp of one term c·rest. Where rest holds a logarithm, exp(c·s·log u) = u^(c·s).
void FieldNumbers::multiply_exponential(const Tape& tape, Position at, const std::vector<Value>& values,
                                        Value& product) {
  if (tape.kind(at) == Kind::Sum) {
    for (const Position term : tape.arguments(at)) multiply_exponential(tape, term, values, product);
    return;
  }
  const TermView term = term_view(tape, at);
  const std::uint64_t c = exponent_of(term.coefficient);
  const Position rest = term.rest;
  const auto times = [&](Value base, std::uint64_t exponent) {
    product = field_.multiply(product, positive_power(base, exponent));
  };
  if (const auto base = exponential_of_inverse(tape, rest, values)) return times(*base, c);
  if (tape.kind(rest) == Kind::Product)
    for (const Position factor : tape.arguments(rest))
      if (tape.kind(factor) == Kind::Log) {
        const Value key = field_.multiply(term_key(tape, term, values), inverse(values[factor]));
        const std::uint64_t s = mix(mix(seed_ ^ key_exponent) ^ key) % primes_.q;
        return times(values[tape.argument(factor, 0)],
                     static_cast<std::uint64_t>(static_cast<Wide>(c) * s % primes_.q));
      }
  product = field_.multiply(product, field_.power(generator_, exponent_of(tape, at, values)));
}

FieldNumbers::Value FieldNumbers::exponential(const Tape& tape, Position argument, const std::vector<Value>& values) {
  Value product = field_.one();
  multiply_exponential(tape, argument, values, product);
  return product;
}

FieldNumbers::Value FieldNumbers::logarithm_of_number(const Rational& value) const {
  const auto parts = value.small();
  if (!parts) return random(key_log, field_.from(value));
  Value sum = 0;
  const auto add_factors = [&](std::uint64_t n, bool below) {
    const auto add_one = [&](std::uint64_t factor) {
      const Value log = random(key_log, field_.from_residue(factor));
      sum = below ? field_.subtract(sum, log) : field_.add(sum, log);
    };
    for (std::uint64_t d = 2; d < 1000 && d * d <= n; ++d)
      for (; n % d == 0; n /= d) add_one(d);
    if (n > 1) add_one(n);
  };
  add_factors(static_cast<std::uint64_t>(std::abs(parts->numerator)), false);
  add_factors(static_cast<std::uint64_t>(parts->denominator), true);
  return sum;
}

/// log |x| by the structure of x: products, powers and exponentials are taken apart, a sum gives up its content.
FieldNumbers::Value FieldNumbers::absolute_logarithm(const Tape& tape, Position at, const std::vector<Value>& values) {
  const Kind kind = tape.kind(at);
  const auto argument = [&](std::size_t i) { return tape.argument(at, i); };
  if (kind == Kind::Number) return logarithm_of_number(tape.expression(at).number());
  if (kind == Kind::Exp) return values[argument(0)];
  if (kind == Kind::Abs) return absolute_logarithm(tape, argument(0), values);
  if (kind == Kind::LambertW)
    return field_.subtract(absolute_logarithm(tape, argument(0), values), values[at]);  // w = x e^(−w)
  if (kind == Kind::Power) return field_.multiply(values[argument(1)], absolute_logarithm(tape, argument(0), values));
  if (kind == Kind::Product) {
    Value sum = 0;
    for (const Position factor : tape.arguments(at)) sum = field_.add(sum, absolute_logarithm(tape, factor, values));
    return sum;
  }
  Value value = values[at], content = 0;
  if (tape.kind(at) == Kind::Sum) {
    const Rational first = tape.kind(tape.argument(at, 0)) == Kind::Number
                               ? tape.expression(tape.argument(at, 0)).number()
                               : term_view(tape, tape.argument(at, 0)).coefficient;
    content = logarithm_of_number(first);
    value = field_.multiply(value, inverse(number(first)));
  }
  const int sign = field_.character(value);
  if (sign == 0) throw Redraw{};
  return field_.add(content, random(key_log, sign < 0 ? field_.negate(value) : value));
}

FieldNumbers::Value FieldNumbers::logarithm(const Tape& tape, Position argument, const std::vector<Value>& values) {
  if (!has_sign(argument, values[argument], 1)) throw Redraw{};
  return absolute_logarithm(tape, argument, values);
}

// --------------------------------------------------------------------------------------------------- functions

bool FieldNumbers::holds(const Tape& tape, Position condition, const std::vector<Value>& values) {
  const Position a = tape.argument(condition, 0), b = tape.argument(condition, 1);
  const Kind kind = tape.kind(condition);
  if (kind == Kind::And) return holds(tape, a, values) && holds(tape, b, values);
  if (kind == Kind::Or) return holds(tape, a, values) || holds(tape, b, values);
  if (family_of(kind) != Family::Comparison) throw unknown_kind(kind, "a condition over a prime field");
  const int sign = field_.character(field_.subtract(values[b], values[a]));
  if (sign == 0) throw Redraw{};
  return sign > 0;
}

/// A random number that depends on the value of the argument alone, with the parity of the function: the image of a
/// function of which no more is known.
FieldNumbers::Value FieldNumbers::opaque(Kind kind, Value x) const {
  const Parity parity = functions::of_row(kind, [](const auto& row) { return row.parity; });
  const bool flip = parity != Parity::None && field_.character(x) < 0;
  const Value value = random(mix(key_log) + static_cast<std::uint64_t>(kind), flip ? field_.negate(x) : x);
  return flip && parity == Parity::Odd ? field_.negate(value) : value;
}

/// W(x) has the sign of x: then exp W(x) = x/W(x) is positive.
FieldNumbers::Value FieldNumbers::lambert_w(Value x) const {
  const Value w = opaque(Kind::LambertW, x);
  return field_.character(w) == field_.character(x) ? w : field_.negate(w);
}

FieldNumbers::Value FieldNumbers::function(const Tape& tape, Position at, const std::vector<Value>& values) {
  const Position argument = tape.argument(at, 0);
  const auto half = [&](Value a) { return field_.multiply(a, number(Rational(1, 2))); };
  const auto smaller = [&] {
    const Value a = values[argument], b = values[tape.argument(at, 1)];
    return field_.character(field_.subtract(b, a)) > 0 ? std::pair{a, b} : std::pair{b, a};
  };
  switch (tape.kind(at)) {
    case Kind::Power:
      return power(tape, at, values);
    case Kind::Sin:
      return cos_sin(tape, argument, values).sine;
    case Kind::Cos:
      return cos_sin(tape, argument, values).cosine;
    case Kind::Tan: {
      const Angle a = cos_sin(tape, argument, values);
      return field_.multiply(a.sine, inverse(a.cosine));
    }
    case Kind::Asin:
    case Kind::Acos:
    case Kind::Atan:
    case Kind::Atan2:
      return angle_of(direction(tape, at, values));
    case Kind::Exp:
      return exponential(tape, argument, values);
    case Kind::Sinh:
    case Kind::Cosh:
    case Kind::Tanh: {
      const Value e = exponential(tape, argument, values), f = inverse(e);
      const Value sinh = half(field_.subtract(e, f)), cosh = half(field_.add(e, f));
      if (tape.kind(at) == Kind::Tanh) return field_.multiply(sinh, inverse(cosh));
      return tape.kind(at) == Kind::Sinh ? sinh : cosh;
    }
    case Kind::Log:
      return stands_in_a_piece(at) ? absolute_logarithm(tape, argument, values) : logarithm(tape, argument, values);
    // The logarithms of exp of these nodes; and a function that no algebra ties to others.
    case Kind::Asinh:
    case Kind::Acosh:
    case Kind::Atanh:
    case Kind::Erf:
      return opaque(tape.kind(at), values[argument]);
    case Kind::LambertW:
      return lambert_w(values[argument]);
    case Kind::Abs:
      return sign(argument, values[argument]) < 0 ? field_.negate(values[argument]) : values[argument];
    case Kind::Sign:
      return number(sign(argument, values[argument]));
    case Kind::Step:
      return number(sign(argument, values[argument]) > 0 ? 1 : 0);
    case Kind::Min:
      return smaller().first;
    case Kind::Max:
      return smaller().second;
    case Kind::Piecewise: {
      const auto arguments = tape.arguments(at);
      for (std::size_t i = 0; i + 1 < arguments.size(); i += 2)
        if (holds(tape, arguments[i], values)) return values[arguments[i + 1]];
      return values[arguments.back()];
    }
    case Kind::Less:
    case Kind::LessEqual:
    case Kind::And:
    case Kind::Or:
      return 0;  // asked by `holds`
    case Kind::Number:
    case Kind::Pi:
    case Kind::Symbol:
    case Kind::Sum:
    case Kind::Product:
    case Kind::TimeDerivative:
      break;
  }
  throw unknown_kind(tape.kind(at), "an evaluation over a prime field");
}

}  // namespace maupertuis::evaluation
