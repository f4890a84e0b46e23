#include "kernel/program/lowering.hpp"

#include "kernel/program/rotations.hpp"

#include <maupertuis/functions.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace maupertuis::lowering {
namespace {

constexpr std::int64_t most_halves = 32;    // beyond, products cost more than a power of its own
constexpr std::size_t few_coordinates = 4;  // a pair of bodies, or one in a field: no powers to stand beside each other

}  // namespace

Lowering::Lowering(const KernelSource& source) {
  for (const Expr& q : source.coordinates)
    coordinates_.emplace(q.id(), static_cast<std::uint32_t>(coordinates_.size()));
  for (const Expr& p : source.parameters) parameters_.emplace(p.id(), static_cast<std::uint32_t>(parameters_.size()));
  for (const Expr& m : source.multipliers)
    multipliers_.emplace(m.id(), static_cast<std::uint32_t>(coordinates_.size() + multipliers_.size()));
  // The coordinates are nodes even when no expression holds them.
  for (std::uint32_t i = 0; i < coordinates_.size() + multipliers_.size(); ++i) graph.leaf(Op::Coordinate, i);
}

void Lowering::lower_into_scope(std::span<const Expr> roots) {
  const auto order = topological_order(roots);
  for (const Expr& e : order)
    for (const NodeId argument : e.argument_ids()) ++scope_.uses[argument];
  for (const Expr& e : order)
    if (!scope_.done.count(e.id())) scope_.done.emplace(e.id(), lower_node(e));
}

void Lowering::let_angles_jump(std::span<const Expr> roots) {
  for (const Expr& e : topological_order(roots))
    if (e.is(Kind::Atan2)) jumping_.insert(e.id());
}

std::vector<NodeIndex> Lowering::lower(std::span<const Expr> roots) {
  lower_into_scope(roots);
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
  switch (family_of(e.kind())) {
    case Family::Algebra:
      return e.is(Kind::Sum) ? sum(e) : e.is(Kind::Product) ? product(e) : power(e);
    case Family::TimeDerivative:
      return time_derivative(of(e[0]));
    case Family::Function:
      return function(e.kind(), of(e[0]));
    case Family::Angle:
      return angle(e);
    case Family::Switch:
      return with_switch(e);
    case Family::Extremum:
      return extremum(e);
    case Family::Comparison:
      return condition(e);
    case Family::Piecewise:
      return piecewise(e);
    case Family::Leaf:
    case Family::Logic:
      break;  // Pi and conditions of conditions are constants
  }
  throw unknown_kind(e.kind(), "the kernel");
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
    throw std::invalid_argument("build_kernel: " + e.name() +
                                " is no coordinate, multiplier or parameter of the source");
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
  if (numerator.node == denominator.node) return constant(coefficient);  // x'/|x'| is the side of x'
  const NodeIndex top = numerator.is_constant() ? graph.leaf(Op::One) : numerator.node;
  return {coefficient, graph.quotient(top, denominator.node)};
}

