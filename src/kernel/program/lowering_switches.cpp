#include "kernel/program/lowering.hpp"

#include <array>

/// Functions with a switch. During a step the sides of all switch functions are fixed, so that abs is a factor, sign
/// and step are constants, and min, max, piecewise select one operand.
namespace maupertuis::lowering {

Scaled Lowering::difference(Scaled a, Scaled b) {
  const auto term = [&](Scaled x, int sign) {
    return Term{graph.constants.multiply(x.coefficient, graph.constants.literal(sign)),
                x.is_constant() ? graph.leaf(Op::One) : x.node};
  };
  return graph.linear({term(a, 1), term(b, -1)});
}

ConstantId Lowering::side(Scaled function, SwitchFunction meaning) {
  ConstantPool& pool = graph.constants;
  // The factor is left out of the switch function, so that x, −x and 2x switch as one.
  const Rational* factor = pool.literal_or_null(function.coefficient);
  const ConstantId sign =
      factor ? pool.literal(factor->sign()) : pool.apply(Kind::Sign, std::array{function.coefficient});
  if (function.is_constant()) return sign;
  const auto [place, fresh] = switch_of_node_.try_emplace(function.node, static_cast<std::uint32_t>(switches.size()));
  if (fresh) {
    switches.push_back(meaning);
    switch_nodes.push_back(function.node);
  }
  return pool.multiply(sign, pool.side(place->second));
}

Scaled Lowering::with_switch(Expr e) {
  ConstantPool& pool = graph.constants;
  const Scaled argument = of(e[0]);
  const ConstantId sign = side(argument, {e.kind(), e[0], {}});
  if (e.is(Kind::Sign)) return constant(sign);
  if (e.is(Kind::Step)) return constant(pool.apply(Kind::Step, std::array{sign}));
  return {pool.multiply(argument.coefficient, sign), argument.node};
}

Scaled Lowering::extremum(Expr e) {
  const Scaled a = of(e[0]), b = of(e[1]);
  ConstantPool& pool = graph.constants;
  const ConstantId sign = side(difference(a, b), {e.kind(), e[0], e[1]}), zero = pool.literal(0);
  const auto order = e.is(Kind::Min) ? std::array{sign, zero} : std::array{zero, sign};
  const std::array<std::pair<ConstantId, Scaled>, 2> choices{
      {{pool.apply(Kind::LessEqual, order), a}, {pool.literal(1), b}}};
  return select(choices);
}

Scaled Lowering::condition(Expr e) {
  ConstantPool& pool = graph.constants;
  const ConstantId sign = side(difference(of(e[0]), of(e[1])), {e.kind(), e[0], e[1]});
  return constant(pool.apply(e.kind(), std::array{sign, pool.literal(0)}));
}

Scaled Lowering::piecewise(Expr e) {
  std::vector<std::pair<ConstantId, Scaled>> choices;
  for (std::size_t i = 0; i + 1 < e.size(); i += 2) choices.emplace_back(of(e[i]).coefficient, of(e[i + 1]));
  choices.emplace_back(graph.constants.literal(1), of(e[e.size() - 1]));
  return select(choices);
}

Scaled Lowering::select(std::span<const std::pair<ConstantId, Scaled>> choices) {
  bool all_constant = true;
  for (const auto& [condition, value] : choices) all_constant &= value.is_constant();
  if (all_constant) {
    std::vector<ConstantId> operands;
    for (const auto& [condition, value] : choices) operands.insert(operands.end(), {condition, value.coefficient});
    operands.erase(operands.end() - 2);  // the condition of the last, which always holds
    return constant(graph.constants.apply(Kind::Piecewise, operands));
  }
  std::vector<Term> terms;
  for (const auto& [condition, value] : choices) terms.push_back({condition, graph.node_of(value)});
  return graph.scaled(graph.select(std::move(terms)));
}

/// The value of a node that does not move.
std::optional<ConstantId> Lowering::constant_of(NodeIndex node) const {
  const Node& n = graph.nodes[node];
  if (n.op == Op::Linear && n.terms.size() == 1 && graph.nodes[n.terms[0].a].op == Op::One)
    return n.terms[0].coefficient;
  return std::nullopt;
}

/// max(x, 0)^(3/2): a power has no series about 0, and where the constant is chosen there is nothing to expand.
/// Constants are taken to their powers apart, and stand as 1 in what is expanded. Nothing where no choice is a
/// constant.
std::optional<Scaled> Lowering::power_of_choices(Scaled base, ConstantId exponent) {
  if (graph.nodes[base.node].op != Op::Select) return std::nullopt;
  ConstantPool& pool = graph.constants;
  const std::vector<Term> terms = graph.nodes[base.node].terms;
  std::vector<std::pair<ConstantId, Scaled>> moving, powers;
  bool any = false;
  for (const Term& term : terms) {
    const auto fixed = constant_of(term.a);
    any = any || fixed;
    moving.emplace_back(term.coefficient, fixed ? constant(pool.literal(1)) : Scaled{base.coefficient, term.a});
  }
  if (!any) return std::nullopt;
  const Scaled power = plain_power(select(moving), exponent);
  for (const Term& term : terms) {
    const auto fixed = constant_of(term.a);
    powers.emplace_back(
        term.coefficient,
        fixed ? constant(pool.apply(Kind::Power, std::array{pool.multiply(base.coefficient, *fixed), exponent}))
              : power);
  }
  return select(powers);
}

}  // namespace maupertuis::lowering
