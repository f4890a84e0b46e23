#include "symbolic/transform/candidates.hpp"

#include "symbolic/transform/denominators.hpp"
#include "symbolic/transform/factor.hpp"
#include "symbolic/transform/power_form.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace maupertuis::terms {

namespace {

std::string key_text(const Polynomial& p) {
  std::string key;
  for (const Term& t : p) {
    key.append(reinterpret_cast<const char*>(&t.monomial), sizeof t.monomial);
    key.append(reinterpret_cast<const char*>(&t.harmonic), sizeof t.harmonic);
    key += t.coefficient.to_string() + ';';
  }
  return key;
}

bool same(const Polynomial& a, const Polynomial& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Term& x, const Term& y) {
    return x.monomial == y.monomial && x.harmonic == y.harmonic && x.coefficient == y.coefficient;
  });
}

}  // namespace

CandidateChooser::CandidateChooser(Context& context, const ReadingOrder& order, std::size_t term_budget)
    : algebra_(context, term_budget), reader_(algebra_, Trigonometry::ToSums) {
  for (const Expr& q : order.coordinates) ranks_.emplace(q.id(), ranks_.size());
  for (const Expr& p : order.parameters) ranks_.emplace(p.id(), ranks_.size());
  algebra_.show_exponents([this](const Polynomial& p) { return p.size() < 2 ? flat(p) : factored(p); });
}

Polynomial CandidateChooser::read(Expr e) {
  const Polynomial p = reader_.read(e);
  prepare_atoms();
  return p;
}

/// 2 (a + b) for 2 a + 2 b, −(a + b) for −a − b: below a fraction bar the number can cancel.
Expr CandidateChooser::content_outside(Expr e) {
  if (!e.is(Kind::Sum)) return e;
  Polynomial coefficients;
  bool all_negative = true;
  for (std::size_t i = 0; i < e.size(); ++i) {
    coefficients.push_back({0, 0, split_coefficient(e[i]).coefficient});
    all_negative &= coefficients.back().coefficient.sign() < 0;
  }
  const Rational content = all_negative ? -rational_content(coefficients) : rational_content(coefficients);
  if (content.is_one()) return e;
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < e.size(); ++i) terms.push_back(e[i] / content);
  return content * algebra_.context().sum(terms);
}

/// Arguments of functions and radicands are made readable too. Inner atoms have smaller numbers than outer ones.
void CandidateChooser::prepare_atoms() {
  for (; prepared_ < algebra_.atom_count(); ++prepared_) {
    const Atom atom = algebra_.info(static_cast<AtomId>(prepared_));
    if (atom.kind == AtomKind::Base) {
      algebra_.show(static_cast<AtomId>(prepared_), content_outside(best(atom.arguments.front())));
    } else if (atom.kind == AtomKind::Function && atom.shown == atom.expr) {
      std::vector<Expr> arguments;
      for (const Polynomial& argument : atom.arguments) arguments.push_back(best(argument));
      Context& context = algebra_.context();
      if (arguments.size() == 1 && atom.expr.is(Kind::Power)) continue;   // a root made on the way, shown already
      const Expr shown = atom.expr.is(Kind::Power) ? context.power(arguments[0], arguments[1])
                                                   : context.function(atom.expr.kind(), arguments);
      algebra_.show(static_cast<AtomId>(prepared_), shown);
    }
  }
}

/// A sum of parts of which some may be sums themselves; their terms join.
Expr CandidateChooser::flat_sum(const std::vector<Expr>& parts) {
  std::vector<Expr> terms;
  for (const Expr& part : parts) {
    if (!part.is(Kind::Sum)) terms.push_back(part);
    else for (std::size_t i = 0; i < part.size(); ++i) terms.push_back(part[i]);
  }
  return algebra_.context().sum(terms);
}

void CandidateChooser::consider(Choice& best, Expr candidate) {
  const double cost = cost_(candidate);
  if (!best.value || cost < best.cost - 1e-9) best = {candidate, cost};
}

Expr CandidateChooser::best(const Polynomial& p) {
  if (p.empty()) return algebra_.context().number(0);
  if (p.size() == 1) return best_basis(p);
  const std::string key = key_text(p) + (own_ ? own_.name() : "");
  if (const auto known = known_best_.find(key); known != known_best_.end()) return known->second;
  const Expr value = search_best(p);
  known_best_.emplace(key, value);
  return value;
}

