#include <maupertuis/functions.hpp>
#include <maupertuis/require.hpp>

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/expression/storage.hpp"

#include <algorithm>
#include <array>

namespace maupertuis {
namespace {

/// A sum or product under construction: (rest, coefficient) of terms, or (base, exponent) of factors.
struct Entry {
  NodeId id;
  Rational value;
};

/// Sorts by id and adds the values of equal ids; entries whose value became zero vanish.
void collect(std::vector<Entry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.id < b.id; });
  std::size_t out = 0;
  for (std::size_t i = 0; i < entries.size();) {
    Entry merged = entries[i++];
    for (; i < entries.size() && entries[i].id == merged.id; ++i) merged.value += entries[i].value;
    if (!merged.value.is_zero()) entries[out++] = std::move(merged);
  }
  entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(out), entries.end());
}

std::vector<NodeId> ids_of(std::span<const Expr> expressions) {
  std::vector<NodeId> ids;
  ids.reserve(expressions.size());
  for (const Expr& e : expressions) ids.push_back(e.id());
  return ids;
}

constexpr int largest_folded_exponent = 512;

/// n^e for an integer e that is small enough to be worth carrying out.
std::optional<Rational> folded_power(const Rational& base, const Rational& exponent) {
  if (base.is_one()) return Rational(1);
  const auto e = exponent.as_integer();
  if (e) {
    if (base.is_zero()) return *e > 0 ? std::optional<Rational>(0) : std::nullopt;
    if (std::abs(*e) > largest_folded_exponent) return std::nullopt;
    return pow(base, static_cast<int>(*e));
  }
  const auto parts = exponent.small();
  if (!parts || parts->denominator > 64 || std::abs(parts->numerator) > 64 || base.sign() <= 0) return std::nullopt;
  const auto root = exact_root(base, static_cast<int>(parts->denominator));
  return root ? std::optional<Rational>(pow(*root, static_cast<int>(parts->numerator))) : std::nullopt;
}

/// (x^a)^b = x^(ab) holds for every real x where the left side is defined if b is an integer, or if x must be
/// nonnegative because a has an even denominator.
bool powers_combine(const Rational& inner, const Rational& outer) {
  if (outer.is_integer()) return true;
  const auto parts = inner.small();
  return parts && parts->denominator % 2 == 0;
}

/// (x^a)^b = |x|^(ab) for even a: √(x²) = |x|. Taken only where the root disappears.
bool root_of_even_power(const Rational& inner, const Rational& outer) {
  const auto a = inner.as_integer();
  return a && *a % 2 == 0 && !outer.is_integer() && (inner * outer).is_integer();
}

}  // namespace

Expr Context::sum(std::span<const Expr> terms) {
  std::vector<Entry> entries;
  entries.reserve(terms.size());
  Rational constant = 0;
  for (const Expr& term : terms) {
    if (term.is_number()) {
      constant += term.number();
      continue;
    }
    ScaledTerm scaled = split_coefficient(term);
    entries.push_back({scaled.rest.id(), std::move(scaled.coefficient)});
  }
  collect(entries);
  std::vector<NodeId> arguments;
  arguments.reserve(entries.size() + 1);
  if (!constant.is_zero()) arguments.push_back(number(constant).id());
  for (const Entry& entry : entries) {
    const Expr rest(this, entry.id);
    arguments.push_back((entry.value.is_one() ? rest : number(entry.value) * rest).id());
  }
  if (arguments.empty()) return number(0);
  if (arguments.size() == 1) return Expr(this, arguments.front());
  return Expr(this, storage_->intern(Kind::Sum, arguments));
}

namespace {

/// Appends the factors of a product, a power or any other factor; numbers go into the coefficient.
void gather_factor(const Expr& factor, std::vector<Entry>& entries, Rational& coefficient) {
  if (factor.is_number()) {
    coefficient *= factor.number();
    return;
  }
  if (factor.is(Kind::Product)) {
    for (const NodeId id : factor.argument_ids()) gather_factor(Expr(&factor.context(), id), entries, coefficient);
    return;
  }
  PowerOf power = split_power(factor);
  entries.push_back({power.base.id(), std::move(power.exponent)});
}

/// sign(x) |x|^n = x |x|^(n−1) for odd n: the places of the two factors.
std::optional<std::pair<std::size_t, std::size_t>> sign_beside_size(Context* context, std::span<const NodeId> factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const Expr sign(context, factors[i]);
    if (!sign.is(Kind::Sign)) continue;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const PowerOf size = split_power(Expr(context, factors[k]));
      const auto exponent = size.exponent.as_integer();
      if (size.base.is(Kind::Abs) && size.base[0] == sign[0] && exponent && *exponent % 2 != 0) return {{i, k}};
    }
  }
  return std::nullopt;
}

}  // namespace

