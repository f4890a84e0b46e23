#pragma once
#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include "symbolic/evaluate/tape.hpp"

#include <vector>

namespace maupertuis::evaluation {

/// g of a node that switches; an empty handle for all others.
Expr difference_of(Expr node);

/// −g, term by term where it is a sum: as b − a is written beside a − b.
Expr opposite(Expr g);

/// The branches of some functions that are in force at a point.
class Branches {
 public:
  explicit Branches(std::vector<Expr> functions);

  const std::vector<Expr>& functions() const { return functions_; }
  /// The functions around a point: of what switches, branches that other sides would have are left out. What is on a
  /// switch to within 1e-9 of the size of its terms keeps both. Precondition: `at` has every symbol. Cost: one
  /// evaluation in double; then what is in force alone is visited.
  std::vector<Expr> in_force(const Bindings& at) const;

 private:
  std::vector<Expr> functions_;
  Tape tape_;
  std::vector<bool> switching_;  // [positions] a node that switches stands there or below
};

}  // namespace maupertuis::evaluation
