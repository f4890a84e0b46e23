#include "kernel/program/lowering.hpp"

#include "kernel/program/rotations.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace maupertuis::lowering {

Lowering::Lowering(const KernelSource& source) {
  for (const Expr& q : source.coordinates) coordinates_.emplace(q.id(), static_cast<std::uint32_t>(coordinates_.size()));
  for (const Expr& p : source.parameters) parameters_.emplace(p.id(), static_cast<std::uint32_t>(parameters_.size()));
  for (const Expr& m : source.multipliers)
    multipliers_.emplace(m.id(), static_cast<std::uint32_t>(coordinates_.size() + multipliers_.size()));
  // The coordinates are nodes even when no expression holds them.
  for (std::uint32_t i = 0; i < coordinates_.size() + multipliers_.size(); ++i) graph.leaf(Op::Coordinate, i);
}

std::vector<NodeIndex> Lowering::lower(std::span<const Expr> roots) {
  const auto order = topological_order(roots);
  for (const Expr& e : order)
    for (const NodeId argument : e.argument_ids()) ++uses_[argument];
  for (const Expr& e : order)
    if (!done_.count(e.id())) done_.emplace(e.id(), lower_node(e));
  std::vector<NodeIndex> nodes;
  for (const Expr& root : roots) nodes.push_back(graph.node_of(of(root)));
  return nodes;
}

Scaled Lowering::lower_node(Expr e) {
  if (const Rational* number = e.number_or_null()) return constant(graph.constants.literal(*number));
  if (e.is_symbol()) return symbol(e);
  bool all_constant = true;
  for (std::size_t i = 0; i < e.size(); ++i) all_constant &= of(e[i]).is_constant();
  if (all_constant) return constant_function(e);
  switch (e.kind()) {
    case Kind::Sum: return sum(e);
    case Kind::Product: return product(e);
    case Kind::Power: return power(e);
    case Kind::TimeDerivative: return time_derivative(of(e[0]));
    case Kind::Atan2: return atan2(of(e[0]), of(e[1]));
    case Kind::Abs: case Kind::Sign: case Kind::Step: return with_switch(e);
    case Kind::Min: case Kind::Max: return extremum(e);
    case Kind::Less: case Kind::LessEqual: return condition(e);
    case Kind::Piecewise: return piecewise(e);
    default: return function(e.kind(), of(e[0]));
  }
}

Scaled Lowering::constant_function(Expr e) {
  if (e.is(Kind::TimeDerivative)) return constant(graph.constants.literal(0));
  std::vector<ConstantId> operands;
  for (std::size_t i = 0; i < e.size(); ++i) operands.push_back(of(e[i]).coefficient);
  ConstantPool& pool = graph.constants;
  if (e.is(Kind::Sum) || e.is(Kind::Product)) {
    ConstantId result = operands[0];
    for (std::size_t i = 1; i < operands.size(); ++i)
      result = e.is(Kind::Sum) ? pool.add(result, operands[i]) : pool.multiply(result, operands[i]);
    return constant(result);
  }
  return constant(pool.apply(e.kind(), operands));
}

Scaled Lowering::symbol(Expr e) {
  if (e.role() == Role::Time) return graph.scaled(graph.leaf(Op::Time));
  if (const auto found = parameters_.find(e.id()); found != parameters_.end())
    return constant(graph.constants.parameter(found->second));
  if (const auto found = multipliers_.find(e.id()); found != multipliers_.end())
    return time_derivative(time_derivative(graph.scaled(graph.leaf(Op::Coordinate, found->second))));
  const Expr base = e.order() == 0 ? e : e.context().symbol(e.name(), e.role(), 0);
  const auto found = coordinates_.find(base.id());
  if (found == coordinates_.end())
    throw std::logic_error("the kernel does not know the symbol " + e.name() + "; please report");
  Scaled value = graph.scaled(graph.leaf(Op::Coordinate, found->second));
  for (int i = 0; i < e.order(); ++i) value = time_derivative(value);
  return value;
}

// ------------------------------------------------------------------------------------------------------ algebra