Expr CandidateChooser::search_best(const Polynomial& p) {
  // One fraction for all where every term stands over the same sum.
  if (const MonomialId bar = common_denominator(p); bar != 0) {
    const Polynomial numerator = algebra_.times_monomial(p, algebra_.power(bar, {-1, 1}));
    const Expr below = algebra_.expression(bar, true);
    Choice choice;
    consider(choice, content_outside(best(numerator)) * below);
    consider(choice, best_basis(numerator) * below);
    consider(choice, factored(numerator) * below);
    return choice.value;
  }
  // T2 + T1 + T0 − V: what is of different degree in the velocities is read separately.
  if (auto parts = by_rate_degree(p); parts.size() > 1 && !has_rates_inside_functions(p)) {
    std::vector<Expr> sums;
    for (const auto& [degree, part] : parts) sums.push_back(degree == Fraction{0, 1} ? best_terms(part) : best(part));
    return flat_sum(sums);
  }
  Choice choice;
  const auto offer_all = [&](const Polynomial& form) {
    consider(choice, by_functions(form));
    consider(choice, by_parameters(form));
    consider(choice, best_basis(form));
    if (std::any_of(form.begin(), form.end(), [&](const Term& t) { return select(t.monomial, Part::Rate) != 0; }))
      consider(choice, by_velocities(form));
    if (const Expr collected = by_one_parameter(form, false)) consider(choice, collected);
  };
  if (is_parametric(p)) {   // no angles, no coordinates: only the factoring is open
    consider(choice, by_functions(p));
    if (const Expr collected = by_one_parameter(p, false)) consider(choice, collected);
    return choice.value;
  }
  offer_all(p);
  if (const Polynomial combined = over_common_denominators(algebra_, p); !same(p, combined)) offer_all(combined);
  if (const Polynomial rooted = with_roots(p); !rooted.empty()) offer_all(rooted);
  return choice.value;
}

Expr CandidateChooser::best_terms(const Polynomial& p) {
  if (p.size() < 2) return best(p);
  Choice choice;
  const auto offer_all = [&](const Polynomial& form) {
    consider(choice, by_functions(form));
    consider(choice, by_parameters(form));
    if (const Expr collected = by_one_parameter(form, true)) consider(choice, collected);
  };
  offer_all(p);
  if (const Polynomial rooted = with_roots(p); !rooted.empty()) offer_all(rooted);
  return choice.value;
}

// ------------------------------------------------------------------------------------------------------- grouping

/// One harmonic at most, which all terms share, times parameters that are names.
bool CandidateChooser::is_parametric(const Polynomial& p) const {
  return std::all_of(p.begin(), p.end(), [&](const Term& t) {
    const Monomial& m = algebra_.monomial(t.monomial);
    return t.harmonic == p.front().harmonic && std::all_of(m.begin(), m.end(), [&](const Factor& f) {
      return part_of(f.atom) == Part::Parameter && algebra_.info(f.atom).kind == AtomKind::Symbol;
    });
  });
}

bool CandidateChooser::is_rate(AtomId atom) const { return part_of(atom) == Part::Rate; }

CandidateChooser::Part CandidateChooser::part_of(AtomId atom) const {
  const Atom& info = algebra_.info(atom);
  if (info.kind == AtomKind::Symbol && info.expr.is_symbol()) {
    const Role role = info.expr.role();
    if (role == Role::Coordinate) return info.expr.order() > 0 ? Part::Rate : Part::Other;
    if (role == Role::Parameter || role == Role::Constant || role == Role::Auxiliary) return Part::Parameter;
    return Part::Other;
  }
  return info.kind != AtomKind::Harmonic && !algebra_.context().depends_on_time(info.expr.id()) ? Part::Parameter
                                                                                                : Part::Other;
}

MonomialId CandidateChooser::select(MonomialId monomial, Part part) {
  Monomial selected = algebra_.monomial(monomial);
  std::erase_if(selected, [&](const Factor& f) { return part_of(f.atom) != part; });
  return algebra_.intern(selected);
}

