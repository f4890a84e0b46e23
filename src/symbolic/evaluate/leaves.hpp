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

/// Formulas without switches, and the sides on which they are in force.
struct Leaf {
  std::vector<Expr> formulas;
  std::size_t last_choice = 0;
  std::vector<Side> not_varied;  // of switches that other leaves vary
};

struct Leaves {
  /// The last one that was asked for comes first.
  std::vector<Side> sides_of(const Leaf& leaf) const;

  std::vector<Leaf> all;
  /// Leaves of a table share all but one of their choices with the one before, so that choices form a tree. The first
  /// is none.
  struct Choice {
    Side side;
    std::size_t before = 0;
  };
  std::vector<Choice> choices{1};
};

/// The formulas that some expressions are where each switch has one side, each once and none that is 0; one formula a
/// leaf. If all of them vanish as formulas, the expressions vanish everywhere. Only sides that are asked for count: a
/// table of n pieces has n leaves, and not 2^(n−1). Switches in different terms are not combined: Σ F_i(s_i) vanishes
/// on all sides where it does when one of the s_i takes all of its sides and the others stay. Nothing where there are
/// more than a budget. Precondition: no TimeDerivative nodes.
std::optional<Leaves> leaves_of(std::span<const Expr> roots);

/// Formulas that are multiplied with each other, a factor that is squared twice; a formula alone is {e}.
using Products = std::vector<std::vector<Expr>>;

/// The same of expressions that are looked at together: all of them on the sides of a leaf. What is judged is a sum of
/// products of the roots and of what has no switches; `products` says of which. Derivatives by time are those of the
/// formula in force. Precondition: each root stands in a product.
std::optional<Leaves> joint_leaves(std::span<const Expr> roots, const Products& products);

}  // namespace maupertuis::evaluation
