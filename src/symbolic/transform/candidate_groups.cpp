#include "symbolic/transform/candidates.hpp"

#include <algorithm>
#include <map>

/// Candidates that differ in how terms are grouped.
namespace maupertuis::terms {

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
  std::erase_if(names,
                [&](const Factor& f) { return f.exponent.num > 0 || algebra_.info(f.atom).kind != AtomKind::Symbol; });
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

}  // namespace maupertuis::terms