/// Splits every term into an outer monomial, key_of(term), and the rest; outer monomials with proportional rests share
/// one summand: factored(Σ outer monomials) · best_basis(rest).
template <class KeyOf>
Expr CandidateChooser::grouped(const Polynomial& p, KeyOf key_of) {
  std::map<MonomialId, Polynomial> rests;
  for (const Term& t : p) {
    const MonomialId outer = key_of(t);
    rests[outer].push_back({algebra_.quotient(t.monomial, outer), t.harmonic, t.coefficient});
  }
  struct Group {
    Polynomial rest;
    std::vector<Term> outers;
  };
  std::vector<Group> groups;
  std::unordered_map<std::string, std::size_t> places;
  for (auto& [outer, raw] : rests) {
    Polynomial rest = algebra_.normalized(std::move(raw));
    Rational scale = rational_content(rest);
    if (rest.front().coefficient.sign() < 0) scale = -scale;
    rest = algebra_.scale(rest, Rational(1) / scale);
    const auto [place, fresh] = places.try_emplace(key_text(rest), groups.size());
    if (fresh) groups.push_back({std::move(rest), {}});
    groups[place->second].outers.push_back({outer, 0, std::move(scale)});
  }
  std::vector<Expr> terms;
  for (Group& group : groups) {
    const Polynomial outer = algebra_.normalized(std::move(group.outers));
    terms.push_back((outer.size() == 1 ? flat(outer) : factored(outer)) * best_basis(group.rest));
  }
  return flat_sum(terms);
}

Expr CandidateChooser::by_parameters(const Polynomial& p) {
  return grouped(p, [&](const Term& t) { return select(t.monomial, Part::Parameter); });
}

Expr CandidateChooser::by_functions(const Polynomial& p) {
  return grouped(p, [&](const Term& t) {
    Monomial outer = algebra_.monomial(t.monomial);
    std::erase_if(outer, [&](const Factor& f) { return algebra_.info(f.atom).kind == AtomKind::Harmonic; });
    return algebra_.intern(outer);
  });
}

Expr CandidateChooser::by_one_parameter(const Polynomial& p, bool apart) {
  constexpr std::size_t longest = 24;
  if (p.size() < 3 || p.size() > longest) return {};
  std::map<AtomId, std::size_t> occurrences;
  for (const Term& t : p)
    for (const Factor& f : algebra_.monomial(t.monomial))
      if (part_of(f.atom) == Part::Parameter && f.exponent == Fraction{1, 1}) ++occurrences[f.atom];
  AtomId name = 0;
  std::size_t most = 1;
  for (const auto& [atom, times] : occurrences)
    if (times > most && times < p.size()) name = atom, most = times;
  if (most < 2) return {};
  Polynomial with, without;
  for (const Term& t : p) {
    const Monomial& m = algebra_.monomial(t.monomial);
    const bool has = std::find(m.begin(), m.end(), Factor{name, Fraction{1, 1}}) != m.end();
    (has ? with : without).push_back(t);
  }
  if (apart) {
    if (std::any_of(with.begin(), with.end(), [&](const Term& t) { return t.harmonic != with[0].harmonic; })) return {};
    return flat_sum({by_functions(with), best_terms(without)});
  }
  const Polynomial inside = algebra_.times_monomial(with, algebra_.intern({{name, Fraction{-1, 1}}}));
  Choice choice;
  consider(choice, by_functions(inside));
  consider(choice, by_parameters(inside));
  return flat_sum({choice.value * algebra_.info(name).expr, best(without)});
}

Polynomial CandidateChooser::with_roots(const Polynomial& p) {
  Polynomial result;
  std::vector<AtomId> bases;
  for (const Term& t : p)
    for (const Factor& f : algebra_.monomial(t.monomial))
      if (algebra_.info(f.atom).kind == AtomKind::Base && f.exponent == Fraction{1, 2} &&
          std::find(bases.begin(), bases.end(), f.atom) == bases.end())
        bases.push_back(f.atom);
  for (const AtomId base : bases) {
    const Expr root = sqrt(algebra_.info(base).expr), shown = sqrt(algebra_.info(base).shown);
    const AtomId atom = algebra_.atom(root, AtomKind::Function, algebra_.info(base).arguments);
    algebra_.show(atom, shown);
    const Polynomial found = with_square_of_root(algebra_, result.empty() ? p : result, base, atom);
    if (!found.empty()) result = found;
  }
  return result;
}

