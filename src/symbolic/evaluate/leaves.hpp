#pragma once
#include <maupertuis/expression.hpp>

#include <optional>
#include <span>
#include <vector>

namespace maupertuis::evaluation {

/// The side of a switch: g > 0 (`above`) or g < 0.
struct Side {
  Expr g;
  bool above = true;
};

/// A formula without switches, and the sides on which it is in force.
struct Leaf {
  Expr formula;
  std::vector<Side> sides;
};

/// The formulas that some expressions are where each switch has one side, each once and none that is 0. If all of them
/// vanish as formulas, the expressions vanish everywhere. Only sides that are asked for count: a table of n pieces has
/// n leaves, and not 2^(n−1). Switches in different terms are not combined: Σ F_i(s_i) vanishes on all sides where it
/// does when one of the s_i takes all of its sides and the others stay. Nothing where there are more than a budget.
/// Precondition: no TimeDerivative nodes.
std::optional<std::vector<Leaf>> leaves_of(std::span<const Expr> roots);

}  // namespace maupertuis::evaluation