Scaled Lowering::sum(Expr e) {
  std::vector<Term> terms;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const Scaled term = of(e[i]);
    terms.push_back({term.coefficient, term.is_constant() ? graph.leaf(Op::One) : term.node});
  }
  return graph.linear(collect_rotations(graph, std::move(terms)));
}

/// Factors of low lag first: what repeats between products (coefficients of velocities) is shared.
Scaled Lowering::multiply(std::vector<Scaled> factors) {
  Scaled result = constant(graph.constants.literal(1));
  std::stable_sort(factors.begin(), factors.end(), [&](const Scaled& x, const Scaled& y) {
    if (x.is_constant() || y.is_constant()) return x.is_constant() && !y.is_constant();
    const int level_x = graph.nodes[x.node].level, level_y = graph.nodes[y.node].level;
    return level_x != level_y ? level_x < level_y : x.node < y.node;
  });
  for (const Scaled& factor : factors) {
    result.coefficient = graph.constants.multiply(result.coefficient, factor.coefficient);
    if (factor.is_constant()) continue;
    result.node = result.is_constant() ? factor.node : graph.multiply(result.node, factor.node);
  }
  return graph.constants.is_zero(result.coefficient) ? constant(result.coefficient) : result;
}

Scaled Lowering::divide(Scaled numerator, Scaled denominator) {
  ConstantPool& pool = graph.constants;
  const ConstantId inverse = pool.is_one(denominator.coefficient)
                                 ? denominator.coefficient
                                 : pool.apply(Kind::Power, std::array{denominator.coefficient, pool.literal(-1)});
  const ConstantId coefficient = pool.multiply(numerator.coefficient, inverse);
  if (denominator.is_constant()) return {coefficient, numerator.node};
  const NodeIndex top = numerator.is_constant() ? graph.leaf(Op::One) : numerator.node;
  return {coefficient, graph.quotient(top, denominator.node)};
}

Scaled Lowering::product(Expr e) {
  std::vector<Scaled> above, below;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const PowerOf factor = split_power(e[i]);
    // A reciprocal that stands here alone becomes part of one division.
    const bool divides = factor.exponent == Rational(-1) && uses_[e[i].id()] == 1 && !of(factor.base).is_constant();
    (divides ? below : above).push_back(divides ? of(factor.base) : of(e[i]));
  }
  const Scaled numerator = multiply(std::move(above));
  return below.empty() ? numerator : divide(numerator, multiply(std::move(below)));
}

Scaled Lowering::integer_power(Scaled base, std::int64_t exponent) {
  Scaled result = constant(graph.constants.literal(1));
  for (Scaled square = base; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = multiply({result, square});
    if (exponent > 1) square = multiply({square, square});
  }
  return result;
}

Scaled Lowering::power(Expr e) {
  const Scaled base = of(e[0]), exponent = of(e[1]);
  if (!exponent.is_constant())  // x^y = exp(y log x)
    return exponential(multiply({exponent, function(Kind::Log, base)}));
  const Rational* number = graph.constants.literal_or_null(exponent.coefficient);
  const auto integer = number ? number->as_integer() : std::nullopt;
  if (integer && *integer >= 0) return integer_power(base, *integer);
  if (integer && *integer == -1) return divide(constant(graph.constants.literal(1)), base);
  const NodeIndex node = graph.node_of(base);
  if (number && *number == Rational(1, 2)) return graph.scaled(graph.unary(Op::SquareRoot, node));
  return graph.scaled(graph.unary(Op::Power, node, exponent.coefficient));
}

Scaled Lowering::time_derivative(Scaled argument) {
  if (argument.is_constant()) return constant(graph.constants.literal(0));
  const Op op = graph.nodes[argument.node].op;
  if (op == Op::One) return constant(graph.constants.literal(0));
  if (op == Op::Time) return constant(argument.coefficient);
  return {argument.coefficient, graph.unary(Op::Derivative, argument.node)};
}

// -------------------------------------------------------------------------------------------- elementary functions

