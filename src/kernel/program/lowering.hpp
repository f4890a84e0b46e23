#pragma once
#include "kernel/program/graph.hpp"

#include <maupertuis/kernel.hpp>

#include <unordered_map>
#include <unordered_set>

namespace maupertuis::lowering {

/// Turns expressions into graph nodes, each expression once, children before parents.
class Lowering {
 public:
  explicit Lowering(const KernelSource& source);
  /// Steps end where an angle of these roots goes through its cut. Call it before lower().
  void let_angles_jump(std::span<const Expr> roots);
  /// The node of each root.
  std::vector<NodeIndex> lower(std::span<const Expr> roots);

  Graph graph;
  std::vector<SwitchFunction> switches;
  std::vector<NodeIndex> switch_nodes;

 private:
  Scaled lower_node(Expr e);
  Scaled of(Expr e) const { return scope_.done.at(e.id()); }
  Scaled constant(ConstantId id) const { return {id, no_node}; }
  Scaled constant_function(Expr e);
  Scaled symbol(Expr e);
  Scaled sum(Expr e);
  Scaled product(Expr e);
  Scaled multiply(std::vector<Scaled> factors);
  Scaled divide(Scaled numerator, Scaled denominator);
  Scaled power(Expr e);
  Scaled plain_power(Scaled base, ConstantId exponent);
  Scaled half_power(Scaled base, std::int64_t halves);
  Scaled integer_power(Scaled base, std::int64_t exponent);
  Scaled function(Kind kind, Scaled argument);
  /// y = f(u) with dy = f'(u) du, where f' may be written with y.
  Scaled by_differential(Kind kind, NodeIndex u);
  /// An expression of another context, whose `x` and `f` are u and y.
  Scaled lower_rule(Expr rule, Expr x, NodeIndex u, Expr f, NodeIndex y);
  Scaled angle(Expr e);
  NodeIndex atan2(NodeIndex y, NodeIndex x);
  Scaled time_derivative(Scaled argument);

  // Switches: everything here is linear in its operands once the sides are fixed.
  Scaled difference(Scaled a, Scaled b);
  /// The sign, −1, 0 or 1, of a switch function as a constant.
  ConstantId side(Scaled function, SwitchFunction meaning);
  Scaled with_switch(Expr e);
  Scaled extremum(Expr e);
  Scaled condition(Expr e);
  Scaled piecewise(Expr e);
  Scaled select(std::span<const std::pair<ConstantId, Scaled>> choices);
  std::optional<ConstantId> constant_of(NodeIndex node) const;
  std::optional<Scaled> power_of_choices(Scaled base, ConstantId exponent);

  /// What is known of the expressions of one context.
  struct Scope {
    std::unordered_map<NodeId, Scaled> done;
    std::unordered_map<NodeId, std::uint32_t> uses;
  };
  void lower_into_scope(std::span<const Expr> roots);

  Scope scope_;
  std::unordered_map<NodeId, std::uint32_t> coordinates_, multipliers_, parameters_;
  std::unordered_map<NodeIndex, std::uint32_t> switch_of_node_;
  std::unordered_set<NodeId> jumping_;  // angles with a switch at their cut
};

}  // namespace maupertuis::lowering
