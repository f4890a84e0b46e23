#include "studio/stroboscopic.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>

namespace maupertuis::studio {
namespace {

/// What the equations are made of, as far as it changes with time alone.
std::vector<Expr> driven_formulas(const EquationsOfMotion& equations) {
  std::vector<Expr> formulas{equations.lagrangian_expanded};
  for (const auto* list : {&equations.generalized_forces, &equations.dissipative_terms})
    formulas.insert(formulas.end(), list->begin(), list->end());
  formulas = expand_time_derivatives(in_terms_of_motion(*equations.system, formulas));
  const Expr t = equations.system->context->time();
  formulas.erase(std::remove_if(formulas.begin(), formulas.end(),
                                [&](Expr e) { return vanishes_identically(differentiate(e, t)); }),
                 formulas.end());
  return formulas;
}

bool is_constant(Expr rate) {
  const std::vector<Expr> symbols = symbols_of({&rate, 1});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](Expr s) { return s.role() == Role::Parameter || s.role() == Role::Constant; });
}

/// The largest rate of which both are multiples; empty where their ratio is no number of the text.
Expr common_rate(Expr a, Expr b) {
  const Expr ratio = b / a;
  const Rational* number = ratio.number_or_null();
  const auto parts = number ? number->small() : std::nullopt;
  return parts ? a / Rational(parts->denominator) : Expr();
}

/// One rate for each period; nothing where one is not constant.
std::vector<Expr> rates_of(const std::vector<Expr>& formulas, Expr t) {
  std::vector<Expr> rates;
  for (const Expr& node : topological_order(formulas)) {
    if (!node.is(Kind::Sin) && !node.is(Kind::Cos)) continue;
    const Expr rate = differentiate(node[0], t);
    if (rate.is_zero()) continue;
    if (!is_constant(rate)) return {};
    const auto known = std::find_if(rates.begin(), rates.end(), [&](Expr r) { return bool(common_rate(r, rate)); });
    if (known == rates.end())
      rates.push_back(rate);
    else
      *known = common_rate(*known, rate);
  }
  return rates;
}

}  // namespace

std::vector<std::string> stroboscopic_sections(const EquationsOfMotion& equations) {
  const Expr t = equations.system->context->time();
  std::vector<std::string> out;
  for (const Expr& rate : rates_of(driven_formulas(equations), t))
    out.push_back(to_plain(sin(rate * t), equations.order) + " = 0 rising");
  return out;
}

}  // namespace maupertuis::studio
