#include "symbolic/transform/candidates.hpp"

#include "symbolic/transform/denominators.hpp"
#include "symbolic/transform/factor.hpp"

#include <algorithm>

namespace maupertuis::terms {

namespace {

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
  const Rational content = all_negative ? -readable_content(coefficients) : readable_content(coefficients);
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
      if (arguments.size() == 1 && atom.expr.is(Kind::Power)) continue;  // a root made on the way, shown already
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
    if (!part.is(Kind::Sum))
      terms.push_back(part);
    else
      for (std::size_t i = 0; i < part.size(); ++i) terms.push_back(part[i]);
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
  if (is_parametric(p)) {  // no angles, no coordinates: only the factoring is open
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

}  // namespace maupertuis::terms
