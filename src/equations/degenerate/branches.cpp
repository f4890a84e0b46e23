#include "equations/degenerate/branches.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

bool holds(Expr e, Expr symbol) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

/// s − relation/c for a state s that stands in it as c s with a number c; nothing where none does.
std::optional<std::pair<Expr, Expr>> solved_for_a_state(Expr relation, const ExprVector& states) {
  for (const Expr& s : states) {
    const Expr slope = differentiate(relation, s);
    if (!slope.is_number() || slope.is_zero()) continue;
    const Expr value = substitute(relation, ExprMap{{s, s.context().number(0)}}) / -slope;
    if (!holds(value, s)) return std::pair(s, value);
  }
  return std::nullopt;
}

}  // namespace

Expr with_known_states(Expr value, ExprVector relations, const ExprVector& states) {
  for (std::size_t k = 0; k < relations.size(); ++k) {
    const auto solved = solved_for_a_state(relations[k], states);
    if (!solved) continue;
    const ExprMap put{{solved->first, solved->second}};
    for (std::size_t later = k + 1; later < relations.size(); ++later)
      relations[later] = substitute(relations[later], put);
    value = substitute(value, put);
  }
  return value;
}

ExprVector vanishing_factors(Expr value, const ExprVector& states) {
  if (!value.is(Kind::Product)) return {value};
  ExprVector out;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool has_state = std::any_of(states.begin(), states.end(), [&](Expr s) { return holds(value[i], s); });
    if (has_state) out.push_back(value[i]);
  }
  return out;
}

bool is_zero_at(Expr value, const ExprVector& states, const Bindings& point) {
  constexpr double rounding = 1e-9;
  const double here = evaluate(value, point);
  double change = 0;
  const std::vector<double> slopes = evaluate(gradient(value, states), point);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double size = std::abs(point.at(states[i]));
    change += std::abs(slopes[i]) * (size > 0 ? size : 1);
  }
  return here == 0 || std::abs(here) <= rounding * change;
}

}  // namespace maupertuis