Expr Context::product(std::span<const Expr> factors) {
  std::vector<Entry> entries;
  entries.reserve(factors.size() + 2);
  Rational coefficient = 1;
  for (const Expr& factor : factors) gather_factor(factor, entries, coefficient);
  if (coefficient.is_zero()) return number(0);
  collect(entries);
  std::vector<NodeId> arguments;
  arguments.reserve(entries.size() + 1);
  bool regroup = false;  // a power fell apart into other bases, which may stand here already
  for (const Entry& entry : entries) {
    const Expr base(this, entry.id);
    const Expr factor = entry.value.is_one() ? base : power(base, number(entry.value));
    if (factor.is_number()) {
      coefficient *= factor.number();
      continue;
    }
    regroup |= factor.is(Kind::Product) || split_power(factor).base != base;
    arguments.push_back(factor.id());
  }
  const auto sign = sign_beside_size(this, arguments);
  if (regroup || sign) {
    std::vector<Expr> again{number(coefficient)};
    for (const NodeId id : arguments) again.emplace_back(this, id);
    if (sign) {
      const Expr x = again[sign->first + 1][0], size = again[sign->second + 1];
      again[sign->first + 1] = x;
      again[sign->second + 1] = size.is(Kind::Abs) ? number(1) : power(apply(Kind::Abs, x), size[1] - number(1));
    }
    return product(again);
  }
  if (coefficient.is_zero() || arguments.empty()) return number(coefficient);
  if (arguments.size() == 1 && coefficient.is_one()) return Expr(this, arguments.front());
  if (!coefficient.is_one()) arguments.insert(arguments.begin(), number(coefficient).id());
  return Expr(this, storage_->intern(Kind::Product, arguments));
}

Expr Context::power(Expr base, Expr exponent) {
  if (const Rational* e = exponent.number_or_null()) {
    if (e->is_zero()) return number(1);
    if (e->is_one()) return base;
    if (base.is_number())
      if (const auto folded = folded_power(base.number(), *e)) return number(*folded);
    if (base.is(Kind::Power) && base[1].is_number() && powers_combine(base[1].number(), *e))
      return power(base[0], number(base[1].number() * *e));
    if (base.is(Kind::Power) && base[1].is_number() && root_of_even_power(base[1].number(), *e))
      return power(apply(Kind::Abs, base[0]), number(base[1].number() * *e));
    if (base.is(Kind::Product) && e->is_integer()) {
      std::vector<Expr> factors;
      for (const NodeId id : base.argument_ids()) factors.push_back(power(Expr(this, id), exponent));
      return product(factors);
    }
    if (base.is(Kind::Abs) && e->is_integer() && *e->as_integer() % 2 == 0) return power(base[0], exponent);
  }
  if (base.is_one()) return base;
  const std::array arguments{base.id(), exponent.id()};
  return Expr(this, storage_->intern(Kind::Power, arguments));
}

namespace {

/// True if the expression is written with a leading minus: −x, −3, or a sum whose first term has one.
bool leads_with_minus(const Expr& e) {
  if (e.is_number()) return e.number().sign() < 0;
  if (e.is(Kind::Product)) return e[0].is_number() && e[0].number().sign() < 0;
  if (e.is(Kind::Sum)) {
    // The numeric term is left out of the decision, so that x + 1 and −x − 1 are seen as opposites either way.
    // An inner sum counts as positive whatever it begins with: its opposite is −1 times it, and leads with a minus.
    const Expr first = e[0].is_number() ? e[1] : e[0];
    return !first.is(Kind::Sum) && leads_with_minus(first);
  }
  return false;
}

Expr negated(const Expr& e) {
  Context& context = e.context();
  if (!e.is(Kind::Sum)) return context.number(-1) * e;
  std::vector<Expr> terms;
  for (const NodeId id : e.argument_ids()) terms.push_back(context.number(-1) * Expr(&context, id));
  return context.sum(terms);
}

/// The exact value at a number, where it has one.
std::optional<Rational> folded_function(Kind kind, const Rational& x) {
  if (is_function(kind))
    return functions::of_row(kind, [&](const auto& row) {
      return x == Rational(row.at) ? std::optional<Rational>(row.exactly) : std::nullopt;
    });
  if (kind == Kind::Abs) return abs(x);
  if (kind == Kind::Sign) return Rational(x.sign());
  if (kind == Kind::Step) return Rational(x.sign() >= 0 ? 1 : 0);
  throw unknown_kind(kind, "the folding of numbers");
}

}  // namespace

