#include <maupertuis/constraint_manifold.hpp>

namespace maupertuis {

MotionTerms::MotionTerms(const MechanicalSystem& system)
    : twice_(!system.inputs.empty() && !system.definitions.empty()) {
  for (const Definition& d : system.definitions)
    if (d.symbol) replacements_.emplace(d.symbol, d.value);
  for (const Input& input : system.inputs) {
    // Residuals and powers hold u and u'; certificates go no further than u''.
    Expr symbol = input.symbol, formula = input.formula;
    for (int order = 0; order <= 2; ++order) {
      replacements_.emplace(symbol, formula);
      symbol = system.context->time_derivative(symbol);
      formula = total_time_derivative(formula);
    }
  }
}

std::vector<Expr> MotionTerms::operator()(std::span<const Expr> expressions) const {
  if (replacements_.empty()) return {expressions.begin(), expressions.end()};
  std::vector<Expr> once = substitute(expressions, replacements_);
  return twice_ ? substitute(once, replacements_) : once;
}

ExprVector with_constants_as_numbers(const MechanicalSystem& system, std::span<const Expr> expressions) {
  ExprMap numbers;
  for (const Parameter& p : system.parameters)
    if (p.symbol.role() == Role::Constant) numbers.emplace(p.symbol, p.value);
  return numbers.empty() ? ExprVector(expressions.begin(), expressions.end()) : substitute(expressions, numbers);
}

std::vector<Expr> in_terms_of_motion(const MechanicalSystem& system, std::span<const Expr> expressions) {
  return MotionTerms(system)(expressions);
}

Bindings parameter_bindings(const MechanicalSystem& system) {
  Bindings bindings;
  for (const Parameter& p : system.parameters) bindings.emplace(p.symbol, p.si_value);
  bindings.emplace(system.context->time(), 0.0);
  return bindings;
}

}  // namespace maupertuis
