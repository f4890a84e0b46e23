#include <maupertuis/constraint_manifold.hpp>

#include <maupertuis/kinds.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <unordered_set>

namespace maupertuis {

MotionTerms::MotionTerms(const MechanicalSystem& system)
    : twice_(!system.inputs.empty() && !system.definitions.empty()) {
  for (const Definition& d : system.definitions)
    if (d.symbol) replacements_.emplace(d.symbol, d.value);
  for (const Input& input : system.inputs) {
    // Residuals and powers hold u and u', and u''' where a place moves with u'; certificates go one further.
    Expr symbol = input.symbol, formula = input.formula;
    for (int order = 0; order <= 4; ++order) {
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

namespace {

/// Whether an identity of the node's arguments may depend on their signs: of roots, logarithms and switches.
bool depends_on_signs(const Expr& node) {
  if (node.is(Kind::Power)) return !node[1].is_number() || !node[1].number().is_integer();
  return node.is(Kind::Log) || has_switch(node.kind());
}

std::unordered_set<Expr, ExprHash> symbols_whose_signs_matter(std::span<const Expr> expressions) {
  std::unordered_set<Expr, ExprHash> out;
  for (const Expr& node : topological_order(expressions))
    if (depends_on_signs(node))
      for (const Expr& symbol : symbols_of({&node, 1})) out.insert(symbol);
  return out;
}

}  // namespace

ZeroTest vanish_for_given_signs(const MechanicalSystem& system, std::span<const Expr> expressions) {
  const ZeroTest for_all = zero_test(expressions);
  if (for_all.verdict == Verdict::Zero) return for_all;
  const auto matter = symbols_whose_signs_matter(expressions);
  ExprMap squares;
  std::vector<std::string> signs;
  for (const Parameter& p : system.parameters) {
    if (p.si_value == 0 || !matter.contains(p.symbol)) continue;
    const Expr root = system.context->symbol("root of " + p.name, Role::Auxiliary);
    squares.emplace(p.symbol, p.si_value > 0 ? root * root : -root * root);
    signs.push_back(fmt::format("{} {} 0", p.name, p.si_value > 0 ? '>' : '<'));
  }
  if (squares.empty()) return for_all;
  ZeroTest for_signs = zero_test(substitute(expressions, squares));
  if (for_signs.verdict != Verdict::Zero) return for_all;
  for_signs.reason = fmt::format("for {}", fmt::join(signs, ", "));
  return for_signs;
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
