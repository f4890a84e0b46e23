#include "system/lint.hpp"

#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

/// An energy that is nowhere a real number: its derivatives can be written down and certified, and no motion has them.
namespace maupertuis::lint_rules {
namespace {

constexpr int near_start = 9, tried = near_start + 8 * 8;  // eight sizes, by eight factors

/// One, and the parameters of this dimension.
std::vector<double> sizes_of(const Subject& s, const Dimension& dimension) {
  std::vector<double> sizes{1};
  for (const Parameter& p : s.system.parameters)
    if (p.dimension.same_as(dimension) && p.si_value != 0) sizes.push_back(p.si_value);
  return sizes;
}

/// Near the start, with its velocities; then on both sides of zero at the sizes of the parameters, since a root like
/// sqrt(R^2 - x^2) is real where x is of the size of R.
Bindings state(const Subject& s, int attempt) {
  Bindings point = sample(s, attempt);
  if (attempt < near_start) {
    for (const StartValue& v : s.model.experiment.start)
      if (v.order == 1) point[s.velocities[v.coordinate]] += evaluate(v.value, point);
    return point;
  }
  const auto turn = static_cast<std::size_t>(attempt - near_start);
  constexpr std::array factors{0.5, 1.5, 3.0, 30.0};
  for (std::size_t i = 0; i < s.freedoms(); ++i) {  // signs and factors differ between coordinates
    const double factor = (turn >> i % 6 & 1 ? -1 : 1) * factors[(turn / 2 + i) % factors.size()];
    const auto at_size_of = [&](const Dimension& dimension) {
      const std::vector<double> sizes = sizes_of(s, dimension);
      return factor * sizes[turn / 8 % sizes.size()];
    };
    const Coordinate& c = s.system.coordinates[i];
    point[c.q] = at_size_of(c.dimension);
    point[s.velocities[i]] = at_size_of(c.dimension / s.system.independent_dimension);
  }
  return point;
}

/// Those of the formulas that are a number at none of the states; most are at the first one.
std::vector<std::size_t> nowhere_numbers(const Subject& s, const ExprVector& formulas) {
  std::vector<std::size_t> left(formulas.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (int attempt = 0; attempt < tried && !left.empty(); ++attempt) {
    ExprVector asked;
    for (const std::size_t k : left) asked.push_back(formulas[k]);
    const std::vector<double> values = evaluate(asked, state(s, attempt));
    std::vector<std::size_t> still;
    for (std::size_t k = 0; k < left.size(); ++k)
      if (std::isnan(values[k])) still.push_back(left[k]);
    left = std::move(still);
  }
  return left;
}

/// The parts of L, where L has no value; the parts of D that are written down without derivatives by time, whose
/// expansion here would change the order in which terms are made.
std::vector<const EnergyTerm*> questionable_terms(const Subject& s) {
  std::vector<const EnergyTerm*> terms;
  for (const EnergyTerm& term : s.system.dissipation)
    if (!s.system.context->has_time_derivative(term.value.id())) terms.push_back(&term);
  if (nowhere_numbers(s, {s.lagrangian}).empty()) return terms;
  if (s.system.lagrangian_given) terms.push_back(&*s.system.lagrangian_given);
  for (const auto* list :
       {&s.system.kinetic, &s.system.potential, &s.system.generalized_potential, &s.system.lagrangian_extra})
    for (const EnergyTerm& term : *list) terms.push_back(&term);
  return terms;
}

}  // namespace

void values(Subject& s) {
  const std::vector<const EnergyTerm*> terms = questionable_terms(s);
  ExprVector formulas;
  for (const EnergyTerm* term : terms) formulas.push_back(expand_time_derivatives(term->value));
  for (const std::size_t k : nowhere_numbers(s, formulas))
    s.diagnostics.warning(
        "W0434", terms[k]->span, fmt::format("{} is no real number wherever it was looked at", terms[k]->origin),
        fmt::format(
            "At none of {} states, near the start and at the sizes of the parameters, has it a value: a root or "
            "a logarithm of something negative stands in it.",
            tried),
        "Look at the signs below the root. Where it is real elsewhere, give a start there.");
}

}  // namespace maupertuis::lint_rules