Expr Context::function(Kind kind, std::span<const Expr> arguments) {
  const KindInfo& info = kind_info(kind);
  MAUP_REQUIRE(family_of(kind) != Family::Leaf &&
               (info.arity < 0 || arguments.size() == static_cast<std::size_t>(info.arity)));
  if (arguments.size() == 1) {
    const Expr x = arguments.front();
    if (x.is_number())
      if (const auto folded = folded_function(kind, x.number())) return number(*folded);
    if (info.parity != Parity::None && leads_with_minus(x)) {
      const Expr flipped = negated(x);
      const Expr value = function(kind, {&flipped, 1});
      return info.parity == Parity::Odd ? -value : value;
    }
  }
  if ((kind == Kind::Min || kind == Kind::Max) && arguments[0].is_number() && arguments[1].is_number())
    return (arguments[0].number() < arguments[1].number()) == (kind == Kind::Min) ? arguments[0] : arguments[1];
  return Expr(this, storage_->intern(kind, ids_of(arguments)));
}

Expr Context::make(Kind kind, std::span<const Expr> arguments) {
  if (kind == Kind::Sum) return sum(arguments);
  if (kind == Kind::Product) return product(arguments);
  if (kind == Kind::Power) return power(arguments[0], arguments[1]);
  if (kind == Kind::TimeDerivative) return time_derivative(arguments[0]);
  return function(kind, arguments);
}

namespace {

Expr symbol_derivative(const Expr& symbol) {
  Context& context = symbol.context();
  switch (symbol.role()) {
    case Role::Coordinate:
    case Role::Input:
      return context.symbol(symbol.name(), symbol.role(), symbol.order() + 1);
    case Role::Time:
      return context.number(1);
    case Role::Parameter:
    case Role::Constant:
    case Role::Multiplier:
    case Role::Auxiliary:
      break;
  }
  return context.number(0);
}

}  // namespace

Expr Context::time_derivative(Expr e) {
  if (!depends_on_time(e.id())) return number(0);
  if (e.is_symbol()) return symbol_derivative(e);
  if (e.is(Kind::Product)) {
    std::vector<Expr> constant, varying;
    for (const NodeId id : e.argument_ids()) (depends_on_time(id) ? varying : constant).emplace_back(this, id);
    if (!constant.empty()) {
      constant.push_back(time_derivative(product(varying)));
      return product(constant);
    }
  }
  const std::array arguments{e.id()};
  return Expr(this, storage_->intern(Kind::TimeDerivative, arguments));
}

ScaledTerm split_coefficient(Expr term) {
  Context& context = term.context();
  if (term.is_number()) return {term.number(), context.number(1)};
  if (!term.is(Kind::Product) || !term[0].is_number()) return {1, term};
  const auto ids = term.argument_ids();
  if (ids.size() == 2) return {term[0].number(), term[1]};
  // What is left is in canonical order already.
  const NodeId rest = context.storage_->intern(Kind::Product, ids.subspan(1));
  return {term[0].number(), Expr(&context, rest)};
}

PowerOf split_power(Expr factor) {
  if (factor.is(Kind::Power))
    if (const Rational* e = factor[1].number_or_null()) return {factor[0], *e};
  return {factor, 1};
}

// --------------------------------------------------------------------------------------------------- operators

namespace {
Expr pair_sum(Expr a, Expr b) {
  const std::array terms{a, b};
  return a.context().sum(terms);
}
Expr pair_product(Expr a, Expr b) {
  const std::array factors{a, b};
  return a.context().product(factors);
}
}  // namespace

Expr operator+(Expr a, Expr b) { return pair_sum(a, b); }
Expr operator*(Expr a, Expr b) { return pair_product(a, b); }
Expr operator-(Expr a) { return pair_product(a.context().number(-1), a); }
Expr operator-(Expr a, Expr b) { return pair_sum(a, -b); }
Expr operator/(Expr a, Expr b) { return pair_product(a, pow(b, Rational(-1))); }
Expr operator+(Expr a, const Rational& b) { return a + a.context().number(b); }
Expr operator-(Expr a, const Rational& b) { return a + a.context().number(-b); }
Expr operator*(Expr a, const Rational& b) { return a * a.context().number(b); }
Expr operator*(const Rational& a, Expr b) { return b.context().number(a) * b; }
Expr operator/(Expr a, const Rational& b) { return a / a.context().number(b); }
Expr operator/(const Rational& a, Expr b) { return b.context().number(a) / b; }
Expr pow(Expr base, const Rational& exponent) { return base.context().power(base, base.context().number(exponent)); }
Expr sqrt(Expr e) { return pow(e, Rational(1, 2)); }
Expr apply(Kind function, Expr argument) { return argument.context().function(function, {&argument, 1}); }
Expr sin(Expr e) { return apply(Kind::Sin, e); }
Expr cos(Expr e) { return apply(Kind::Cos, e); }
Expr sum_of(std::span<const Expr> terms, Context& context) { return context.sum(terms); }
Expr sum_of(std::initializer_list<Expr> terms) { return terms.begin()->context().sum({terms.begin(), terms.size()}); }
Expr product_of(std::initializer_list<Expr> factors) {
  return factors.begin()->context().product({factors.begin(), factors.size()});
}

}  // namespace maupertuis
