#include "system/lint.hpp"

#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// An energy that is nowhere a real number: its derivatives can be written down and certified, and no motion has them.
namespace maupertuis::lint_rules {
namespace {

constexpr int tried = 24;

/// Near the start, then farther and farther from it, on both sides.
Bindings state(const Subject& s, int attempt) {
  Bindings point = sample(s, attempt);
  if (attempt < 9) return point;
  const double factor = (attempt % 2 == 0 ? 1 : -1) * std::pow(10, attempt % 5 - 1);
  for (const Coordinate& c : s.system.coordinates) point[c.q] *= factor;
  return point;
}

bool is_a_number_somewhere(const Subject& s, Expr e) {
  for (int attempt = 0; attempt < tried; ++attempt)
    if (!std::isnan(evaluate(e, state(s, attempt)))) return true;
  return false;
}

}  // namespace

void values(Subject& s) {
  if (is_a_number_somewhere(s, s.lagrangian)) return;  // nearly always at the first state
  std::vector<const EnergyTerm*> terms;
  if (s.system.lagrangian_given) terms.push_back(&*s.system.lagrangian_given);
  for (const auto* list : {&s.system.kinetic, &s.system.potential})
    for (const EnergyTerm& term : *list) terms.push_back(&term);
  for (const EnergyTerm* term : terms) {
    const Expr value = expand_time_derivatives(term->value);
    if (is_a_number_somewhere(s, value)) continue;
    s.diagnostics.warning(
        "W0434", term->span, fmt::format("{} is no real number wherever it was looked at", term->origin),
        fmt::format("At none of {} states, near the start and far from it, has it a value: a root or a logarithm of "
                    "something negative stands in it.",
                    tried),
        "Look at the signs below the root; the equations are right, but no motion has them.");
  }
}

}  // namespace maupertuis::lint_rules