Scaled Lowering::function(Kind kind, Scaled argument) {
  if (argument.is_constant()) return constant(graph.constants.apply(kind, std::array{argument.coefficient}));
  if (kind == Kind::Exp) return exponential(argument);
  const NodeIndex u = graph.node_of(argument);
  switch (kind) {
    case Kind::Sin: return graph.scaled(graph.pair(Op::SinCos, u).first);
    case Kind::Cos: return graph.scaled(graph.pair(Op::SinCos, u).second);
    case Kind::Sinh: return graph.scaled(graph.pair(Op::SinhCosh, u).first);
    case Kind::Cosh: return graph.scaled(graph.pair(Op::SinhCosh, u).second);
    case Kind::Tan: return hyperbola(kind, u, 1);
    case Kind::Tanh: return hyperbola(kind, u, -1);
    default: return function_of_integral(kind, u);
  }
}

Scaled Lowering::exponential(Scaled argument) {
  if (argument.is_constant()) return constant(graph.constants.apply(Kind::Exp, std::array{argument.coefficient}));
  const NodeIndex u = graph.node_of(argument);
  const NodeIndex y = graph.function(Kind::Exp, u, no_node, {{graph.constants.literal(1), no_node, u}});
  graph.nodes[y].terms[0].a = y;  // dy = y du
  return graph.scaled(y);
}

/// tan and tanh: dy = (1 ± y²) du.
Scaled Lowering::hyperbola(Kind kind, NodeIndex u, int sign) {
  const NodeIndex y = graph.function(kind, u, no_node, {{graph.constants.literal(1), no_node, u}});
  const NodeIndex square = graph.unary(Op::Square, y);
  const Scaled slope = graph.linear({{graph.constants.literal(1), graph.leaf(Op::One)},
                                     {graph.constants.literal(sign), square}});
  graph.nodes[y].terms[0].a = slope.node;
  return graph.scaled(y);
}

/// log and the inverse functions: dy = w du with w an algebraic function of u.
Scaled Lowering::function_of_integral(Kind kind, NodeIndex u) {
  const ConstantId one = graph.constants.literal(1);
  const auto one_plus = [&](int of_one, int of_square) {
    return graph.node_of(graph.linear({{graph.constants.literal(of_one), graph.leaf(Op::One)},
                                       {graph.constants.literal(of_square), graph.unary(Op::Square, u)}}));
  };
  const auto inverse = [&](NodeIndex x) { return graph.quotient(graph.leaf(Op::One), x); };
  const auto inverse_root = [&](NodeIndex x) {
    return graph.unary(Op::Power, x, graph.constants.literal(Rational(-1, 2)));
  };
  Term slope{one, no_node, u};
  switch (kind) {
    case Kind::Log: slope.a = inverse(u); break;
    case Kind::Atan: slope.a = inverse(one_plus(1, 1)); break;
    case Kind::Atanh: slope.a = inverse(one_plus(1, -1)); break;
    case Kind::Asin: slope.a = inverse_root(one_plus(1, -1)); break;
    case Kind::Acos: slope = {graph.constants.literal(-1), inverse_root(one_plus(1, -1)), u}; break;
    case Kind::Asinh: slope.a = inverse_root(one_plus(1, 1)); break;
    case Kind::Acosh: slope.a = inverse_root(one_plus(-1, 1)); break;
    default: throw std::logic_error("the kernel met a function that it does not know; please report");
  }
  return graph.scaled(graph.function(kind, u, no_node, {slope}));
}

/// d atan2(y, x) = (x dy − y dx)/(x² + y²).
Scaled Lowering::atan2(Scaled y, Scaled x) {
  const ConstantId one = graph.constants.literal(1), minus_one = graph.constants.literal(-1);
  const NodeIndex up = graph.node_of(y), right = graph.node_of(x);
  const NodeIndex square = graph.node_of(
      graph.linear({{one, graph.unary(Op::Square, up)}, {one, graph.unary(Op::Square, right)}}));
  return graph.scaled(graph.function(Kind::Atan2, up, right,
                                     {{one, graph.quotient(right, square), up},
                                      {minus_one, graph.quotient(up, square), right}}));
}

}  // namespace maupertuis::lowering
