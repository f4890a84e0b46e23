#include <maupertuis/shared_form.hpp>
#include <maupertuis/tree_size.hpp>

#include "symbolic/transform/candidates.hpp"
#include "symbolic/transform/denominators.hpp"
#include "symbolic/transform/intermediates.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace maupertuis {
namespace {

using terms::CandidateChooser;
using terms::MonomialId;
using terms::Polynomial;

/// Terms by accelerations, then by velocities; every coefficient in its best form.
Expr collected_by_rates(CandidateChooser& chooser, const Polynomial& p) {
  terms::TermAlgebra& algebra = chooser.algebra();
  std::map<MonomialId, Polynomial> groups;
  for (const terms::Term& t : p) {
    terms::Monomial rates = algebra.monomial(t.monomial);
    std::erase_if(rates, [&](const terms::Factor& f) { return !chooser.is_rate(f.atom); });
    const auto accelerates = [&](const terms::Factor& f) { return algebra.info(f.atom).expr.order() >= 2; };
    if (std::any_of(rates.begin(), rates.end(), accelerates)) std::erase_if(rates, std::not_fn(accelerates));
    const MonomialId rate = algebra.intern(rates);
    groups[rate].push_back({algebra.quotient(t.monomial, rate), t.harmonic, t.coefficient});
  }
  std::vector<Expr> parts;
  for (auto& [rate, raw] : groups) {
    // Forces stand as terms of their own; a coefficient of a velocity is one factor.
    const Polynomial terms = algebra.normalized(std::move(raw));
    const Expr coefficient = rate == 0 ? chooser.best_terms(terms) : chooser.best(terms);
    const Expr factor = algebra.expression(rate, true);
    parts.push_back(coefficient * factor);
  }
  return chooser.flat_sum(parts);
}

/// A line of more terms than this is not read by anybody, however well they are arranged.
std::size_t longest_row(const ReadableOptions& options) { return options.term_budget / 8; }

/// Beyond this number of terms an expression is arranged by its rates, as an equation is: trying every common factor
/// of every group of terms costs the cube of their number.
constexpr std::size_t longest_search = 24;

Expr readable_row(CandidateChooser& chooser, const Polynomial& p) {
  const Expr plain = collected_by_rates(chooser, p);
  const Polynomial combined = terms::over_common_denominators(chooser.algebra(), p);
  const Expr other = collected_by_rates(chooser, combined);
  return chooser.cost()(other) < chooser.cost()(plain) ? other : plain;
}

/// Frames in frames in frames: a tree of so many nodes has too many terms however it is multiplied out, and to see that
/// takes long.
bool is_hopeless(Expr e) {
  constexpr std::size_t most = 300'000;
  return tree_size(e, most) == most;
}

/// Of so many rows the first one alone lists the intermediates, and none is collected by its accelerations.
constexpr std::size_t most_rows_listed_whole = 100;

std::vector<ReadableForm> by_shared_parts(std::span<const Expr> expanded, const ReadingOrder& order) {
  SharedForm shared = shared_form(expanded, order);
  std::vector<ReadableForm> rows;
  for (const Expr& row : shared.rows) rows.push_back({row, {}, {}});
  rows.front().intermediates = std::move(shared.intermediates);
  return rows;
}

}  // namespace

ReadableForm readable(Expr e, const ReadingOrder& order, const ReadableOptions& options) {
  const Expr expanded = expand_time_derivatives(e);
  if (is_hopeless(expanded)) return terms::with_intermediates({&expanded, 1}, order).front();
  try {
    CandidateChooser chooser(e.context(), order, options.term_budget);
    const Polynomial p = chooser.read(expanded);
    if (p.size() > longest_row(options)) throw terms::TooManyTerms{};
    return {p.size() > longest_search ? readable_row(chooser, p) : chooser.best(p), {}, {}};
  } catch (const terms::TooManyTerms&) {
    return terms::with_intermediates({&expanded, 1}, order).front();
  }
}

std::vector<ReadableForm> readable_equations(std::span<const Expr> residuals, const ReadingOrder& order,
                                             const ReadableOptions& options) {
  if (residuals.empty()) return {};
  const std::vector<Expr> expanded = expand_time_derivatives(residuals);
  const bool rows_are_coordinates = residuals.size() == order.coordinates.size();
  std::vector<ReadableForm> rows;
  try {
    CandidateChooser chooser(residuals.front().context(), order, options.term_budget);
    std::vector<Polynomial> polynomials;
    if (std::any_of(expanded.begin(), expanded.end(), is_hopeless)) throw terms::TooManyTerms{};
    for (const Expr& e : expanded) {
      polynomials.push_back(chooser.read(e));
      if (polynomials.back().size() > longest_row(options)) throw terms::TooManyTerms{};
    }
    for (std::size_t i = 0; i < expanded.size(); ++i) {
      const Expr own = rows_are_coordinates ? order.coordinates[i] : Expr();
      chooser.set_own(own);
      rows.push_back({readable_row(chooser, polynomials[i]), {}, own});
    }
  } catch (const terms::TooManyTerms&) {
    rows = expanded.size() > most_rows_listed_whole ? by_shared_parts(expanded, order)
                                                    : terms::with_intermediates(expanded, order);
    for (std::size_t i = 0; rows_are_coordinates && i < rows.size(); ++i) rows[i].own = order.coordinates[i];
  }
  return rows;
}

}  // namespace maupertuis
