#include <maupertuis/constraint_manifold.hpp>

namespace maupertuis {

std::vector<Expr> in_terms_of_motion(const MechanicalSystem& system, std::span<const Expr> expressions) {
  ExprMap replacements;
  for (const Definition& d : system.definitions)
    if (d.symbol) replacements.emplace(d.symbol, d.value);
  for (const Input& input : system.inputs) {
    // Residuals and powers hold u and u'; certificates go no further than u''.
    Expr symbol = input.symbol, formula = input.formula;
    for (int order = 0; order <= 2; ++order) {
      replacements.emplace(symbol, formula);
      symbol = system.context->time_derivative(symbol);
      formula = total_time_derivative(formula);
    }
  }
  std::vector<Expr> once = substitute(expressions, replacements);
  return system.inputs.empty() || system.definitions.empty() ? once : substitute(once, replacements);
}

Bindings parameter_bindings(const MechanicalSystem& system) {
  Bindings bindings;
  for (const Parameter& p : system.parameters) bindings.emplace(p.symbol, p.si_value);
  bindings.emplace(system.context->time(), 0.0);
  return bindings;
}

}  // namespace maupertuis