Scaled Lowering::product(Expr e) {
  std::vector<Scaled> above, below;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const PowerOf factor = split_power(e[i]);
    // A reciprocal that stands here alone becomes part of one division.
    const bool divides =
        factor.exponent == Rational(-1) && scope_.uses[e[i].id()] == 1 && !of(factor.base).is_constant();
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

/// base^(n/2) by roots, products and one division, which are carried out side by side; a power of its own is not. So
/// r^(−3) of many pairs of bodies, 1/(r² √r²), costs as little as their distances. Of one pair it is a power: two sums
/// over orders instead of three, and less that waits for each other.
Scaled Lowering::half_power(Scaled base, std::int64_t halves) {
  const std::int64_t size = std::abs(halves);
  if (size % 2 != 0 && size > 1 && coordinates_.size() <= few_coordinates)
    return plain_power(base, graph.constants.literal(Rational(halves, 2)));
  Scaled above = integer_power(base, size / 2);
  if (size % 2 != 0) above = multiply({above, graph.scaled(graph.unary(Op::SquareRoot, graph.node_of(base)))});
  return halves > 0 ? above : divide(constant(graph.constants.literal(1)), above);
}

Scaled Lowering::power(Expr e) {
  const Scaled base = of(e[0]), exponent = of(e[1]);
  if (!exponent.is_constant())  // x^y = exp(y log x)
    return function(Kind::Exp, multiply({exponent, function(Kind::Log, base)}));
  const Rational* number = graph.constants.literal_or_null(exponent.coefficient);
  const auto integer = number ? number->as_integer() : std::nullopt;
  if (integer && *integer >= 0) return integer_power(base, *integer);
  if (!number || number->sign() > 0)
    if (const auto apart = power_of_choices(base, exponent.coefficient)) return *apart;
  if (number)
    if (const auto halves = (*number * Rational(2)).as_integer(); halves && std::abs(*halves) <= most_halves)
      return half_power(base, *halves);
  return plain_power(base, exponent.coefficient);
}

Scaled Lowering::plain_power(Scaled base, ConstantId exponent) {
  const Rational* number = graph.constants.literal_or_null(exponent);
  const NodeIndex node = graph.node_of(base);
  if (number && *number == Rational(1, 2)) return graph.scaled(graph.unary(Op::SquareRoot, node));
  return graph.scaled(graph.unary(Op::Power, node, exponent));
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
  const NodeIndex u = graph.node_of(argument);
  if (kind == Kind::Sin) return graph.scaled(graph.pair(Op::SinCos, u).first);
  if (kind == Kind::Cos) return graph.scaled(graph.pair(Op::SinCos, u).second);
  if (kind == Kind::Sinh) return graph.scaled(graph.pair(Op::SinhCosh, u).first);
  if (kind == Kind::Cosh) return graph.scaled(graph.pair(Op::SinhCosh, u).second);
  return by_differential(kind, u);
}

/// The rule of the table is read for a u and a y of its own, so that it costs the same whatever u is made of.
Scaled Lowering::by_differential(Kind kind, NodeIndex u) {
  Context context;
  const Expr x = context.symbol("x", Role::Auxiliary), f = context.symbol("f", Role::Auxiliary);
  const Expr rule = functions::derivative(kind, x, f);
  const std::vector<Expr> symbols = symbols_of({&rule, 1});
  const bool by_itself = std::find(symbols.begin(), symbols.end(), f) != symbols.end();
  if (!by_itself) {
    const Scaled slope = lower_rule(rule, x, u, f, no_node);
    return graph.scaled(graph.function(kind, u, no_node, {{slope.coefficient, slope.node, u}}));
  }
  const ConstantId one = graph.constants.literal(1);
  const NodeIndex y = graph.function(kind, u, no_node, {{one, no_node, u}});
  graph.nodes[y].terms[0].a = graph.node_of(lower_rule(rule, x, u, f, y));
  return graph.scaled(y);
}

Scaled Lowering::lower_rule(Expr rule, Expr x, NodeIndex u, Expr f, NodeIndex y) {
  Scope outer = std::exchange(scope_, Scope{{{x.id(), graph.scaled(u)}, {f.id(), graph.scaled(y)}}, {}});
  lower_into_scope({&rule, 1});
  const Scaled lowered = of(rule);
  scope_ = std::move(outer);
  return lowered;
}

/// d atan2(y, x) = (x dy − y dx)/(x² + y²).
NodeIndex Lowering::atan2(NodeIndex y, NodeIndex x) {
  const ConstantId one = graph.constants.literal(1), minus_one = graph.constants.literal(-1);
  const NodeIndex square =
      graph.node_of(graph.linear({{one, graph.unary(Op::Square, y)}, {one, graph.unary(Op::Square, x)}}));
  return graph.function(Kind::Atan2, y, x,
                        {{one, graph.quotient(x, square), y}, {minus_one, graph.quotient(y, square), x}});
}

/// An angle jumps by 2π where y goes through 0 while x < 0, which its series does not show. On either side s of y it is
///
///     atan2(y, x) = s (π/2 − atan2(x, s y)),      s = 1 for y ≥ 0, −1 for y < 0
///
/// and the right-hand side goes on beyond y = 0: so y is a switch function.
Scaled Lowering::angle(Expr e) {
  const Scaled y = of(e[0]), x = of(e[1]);
  if (y.is_constant() || !jumping_.count(e.id())) return graph.scaled(atan2(graph.node_of(y), graph.node_of(x)));
  ConstantPool& pool = graph.constants;
  const ConstantId zero = pool.literal(0), two = pool.literal(2), minus_one = pool.literal(-1);
  const ConstantId is_up = pool.apply(Kind::LessEqual, std::array{zero, side(y, {e.kind(), e[0], {}})});
  const ConstantId s = pool.add(pool.multiply(two, is_up), minus_one);
  const NodeIndex beside = atan2(graph.node_of(x), graph.node_of({pool.multiply(s, y.coefficient), y.node}));
  const ConstantId quarter = pool.multiply(pool.apply(Kind::Pi, {}), pool.literal(Rational(1, 2)));
  return graph.linear({{pool.multiply(s, quarter), graph.leaf(Op::One)}, {pool.multiply(s, minus_one), beside}});
}

}  // namespace maupertuis::lowering
