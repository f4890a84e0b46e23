#include "symbolic/print/reading_rank.hpp"

#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/kinds.hpp>

#include <algorithm>

namespace maupertuis {

std::shared_ptr<const ReadingPlaces> places_of(const ReadingOrder& order) {
  if (order.places && order.places->listed_parameters == order.parameters &&
      order.places->listed_coordinates == order.coordinates)
    return order.places;
  const auto out = std::make_shared<ReadingPlaces>(ReadingPlaces{order.parameters, order.coordinates, {}, {}});
  std::uint32_t next = 1;
  for (const Expr& p : order.parameters) out->parameters.emplace(p.id(), next++);
  next = 1;
  for (const Expr& q : order.coordinates) out->coordinates.emplace(q.name(), next++);
  return order.places = out;
}

}  // namespace maupertuis

namespace maupertuis::print {
namespace {

constexpr std::uint32_t unlisted = 1u << 20;

/// What an expression is made of, as far as its place in a line depends on it.
struct Contents {
  int highest_order = -1;  // of coordinates: −1 none, 0 positions, 1 velocities, 2 accelerations
  bool function_of_position = false;
  bool time = false, input = false, multiplier = false;
  Expr first_parameter;
};

bool acts_as_function(Kind kind) {
  const Family family = family_of(kind);
  return family != Family::Leaf && family != Family::Algebra && family != Family::TimeDerivative;
}

void look_into(Expr e, bool inside_function, Contents& contents) {
  if (e.is_symbol()) {
    switch (e.role()) {
      case Role::Coordinate:
        contents.highest_order = std::max(contents.highest_order, e.order());
        contents.function_of_position |= inside_function;
        break;
      case Role::Time:
        contents.time = true;
        break;
      case Role::Input:
        contents.input = true;
        break;
      case Role::Multiplier:
        contents.multiplier = true;
        break;
      case Role::Parameter:
      case Role::Constant:
      case Role::Auxiliary:
        break;
    }
    return;
  }
  const bool root = e.is(Kind::Power) && !(e[1].is_number() && e[1].number().is_integer());
  for (std::size_t i = 0; i < e.size(); ++i)
    look_into(e[i], inside_function || root || acts_as_function(e.kind()), contents);
}

Contents contents_of(Expr e) {
  Contents contents;
  look_into(e, false, contents);
  return contents;
}

std::vector<Expr> factors_of(Expr e) {
  if (!e.is(Kind::Product)) return {e};
  std::vector<Expr> factors;
  for (std::size_t i = 0; i < e.size(); ++i) factors.push_back(e[i]);
  return factors;
}

/// A velocity, or a momentum in its place.
bool is_rate(Expr e) { return e.is_symbol() && e.role() == Role::Coordinate && e.order() == 1; }

bool is_momentum(Expr e) {
  return e.is_symbol() && e.role() == Role::Coordinate && e.order() == 1 && is_integral(e.name());
}

/// Of the highest term: 2 for (p_x + m Ω y)².
std::uint32_t degree_in_momenta(Expr e) {
  if (is_momentum(e)) return 1;
  std::uint32_t degree = 0;
  if (e.is(Kind::Power)) {
    const auto times = e[1].is_number() ? e[1].number().as_integer() : std::nullopt;
    return times && *times > 0 ? static_cast<std::uint32_t>(*times) * degree_in_momenta(e[0]) : 0;
  }
  if (e.is(Kind::Sum))
    for (std::size_t i = 0; i < e.size(); ++i) degree = std::max(degree, degree_in_momenta(e[i]));
  if (e.is(Kind::Product))
    for (std::size_t i = 0; i < e.size(); ++i) degree += degree_in_momenta(e[i]);
  return degree;
}

bool is_denominator(Expr factor) {
  return factor.is(Kind::Power) && factor[1].is_number() && factor[1].number().sign() < 0;
}

/// Sines, roots and the like as factors, squares counted twice.
std::uint32_t count_of_functions(Expr term) {
  std::uint32_t count = 0;
  for (const Expr& f : factors_of(term)) {
    const PowerOf power = split_power(f);
    const auto times = power.exponent.as_integer();
    if (acts_as_function(power.base.kind())) count += times && *times == 2 ? 2 : 1;
  }
  return count;
}

enum FactorClass : std::uint32_t {
  Constants,
  ParameterSums,
  Circle,
  Parameters,
  ParameterFunctions,
  Times,
  Inputs,
  Positions,
  Momenta,
  Functions,
  Velocities,
  Accelerations,
  Multipliers
};

}  // namespace

ReadingRanks::ReadingRanks(const ReadingOrder& order) : places_(places_of(order)) {
  if (order.own) own_ = order.own.name();
}

std::uint32_t ReadingRanks::declared_rank(Expr symbol) const {
  const auto place = places_->coordinates.find(symbol.name());
  return place != places_->coordinates.end() ? place->second : unlisted + symbol.id();
}

/// The row's own coordinate stands before the others among accelerations and velocities, but not in sin(θ1 − θ2).
std::uint32_t ReadingRanks::rate_rank(Expr symbol, bool own_first) const {
  return own_first && symbol.name() == own_ ? 0 : declared_rank(symbol);
}

std::uint32_t ReadingRanks::symbol_rank(Expr symbol) const {
  if (symbol.role() == Role::Coordinate) return declared_rank(symbol);
  const auto place = places_->parameters.find(symbol.id());
  return place != places_->parameters.end() ? place->second : unlisted + symbol.id();
}

Rank ReadingRanks::factor(Expr factor) const {
  const Expr base = split_power(factor).base;
  if (base.is(Kind::Pi)) return {Circle};
  if (base.is_symbol()) {
    const std::uint32_t rank = symbol_rank(base);
    switch (base.role()) {
      case Role::Constant:
        return {Constants, rank};
      case Role::Time:
        return {Times, rank};
      case Role::Input:
        return {Inputs, rank, static_cast<std::uint32_t>(base.order())};
      case Role::Coordinate:
        if (base.order() == 1 && is_integral(base.name())) return {Momenta, rank};  // p_ψ cos θ
        return {base.order() == 0 ? Positions : base.order() == 1 ? Velocities : Accelerations, rank};
      case Role::Multiplier:
        return {Multipliers, rank};
      case Role::Parameter:
      case Role::Auxiliary:
        break;
    }
    return {Parameters, rank};
  }
  const Contents contents = contents_of(base);
  const bool sum = base.is(Kind::Sum) && split_power(factor).exponent.is_integer();
  std::uint32_t place = Functions;
  if (contents.highest_order == 2)
    place = Accelerations;
  else if (contents.highest_order == 1 && sum)
    place = Velocities;
  else if (contents.highest_order < 0 && !contents.time && !contents.input)
    place = sum ? ParameterSums : ParameterFunctions;
  else if (sum && !contents.function_of_position && !contents.input)
    place = Positions;
  Rank rank{place, sum ? 1u : 0u};
  // Functions of one coordinate follow the order of coordinates, sines before cosines; then those of several.
  std::uint32_t first = unlisted, last = 0;
  for (const Expr& s : symbols_of({&base, 1}))
    if (s.role() == Role::Coordinate)
      first = std::min(first, declared_rank(s)), last = std::max(last, declared_rank(s));
  if (place == Functions) rank.push_back(first != last ? 1 : 0);
  rank.insert(rank.end(), {first, last, static_cast<std::uint32_t>(base.kind()), base.id()});
  return rank;
}

Rank ReadingRanks::rank_of_rest(Expr term) const {
  const Contents contents = contents_of(term);
  std::uint32_t place = 1;
  if (term.is_number())
    place = 0;
  else if (contents.input || (contents.time && contents.highest_order < 0))
    place = 4;
  else if (contents.function_of_position)
    place = 3;
  else if (contents.highest_order >= 0)
    place = 2;
  Rank rank{place};
  if (place == 3) rank.push_back(~count_of_functions(term));  // sin θ cos θ before sin θ: inertia before gravity
  std::vector<Rank> factors;
  for (const Expr& f : factors_of(term))
    if (!f.is_number() && !is_denominator(f)) factors.push_back(factor(f));
  // A sum (m1 + m2) is filed under its first name.
  std::size_t i = 0;
  for (const Expr& f : factors_of(term)) {
    if (f.is_number() || is_denominator(f)) continue;
    Rank& key = factors[i++];
    if (f.is(Kind::Sum) && key[0] == ParameterSums) {
      std::uint32_t first = ~0u;
      for (const Expr& s : symbols_of({&f, 1})) first = std::min(first, symbol_rank(s));
      key = {Parameters, first};
    } else if (const PowerOf power = split_power(f); power.base.is_symbol()) {
      key.push_back(power.exponent.sign() > 0 ? 0 : 1);
    }
  }
  std::sort(factors.begin(), factors.end());
  for (const Rank& f : factors) rank.insert(rank.end(), f.begin(), f.end());
  rank.push_back(term.id());
  return rank;
}

Rank ReadingRanks::term(Expr term, bool own_first) const {
  const Contents contents = contents_of(term);
  Rank rank;
  const std::uint32_t degree = degree_in_momenta(term);
  if (contents.multiplier) {
    rank = {3};  // forces of constraints after the others
    for (const Expr& s : symbols_of({&term, 1}))
      if (s.role() == Role::Multiplier) rank.push_back(symbol_rank(s));
  } else if (contents.highest_order >= 2) {
    rank = {0, static_cast<std::uint32_t>(4 - std::min(contents.highest_order, 4))};  // q'''' first
    std::uint32_t first = ~0u;
    for (const Expr& s : symbols_of({&term, 1}))
      if (s.role() == Role::Coordinate && s.order() >= 2) first = std::min(first, rate_rank(s, own_first));
    rank.push_back(first);
  } else if (degree > 0 &&
             contents.highest_order == 1) {  // a Hamiltonian: kinetic energy first, whatever it is grouped by
    std::uint32_t first = ~0u;
    for (const Expr& s : symbols_of({&term, 1}))
      if (is_momentum(s)) first = std::min(first, declared_rank(s));
    rank = {1, degree == 2 ? 0u : 4 - std::min(degree, 2u), first};
  } else if (contents.highest_order == 1) {
    std::vector<std::uint32_t> linear, repeated;
    for (const Expr& f : factors_of(term)) {
      const PowerOf power = split_power(f);
      if (!is_rate(power.base)) continue;
      (power.exponent.is_one() ? linear : repeated).push_back(rate_rank(power.base, own_first));
    }
    std::sort(linear.begin(), linear.end());
    const bool square = !repeated.empty() && linear.empty();
    const std::uint32_t kind = square ? 0 : linear.size() + repeated.size() >= 2 ? 1 : linear.size() == 1 ? 2 : 3;
    rank = {1, kind};
    for (const std::uint32_t r : repeated) rank.push_back(r);
    for (const std::uint32_t r : linear) rank.push_back(r);
  } else {
    rank = {2};
  }
  const Rank rest = rank_of_rest(term);
  rank.insert(rank.end(), rest.begin(), rest.end());
  return rank;
}

Rank ReadingRanks::angle_term(Expr term) const {
  std::uint32_t first = ~0u;
  for (const Expr& s : symbols_of({&term, 1}))
    if (s.role() == Role::Coordinate) first = std::min(first, declared_rank(s));
  Rank rank{first, contents_of(term).time ? 0u : 1u};
  const Rank rest = rank_of_rest(term);
  rank.insert(rank.end(), rest.begin(), rest.end());
  return rank;
}

}  // namespace maupertuis::print
