#include "symbolic/transform/derivative_rules.hpp"

#include <maupertuis/functions.hpp>

#include <array>

namespace maupertuis {
namespace {

Expr square(Expr e) { return pow(e, Rational(2)); }

/// 1 where the condition holds, else 0.
Expr indicator(Expr condition, Expr if_true, Expr if_false) {
  const std::array branches{condition, if_true, if_false};
  return condition.context().function(Kind::Piecewise, branches);
}

Expr comparison(Kind kind, Expr a, Expr b) {
  const std::array sides{a, b};
  return a.context().function(kind, sides);
}

Expr product_without(Expr node, std::size_t index) {
  std::vector<Expr> factors;
  for (std::size_t i = 0; i < node.size(); ++i)
    if (i != index) factors.push_back(node[i]);
  return node.context().product(factors);
}

Expr power_derivative(Expr node, std::size_t index) {
  const Expr base = node[0], exponent = node[1];
  if (index == 0) return exponent * node.context().power(base, exponent - Rational(1));
  return node * apply(Kind::Log, base);
}

/// Jumps are switches of a run and not forces.
Expr switch_derivative(Expr node) {
  if (node.is(Kind::Abs)) return apply(Kind::Sign, node[0]);
  if (node.is(Kind::Sign) || node.is(Kind::Step)) return node.context().number(0);
  throw unknown_kind(node.kind(), "the derivative of a switch");
}

Expr atan2_derivative(Expr node, std::size_t index) {
  const Expr y = node[0], x = node[1];
  const Expr inverse = pow(square(x) + square(y), Rational(-1));
  return index == 0 ? x * inverse : -y * inverse;
}

/// min(a, b) is a where a <= b: the derivative goes to the branch in force.
Expr extremum_derivative(Expr node, std::size_t index) {
  Context& context = node.context();
  const bool minimum = node.is(Kind::Min);
  const Expr first_in_force =
      minimum ? comparison(Kind::LessEqual, node[0], node[1]) : comparison(Kind::LessEqual, node[1], node[0]);
  const Expr one = context.number(1), zero = context.number(0);
  return index == 0 ? indicator(first_in_force, one, zero) : indicator(first_in_force, zero, one);
}

/// 1 on the branch `index`, 0 on the others.
Expr branch_derivative(Expr node, std::size_t index) {
  Context& context = node.context();
  const bool is_condition = index % 2 == 0 && index + 1 < node.size();
  if (is_condition) return context.number(0);
  std::vector<Expr> branches;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const bool condition = i % 2 == 0 && i + 1 < node.size();
    branches.push_back(condition ? node[i] : context.number(i == index ? 1 : 0));
  }
  return context.function(Kind::Piecewise, branches);
}

}  // namespace

Expr partial_derivative(Expr node, std::size_t index) {
  Context& context = node.context();
  switch (family_of(node.kind())) {
    case Family::Algebra:
      if (node.is(Kind::Sum)) return context.number(1);
      return node.is(Kind::Product) ? product_without(node, index) : power_derivative(node, index);
    case Family::Function:
      return functions::derivative(node.kind(), node[0], node);
    case Family::Switch:
      return switch_derivative(node);
    case Family::Angle:
      return atan2_derivative(node, index);
    case Family::Extremum:
      return extremum_derivative(node, index);
    case Family::Piecewise:
      return branch_derivative(node, index);
    case Family::Comparison:
    case Family::Logic:
      return context.number(0);
    case Family::Leaf:
    case Family::TimeDerivative:
      break;
  }
  throw unknown_kind(node.kind(), "a partial derivative");
}

}  // namespace maupertuis