MonomialId CandidateChooser::common_denominator(const Polynomial& p) {
  if (p.size() < 2) return 0;
  const auto is_base = [&](const Factor& f) { return algebra_.info(f.atom).kind == AtomKind::Base; };
  Monomial sums = algebra_.monomial(common_monomial(algebra_, p));
  std::erase_if(sums, [&](const Factor& f) { return f.exponent.num > 0 || !is_base(f); });
  if (sums.empty()) return 0;
  // Single names go below the bar with them, also where only some terms have them there.
  Monomial names = algebra_.monomial(lowest_powers(algebra_, p));
  std::erase_if(names, [&](const Factor& f) { return f.exponent.num > 0 || algebra_.info(f.atom).kind != AtomKind::Symbol; });
  return algebra_.product(algebra_.intern(sums), algebra_.intern(names));
}

/// sqrt(1 − v²/c²) ties the degrees together.
bool CandidateChooser::has_rates_inside_functions(const Polynomial& p) const {
  for (const Term& t : p)
    for (const Factor& f : algebra_.monomial(t.monomial)) {
      const Expr e = algebra_.info(f.atom).expr;
      if (e.is_symbol()) continue;
      for (const Expr& s : symbols_of({&e, 1}))
        if (s.role() == Role::Coordinate && s.order() > 0) return true;
    }
  return false;
}

std::vector<std::pair<Fraction, Polynomial>> CandidateChooser::by_rate_degree(const Polynomial& p) const {
  std::vector<std::pair<Fraction, Polynomial>> parts;
  for (const Term& t : p) {
    Fraction degree{0, 1};
    for (const Factor& f : algebra_.monomial(t.monomial))
      if (is_rate(f.atom)) degree = degree + f.exponent;
    auto place = std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.first == degree; });
    if (place == parts.end()) place = parts.insert(parts.end(), {degree, {}});
    place->second.push_back(t);
  }
  return parts;
}

Expr CandidateChooser::by_velocities(const Polynomial& p) {
  std::map<MonomialId, Polynomial> coefficients;
  for (const Term& t : p) {
    const MonomialId rate = select(t.monomial, Part::Rate);
    coefficients[rate].push_back({algebra_.quotient(t.monomial, rate), t.harmonic, t.coefficient});
  }
  if (coefficients.size() < 2 && coefficients.begin()->first == 0) return flat(p);
  std::vector<Expr> terms;
  for (auto& [rate, raw] : coefficients)
    terms.push_back(best(algebra_.normalized(std::move(raw))) * algebra_.expression(rate, true));
  return flat_sum(terms);
}

// ---------------------------------------------------------------------------------------------------------- bases

Expr CandidateChooser::best_basis(const Polynomial& p) {
  const bool multiples = has_multiple_angle(algebra_, p, reader_.angle_units());
  if (p.size() == 1 && !multiples) return flat(p);
  const std::string key = key_text(p);
  if (const auto known = known_bases_.find(key); known != known_bases_.end()) return known->second;
  const Expr value = search_basis(p);
  known_bases_.emplace(key, value);
  return value;
}

/// From the Fourier form downhill: the angle and the choice of Pythagoras that help most, until none helps; and the
/// forms with every angle as powers, in case that the way there leads over a hill.
Expr CandidateChooser::search_basis(const Polynomial& p) {
  constexpr std::size_t largest_searched = 200;
  Choice choice;
  const auto offer = [&](const Polynomial& form) {
    consider(choice, without_content(form));
    if (form.size() > 1) consider(choice, factored(form));
  };
  offer(p);
  auto angles = candidate_angles(algebra_, p, reader_.angle_units());
  if (angles.empty() || p.size() > largest_searched) return choice.value;
  constexpr std::array ways{Eliminate::SineSquared, Eliminate::CosineSquared};
  for (const Eliminate way : ways) {
    Polynomial all = p;
    for (const auto& angle : angles)
      if (angle.size() == 1 && all.size() <= 4 * largest_searched) all = power_form(algebra_, all, angle, way);
    offer(all);
  }
  Polynomial current = p;
  double current_cost = cost_(flat(p));
  for (bool improved = true; improved;) {
    improved = false;
    Polynomial next;
    for (const auto& angle : angles)
      for (const Eliminate way : ways) {
        Polynomial form = power_form(algebra_, current, angle, way);
        const double cost = cost_(flat(form));
        if (form.size() > 1 || cost < current_cost) offer(form);
        if (cost < current_cost - 1e-9) {
          current_cost = cost;
          next = std::move(form);
          improved = true;
        }
      }
    if (improved) current = std::move(next);
  }
  return choice.value;
}

