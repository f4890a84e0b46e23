#include "symbolic/transform/derivative_rules.hpp"

#include <maupertuis/require.hpp>

#include <array>
#include <stdexcept>

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

Expr function_derivative(Expr node) {
  const Expr x = node[0];
  Context& context = node.context();
  const Rational one = 1;
  switch (node.kind()) {
    case Kind::Sin: return cos(x);
    case Kind::Cos: return -sin(x);
    case Kind::Tan: return square(node) + one;
    case Kind::Asin: return pow(context.number(1) - square(x), Rational(-1, 2));
    case Kind::Acos: return -pow(context.number(1) - square(x), Rational(-1, 2));
    case Kind::Atan: return pow(square(x) + one, -one);
    case Kind::Sinh: return apply(Kind::Cosh, x);
    case Kind::Cosh: return apply(Kind::Sinh, x);
    case Kind::Tanh: return context.number(1) - square(node);
    case Kind::Asinh: return pow(square(x) + one, Rational(-1, 2));
    case Kind::Acosh: return pow(square(x) - one, Rational(-1, 2));
    case Kind::Atanh: return pow(context.number(1) - square(x), -one);
    case Kind::Exp: return node;
    case Kind::Log: return pow(x, -one);
    case Kind::Abs: return apply(Kind::Sign, x);
    default: return context.number(0);  // Sign, Step
  }
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
  const Expr first_in_force = minimum ? comparison(Kind::LessEqual, node[0], node[1])
                                      : comparison(Kind::LessEqual, node[1], node[0]);
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
  switch (node.kind()) {
    case Kind::Sum: return context.number(1);
    case Kind::Product: return product_without(node, index);
    case Kind::Power: return power_derivative(node, index);
    case Kind::Atan2: return atan2_derivative(node, index);
    case Kind::Min: case Kind::Max: return extremum_derivative(node, index);
    case Kind::Piecewise: return branch_derivative(node, index);
    case Kind::Less: case Kind::LessEqual: case Kind::And: case Kind::Or: return context.number(0);
    case Kind::TimeDerivative: throw std::logic_error("a partial derivative met d/dt; please report");
    default: return function_derivative(node);
  }
}

}  // namespace maupertuis