// ------------------------------------------------------------------------------------------------------ factoring

int CandidateChooser::reading_sign(const Polynomial& sum) const {
  constexpr std::size_t late = 1u << 20;
  std::size_t first = ~std::size_t{0};
  int sign = 1;
  for (const Term& t : sum) {
    std::size_t rank = 4 * late;
    bool is_function = t.harmonic != 0;
    if (t.monomial == 0 && t.harmonic == 0) rank = 2 * late;
    for (const Factor& f : algebra_.monomial(t.monomial)) {
      const Expr e = algebra_.info(f.atom).expr;
      if (e.is(Kind::Power) && f.exponent.num > 0) rank = std::min(rank, late);   // r - l for a root r
      else is_function |= !e.is_symbol() || f.exponent.num < 0;
      if (!e.is_symbol() || f.exponent.num < 0) continue;
      std::size_t symbol_rank = late + late / 2 + e.id() % (late / 2);
      if (e.role() == Role::Coordinate) {
        const Expr position = e.context().symbol(e.name(), Role::Coordinate);
        const auto place = ranks_.find(position.id());
        symbol_rank = place == ranks_.end() ? late : place->second + 1;
        if (own_ && position == own_) symbol_rank = 0;
        if (e.order() > 0) symbol_rank += late + late / 4;   // c^2 - v^2
      } else if (const auto place = ranks_.find(e.id()); place != ranks_.end()) {
        symbol_rank = late + place->second;
      }
      rank = std::min(rank, symbol_rank);
    }
    if (is_function) rank += 3 * late;   // 1 - l0/r, l - a cos θ: what is no function leads
    if (rank < first) {
      first = rank;
      sign = t.coefficient.sign();
    }
  }
  return sign;
}

/// Flat, but for the numeric factor: 2 (a + b), so that a coefficient that is multiplied on later meets it.
Expr CandidateChooser::without_content(const Polynomial& p) {
  if (p.size() < 2) return flat(p);
  const Rational content = rational_content(p);
  return algebra_.context().number(content) * flat(algebra_.scale(p, Rational(1) / content));
}

Expr CandidateChooser::factored(const Polynomial& p) {
  Factored parts = factored_parts(p);
  Choice choice;
  consider(choice, product_of(parts));
  // (d + x)/d for 1 + x/d: with the denominators in front.
  if (!parts.split && !parts.parts.empty()) {
    const MonomialId lowest = lowest_powers(algebra_, parts.parts.front().sum);
    if (lowest != 0) {
      parts.parts.front().sum = algebra_.times_monomial(parts.parts.front().sum, algebra_.power(lowest, {-1, 1}));
      parts.monomial = algebra_.product(parts.monomial, lowest);
      consider(choice, product_of(parts));
    }
  }
  return choice.value;
}

/// The same sums of masses stand in many places: what is left without number and monomial is factored once.
Factored CandidateChooser::factored_parts(const Polynomial& p) {
  const Rational content = rational_content(p);
  const MonomialId common = common_monomial(algebra_, p);
  const Polynomial rest = algebra_.scale(algebra_.times_monomial(p, algebra_.power(common, {-1, 1})), Rational(1) / content);
  const std::string key = key_text(rest);
  auto known = known_factors_.find(key);
  if (known == known_factors_.end()) known = known_factors_.emplace(key, factor(algebra_, rest)).first;
  Factored result = known->second;
  result.coefficient *= content;
  result.monomial = algebra_.product(result.monomial, common);
  return result;
}

Expr CandidateChooser::product_of(Factored parts) {
  std::vector<Expr> factors{algebra_.expression(parts.monomial, true)};
  for (Factored::Part& part : parts.parts) {
    const int sign = reading_sign(part.sum);
    if (sign < 0) {
      part.sum = algebra_.scale(part.sum, -1);
      if (part.multiplicity % 2 != 0) parts.coefficient = -parts.coefficient;
    }
    factors.push_back(pow(flat(part.sum), Rational(part.multiplicity)));
  }
  factors.push_back(algebra_.context().number(parts.coefficient));
  return algebra_.context().product(factors);
}

}  // namespace maupertuis::terms
